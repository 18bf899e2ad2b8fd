#include "sim_controller/reports.hpp"

#include <algorithm>

#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/admission.hpp"

namespace sim {
namespace {

constexpr std::uint32_t kApplicationVersion = 200;  // 0.2.0
constexpr std::uint32_t kLanguageVersion = 70702;   // s7.7.2

std::uint32_t clock_ms(TimePoint now) {
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count());
}

/// The joints as the wire has them; 0 without a capture.
cs8::JointsMicrodeg contact_joints(const std::optional<Capture>& capture) {
  return capture ? wire_from_joints(capture->contact) : cs8::JointsMicrodeg{};
}

cs8::CaptureSource source_of(const std::optional<Capture>& capture) {
  return capture ? capture->source : cs8::CaptureSource::kNone;
}

cs8::TouchResult touch_result(const ControllerState& state, const RunningCommand& ended) {
  cs8::TouchResult result;
  result.outcome = ended.outcome;
  result.phase = ended.broken_in;
  result.source = source_of(ended.last);
  result.contact = contact_joints(ended.last);
  result.stopped = wire_from_joints(ended.last && ended.last->stopped ? *ended.last->stopped
                                                                      : state.cabinet.drives.joints);
  result.first_source = source_of(ended.first);
  result.first_contact = contact_joints(ended.first);
  const double first_m = ended.first ? ended.first->overtravel_m : 0.0;
  const double last_m = ended.last ? ended.last->overtravel_m : 0.0;
  result.overtravel_dmm = cs8::dmm_from_metres(std::max(first_m, last_m));
  result.search_speed_um_s = ended.search_speed_um_s;
  result.monitor_speed_percent = ended.monitor_speed_percent;
  if (ended.last) result.contact_clock_ms = clock_ms(ended.last->at);
  result.error_number = ended.error_number;
  result.edges = ended.edges;
  return result;
}

}  // namespace

cs8::Welcome welcome(const Plant& plant, const ControllerState& state, std::uint32_t open_sequence,
                     TimePoint now) {
  cs8::Welcome message;
  message.application = cs8::text16("touchcal");
  message.arm = cs8::text16(plant.arm_name);
  message.application_version = kApplicationVersion;
  message.language_version = kLanguageVersion;
  message.session = state.session;
  message.last_sequence = state.last_sequence;
  message.open_sequence = open_sequence;
  message.heartbeat_timeout_ms = static_cast<std::uint32_t>(state.heartbeat_timeout.count());
  message.clock_ms = clock_ms(now);
  message.lower_limits = wire_from_joints(plant.joint_ranges.lower);
  message.upper_limits = wire_from_joints(plant.joint_ranges.upper);
  message.search_length_max_dmm = cs8::dmm_from_metres(kSearchLengthMaxMetres);
  message.search_speed_max_um_s = search_speed_max_um_s(plant);
  return message;
}

cs8::State state_report(const ControllerState& state, TimePoint now) {
  const Cabinet& cabinet = state.cabinet;
  const Panel& panel = cabinet.panel;
  const auto& running = state.motion.running;
  cs8::State report;
  report.session = state.session;
  report.clock_ms = clock_ms(now);
  const auto flag = [&report](cs8::StateFlag bit, bool on) { report.flags |= on ? bit : 0u; };
  flag(cs8::kPowered, panel.powered);
  flag(cs8::kHeld, panel.held);
  flag(cs8::kArmCalibrated, panel.arm_calibrated);
  flag(cs8::kSettled, cabinet.arm_stands());
  flag(cs8::kQueueEmpty, is_empty(cabinet.drives));
  flag(cs8::kProbeTouched, cabinet.world.probe.inputs.contact);
  flag(cs8::kProbeLoopClosed, cabinet.world.probe.inputs.loop);
  flag(cs8::kRetractDue, !state.motion.retract_path.empty());
  flag(cs8::kTouchTested, cabinet.touch_test == TouchTest::kDone);
  flag(cs8::kCellClosed, panel.cell_closed);
  report.mode = panel.mode;
  report.mode_status = panel.mode_status;
  report.emergency_stop = panel.emergency_stop;
  report.monitor_speed_percent = panel.monitor_speed_percent;
  report.joints = wire_from_joints(cabinet.drives.joints);
  report.active_sequence = running ? running->sequence : 0;
  report.phase = running ? phase_of(running->stage) : cs8::Phase::kIdle;
  report.task_error = cabinet.task_error;
  report.permit = state.permit.permit.state;
  report.move_id_milli = static_cast<std::int32_t>(move_id(cabinet.drives) * 1e3);
  report.overruns = cabinet.overruns;
  return report;
}

cs8::Message result(const ControllerState& state, const RunningCommand& ended) {
  if (std::holds_alternative<cs8::Touch>(ended.order)) return {ended.sequence, touch_result(state, ended)};
  const cs8::MoveResult moved{ended.outcome, ended.broken_in, wire_from_joints(state.cabinet.drives.joints),
                              ended.error_number};
  return {ended.sequence, moved};
}

}  // namespace sim
