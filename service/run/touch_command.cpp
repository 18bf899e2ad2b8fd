#include "service/run/touch_command.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/plane.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/aimed_transfer.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"

namespace cell {
namespace {

static_assert(calib::kAimedTransferPosturesMax <= cs8::kViaCountMax, "a path fits into a command");

template <class Command>
void set_via(Command& command, const std::vector<calib::JointVector>& via) {
  command.via_count = static_cast<std::int32_t>(via.size());
  std::ranges::transform(via, command.via.begin(), to_wire);
}

}  // namespace

cs8::JointsMicrodeg to_wire(const calib::JointVector& joints) { return cs8::microdeg_from_joints(joints); }

calib::JointVector from_wire(const cs8::JointsMicrodeg& wire) {
  return cs8::joints_from_microdeg<calib::JointVector>(wire);
}

cs8::Touch touch_command(const Cell& cell, const calib::PlannedTouch& planned,
                         const std::vector<calib::JointVector>& via) {
  cs8::Touch command;
  set_via(command, via);
  command.clear = to_wire(planned.clear_joints);
  command.approach = to_wire(planned.approach_joints);
  command.search_end = to_wire(planned.search_end_joints);
  command.travel_speed_um_s = cs8::um_s_from_metres_per_second(cell.speeds.travel_m_s);
  command.approach_speed_um_s = cs8::um_s_from_metres_per_second(cell.speeds.approach_m_s);
  command.search_speed_um_s = cs8::um_s_from_metres_per_second(cell.speeds.search_m_s);
  if (const auto& second = cell.speeds.second) {
    command.second_speed_um_s = cs8::um_s_from_metres_per_second(second->speed_m_s);
    command.second_backoff_dmm = cs8::dmm_from_metres(second->backoff_m);
  }
  command.deadline_ms = static_cast<std::uint32_t>(cell.deadlines.command.count());
  return command;
}

cs8::Travel travel_command(const Cell& cell, const calib::JointVector& target,
                           const std::vector<calib::JointVector>& via) {
  cs8::Travel command;
  set_via(command, via);
  command.target = to_wire(target);
  command.travel_speed_um_s = cs8::um_s_from_metres_per_second(cell.speeds.travel_m_s);
  command.deadline_ms = static_cast<std::uint32_t>(cell.deadlines.command.count());
  return command;
}

cs8::Retract retract_command(const Cell& cell) {
  return {.approach_speed_um_s = cs8::um_s_from_metres_per_second(cell.speeds.approach_m_s),
          .deadline_ms = static_cast<std::uint32_t>(cell.deadlines.command.count())};
}

std::optional<OutcomeFault> fault_of(cs8::Outcome outcome, cs8::Phase phase, std::int32_t error_number) {
  const std::string where = fmt::format("in the phase '{}'", cs8::name(phase));
  switch (outcome) {
    case cs8::Outcome::kContact:
    case cs8::Outcome::kArrived:
    case cs8::Outcome::kStopped:
      return std::nullopt;
    case cs8::Outcome::kNoContact:
      return OutcomeFault{{FaultCode::kNoContact, {}}, true};
    case cs8::Outcome::kProbeStuck:
      return OutcomeFault{{FaultCode::kProbeStuck, {}}, true};
    case cs8::Outcome::kUnexpectedContact:
      return OutcomeFault{{FaultCode::kUnexpectedContact, where}};
    case cs8::Outcome::kHeartbeatLost:
      return OutcomeFault{{FaultCode::kLinkLost, "the controller heard no heartbeat " + where}, true};
    case cs8::Outcome::kPermissionLost:
      return OutcomeFault{{FaultCode::kPermissionLost, where}, true};
    case cs8::Outcome::kCollision:
      return OutcomeFault{{FaultCode::kCollision, where}};
    case cs8::Outcome::kDeadline:
      return OutcomeFault{{FaultCode::kTouchDeadline, where}, true};
    case cs8::Outcome::kOvertravel:
      return OutcomeFault{{FaultCode::kOvertravel, {}}};
    case cs8::Outcome::kProbeFault:
      return OutcomeFault{{FaultCode::kProbeFault, where}, true};
    case cs8::Outcome::kTaskFailed:
      return OutcomeFault{{FaultCode::kTaskFailed, fmt::format("run-time error {} {}", error_number, where)},
                          true};
    case cs8::Outcome::kMotionError:
      break;
  }
  return OutcomeFault{{FaultCode::kMotionError, fmt::format("run-time error {} {}", error_number, where)}};
}

OutcomeFault fault_of(const cs8::Rejected& rejected) {
  const std::string why = fmt::format("{} (detail {})", cs8::name(rejected.reason), rejected.detail);
  switch (rejected.reason) {
    case cs8::RejectReason::kProbeInputs:
      return {{FaultCode::kProbeFault, why}, true};
    case cs8::RejectReason::kCellOpen:
      return {{FaultCode::kCellOpen, {}}, true};
    case cs8::RejectReason::kTouchTestMissing:
      return {{FaultCode::kTouchTestMissing, {}}, true};
    case cs8::RejectReason::kTaskFailed:
      return {{FaultCode::kTaskFailed, fmt::format("run-time error {}", rejected.detail)}, true};
    case cs8::RejectReason::kProbeTriggered:
      return {{FaultCode::kProbeTriggered, {}}, true};
    case cs8::RejectReason::kMonitorSpeed:
      return {{FaultCode::kMonitorSpeedChanged, fmt::format("to {} %", rejected.detail)}, false, true};
    case cs8::RejectReason::kBadField:
    case cs8::RejectReason::kSearchTooLong:
    case cs8::RejectReason::kSearchTooFast:
    case cs8::RejectReason::kOutOfRange:
      return {{FaultCode::kPlanInvalid, why}};
    case cs8::RejectReason::kNotRemote:
    case cs8::RejectReason::kNotPowered:
    case cs8::RejectReason::kHold:
    case cs8::RejectReason::kEmergencyStop:
    case cs8::RejectReason::kNotCalibrated:
    case cs8::RejectReason::kNotPermitted:
      return {{FaultCode::kPermissionLost, fmt::format("before the motion began: {}", why)}, true};
    case cs8::RejectReason::kResultUnacknowledged:
    case cs8::RejectReason::kBusy:
    case cs8::RejectReason::kStaleSequence:
    case cs8::RejectReason::kNothingToRetract:
    case cs8::RejectReason::kRetractPending:
      break;
  }
  // The two sides do not agree on what was done, and what was refused moved nothing: the run loses nothing by
  // waiting until they have met anew (ControllerSession::meet_anew_after) or State has told where the arm is.
  return {{FaultCode::kTouchRejected, why}, true};
}

namespace {

Eigen::Vector3d tip_in_block_m(const Cell& cell, const calib::JointVector& joints) {
  return calib::forward_kinematics(cell.arm.model, joints).translation();
}

/// How the tip misses the search line; nothing if it lies on it.
std::optional<std::string> off_search_line_reason(const Cell& cell, const calib::PlannedTouch& planned,
                                                  const Eigen::Vector3d& tip_m) {
  // The controller moves its nominal ball on a straight line, whatever arm the touch was aimed with: the
  // contact lies on it, between both its ends.
  const Eigen::Vector3d begin_m = tip_in_block_m(cell, planned.approach_joints);
  const Eigen::Vector3d search_m = tip_in_block_m(cell, planned.search_end_joints) - begin_m;
  const Eigen::Vector3d direction = search_m.normalized();
  const Eigen::Vector3d off = tip_m - (begin_m + 0.5 * search_m);
  const double along = off.dot(direction);
  const double aside = (off - along * direction).norm();
  constexpr double kAsideMax = 1e-4;
  const double half = search_m.norm() / 2 + kAsideMax;
  if (aside <= kAsideMax && std::abs(along) <= half) return std::nullopt;
  return fmt::format("its tip is {:.3f} mm beside the search line and {:.3f} mm from its middle along it",
                     calib::mm_from_metres(aside), calib::mm_from_metres(along));
}

}  // namespace

std::optional<std::string> implausibility_reason(const Cell& cell, const calib::PlannedTouch& planned,
                                                 const cs8::TouchResult& result) {
  if (result.source == cs8::CaptureSource::kNone) return "it has no captured joints";
  if (result.monitor_speed_percent != 100)
    return fmt::format("the monitor speed was {} % in the search: the pre-travel holds at 100 %",
                       result.monitor_speed_percent);
  if (result.phase != cs8::Phase::kIdle)
    return fmt::format("it was broken off in the phase '{}'", cs8::name(result.phase));
  if (result.overtravel_dmm < 0) return "its overtravel is negative";
  if (result.edges == 0) return "no edge of the probe was counted";
  const std::int32_t speed_um_s = cs8::um_s_from_metres_per_second(cell.speeds.contact_m_s());
  if (result.search_speed_um_s != speed_um_s)
    return fmt::format("it was made at {} um/s and commanded at {}: the pre-travel holds at one speed only",
                       result.search_speed_um_s, speed_um_s);
  const Eigen::Vector3d tip_m = tip_in_block_m(cell, from_wire(result.contact));
  if (auto off = off_search_line_reason(cell, planned, tip_m)) return off;
  if (!cell.speeds.second) return std::nullopt;
  if (result.first_source == cs8::CaptureSource::kNone) return "the first of its two contacts is missing";
  const Eigen::Vector3d first_tip_m = tip_in_block_m(cell, from_wire(result.first_contact));
  if (const auto off = off_search_line_reason(cell, planned, first_tip_m))
    return "in its first contact, " + *off;
  return std::nullopt;
}

}  // namespace cell
