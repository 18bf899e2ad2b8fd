#include "service/acquisition/touch_judgement.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib_core/geometry/units.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/run/touch_command.hpp"

namespace cell {
namespace {

using Next = TouchJudgement::Next;

constexpr double kSigmas = 5.0;

/// A radius nearer to that of the file than this is never called another stylus.
constexpr double kOtherStylusMetres = 1e-4;

TouchJudgement fault(FaultCode code, std::string detail, Event event) {
  return {.next = Next::kFault, .fault = {code, std::move(detail)}, .event = event, .warnings = {}};
}

/// Made again as long as that may help, then a person is asked.
TouchJudgement again_or_hold(FaultCode code, std::string detail, int attempts, int again_max) {
  if (attempts >= again_max) return fault(code, std::move(detail), Event::kHoldFault);
  return {.next = Next::kAgain, .fault = {code, std::move(detail)}, .event = {}, .warnings = {}};
}

Eigen::Vector3d tip_m(const Cell& cell, const calib::JointVector& joints) {
  return calib::forward_kinematics(cell.arm.model, joints).translation();
}

double along_search_m(const Cell& cell, const calib::PlannedTouch& planned,
                      const cs8::JointsMicrodeg& contact) {
  const Eigen::Vector3d begin = tip_m(cell, planned.approach_joints);
  const Eigen::Vector3d search = tip_m(cell, planned.search_end_joints) - begin;
  return (tip_m(cell, from_wire(contact)) - begin).dot(search.normalized());
}

std::vector<Fault> warnings_of(const cs8::TouchResult& result) {
  std::vector<Fault> warnings;
  if (result.edges > 1) warnings.push_back({FaultCode::kProbeBounced, fmt::format("{} edges", result.edges)});
  if (result.source == cs8::CaptureSource::kPolled)
    warnings.push_back({FaultCode::kLatchMissing, "late by up to 4 ms of the touch's speed"});
  return warnings;
}

TouchJudgement judge_spread(double spread_m, const TouchHistory& history) {
  const std::string detail = fmt::format("{:.3f} mm", calib::mm_from_metres(spread_m));
  if (history.spread_m && spread_m > *history.spread_m)
    return fault(FaultCode::kRetriesWorse,
                 fmt::format("{:.3f} mm, then {}", calib::mm_from_metres(*history.spread_m), detail),
                 Event::kHoldFault);
  return again_or_hold(FaultCode::kTouchSpread, detail, history.attempts, kRetriesMax);
}

}  // namespace

TouchJudgement judge_touch(const Cell& cell, const calib::PlannedTouch& planned,
                           const cs8::TouchResult& result, const TouchHistory& history) {
  if (result.outcome == cs8::Outcome::kNoContact && result.edges > 0)
    return again_or_hold(FaultCode::kFalseTrigger, fmt::format("{} edges", result.edges), history.attempts,
                         1);
  if (auto ended = fault_of(result.outcome, result.phase, result.error_number)) {
    return {.next = Next::kFault,
            .fault = std::move(ended->fault),
            .event = ended->holds ? Event::kHoldFault : Event::kAbortFault,
            .warnings = {}};
  }
  if (result.outcome != cs8::Outcome::kContact) return {.next = Next::kStopped};
  if (result.monitor_speed_percent != 100)
    return fault(FaultCode::kMonitorSpeedChanged,
                 fmt::format("it was {} % in the search", result.monitor_speed_percent),
                 Event::kSuspendFault);
  if (history.last_contact == result.contact)
    return again_or_hold(FaultCode::kRepeatedTouch, {}, history.attempts, 1);
  const double overtravel_m = cs8::metres_from_dmm(result.overtravel_dmm);
  if (cell.probe.overtravel_m > 0.0 && overtravel_m > cell.probe.overtravel_m)
    return fault(FaultCode::kOvertravel,
                 fmt::format("{:.2f} mm, and the stylus bends by {:.2f}", calib::mm_from_metres(overtravel_m),
                             calib::mm_from_metres(cell.probe.overtravel_m)),
                 Event::kAbortFault);
  if (const auto why = implausibility_reason(cell, planned, result))
    return fault(FaultCode::kImplausibleTouch, *why, Event::kAbortFault);
  const auto spread = contact_spread_m(cell, result);
  if (spread && *spread > kContactSpreadMaxMetres) return judge_spread(*spread, history);
  const double along_m = along_search_m(cell, planned, result.contact);
  if (along_m < kEarlyContactMetres)
    return fault(FaultCode::kEarlyContact,
                 fmt::format("after {:.2f} mm of its search", calib::mm_from_metres(along_m)),
                 Event::kHoldFault);
  return {.next = Next::kKeep, .fault = {}, .event = {}, .warnings = warnings_of(result)};
}

std::optional<double> contact_spread_m(const Cell& cell, const cs8::TouchResult& result) {
  const bool both =
      result.source != cs8::CaptureSource::kNone && result.first_source != cs8::CaptureSource::kNone;
  if (!cell.speeds.second || !both) return std::nullopt;
  return (tip_m(cell, from_wire(result.contact)) - tip_m(cell, from_wire(result.first_contact))).norm();
}

std::optional<FirstContact> first_contact_in(const cs8::TouchResult& result) {
  if (result.first_source == cs8::CaptureSource::kNone) return std::nullopt;
  return FirstContact{.source = result.first_source, .joints = result.first_contact};
}

double agreement_max_m(const Cell& cell) { return kSigmas * std::numbers::sqrt2 * cell.touch_noise_m; }

double reference_drift_max_m(const Cell& cell) {
  return cell.acceptance.reference_drift_max_m.value_or(agreement_max_m(cell));
}

namespace {

/// A ball of a star that is farther from where it is drawn than the clearances of its touches count with. Its
/// centre is three parameters in a row.
std::optional<Fault> star_fault(const calib::IdentificationProblem& problem,
                                const calib::IdentificationResult& result) {
  const auto& parameters = problem.artefact.parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].kind != calib::ArtefactKind::kTipCenter) continue;
    const auto first = static_cast<Eigen::Index>(i);
    const double off_m = result.artefact_errors.segment<3>(first).norm();
    const double std_m = result.uncertainty ? result.uncertainty->artefact_std.segment<3>(first).norm() : 0.0;
    const std::string name = parameters[i].name.substr(0, parameters[i].name.rfind('_'));
    i += 2;
    if (off_m <=
        parameters[static_cast<std::size_t>(first)].within_m + std::max(kOtherStylusMetres, kSigmas * std_m))
      continue;
    return Fault{FaultCode::kWrongStylus,
                 fmt::format("{}: {:.3f} mm from where it is drawn, and the probe's file says within {:.3f}",
                             name, calib::mm_from_metres(off_m),
                             calib::mm_from_metres(parameters[static_cast<std::size_t>(first)].within_m))};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Fault> stylus_fault(const calib::IdentificationProblem& problem,
                                  const calib::IdentificationResult& result) {
  const auto& parameters = problem.artefact.parameters;
  if (result.artefact_errors.size() != static_cast<Eigen::Index>(parameters.size())) return std::nullopt;
  if (auto fault = star_fault(problem, result)) return fault;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double error_m = result.artefact_errors[static_cast<Eigen::Index>(i)];
    const double limit_m = std::max(kOtherStylusMetres, kSigmas * parameters[i].std.value_or(0.0));
    if (parameters[i].kind != calib::ArtefactKind::kStylusRadius || std::abs(error_m) <= limit_m) continue;
    return Fault{FaultCode::kWrongStylus, fmt::format("by {:.3f} mm", calib::mm_from_metres(error_m))};
  }
  return std::nullopt;
}

std::optional<Fault> face_warning(const calib::IdentificationResult& result, double lack_of_fit_p_min) {
  if (!result.lack_of_fit) return std::nullopt;
  std::string planes;
  const std::vector<double>& p_of_face = result.lack_of_fit->p_of_face;
  for (std::size_t i = 0; i < p_of_face.size(); ++i) {
    if (p_of_face[i] < lack_of_fit_p_min)
      planes += fmt::format("{}plane {}", planes.empty() ? "" : ", ", i + 1);
  }
  if (planes.empty()) return std::nullopt;
  return Fault{FaultCode::kFaceBias, planes};
}

std::optional<Fault> plan_fault(const std::vector<calib::PlannedTouch>& touches) {
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const calib::PlannedTouch& touch = touches[i];
    const bool numbers = touch.clear_joints.allFinite() && touch.approach_joints.allFinite() &&
                         touch.search_end_joints.allFinite() && touch.joints.allFinite();
    if (numbers && touch.approach_joints != touch.search_end_joints) continue;
    return Fault{FaultCode::kPlanInvalid, fmt::format("touch {}", i + 1)};
  }
  return std::nullopt;
}

}  // namespace cell
