#include "service/acquisition/preconditions.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "service/acquisition/link_fault.hpp"
#include "service/base/state_directory.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/run/block_temperature.hpp"

namespace cell {
namespace {

/// The fault table's own words, and what is special about this time.
Unmet unmet(FaultCode code, const std::string& special = {}) {
  const FaultEntry& entry = describe(code);
  const std::string next_step(entry.next_step);
  return {std::string(entry.name), special.empty() ? next_step : fmt::format("{} ({})", next_step, special)};
}

std::vector<Unmet> unmet_by(const cs8::State& state) {
  std::vector<Unmet> found;
  const auto flag = [&](cs8::StateFlag bit) { return (state.flags & bit) != 0; };
  if (state.emergency_stop != 0) found.push_back(unmet(FaultCode::kEmergencyStop));
  if (state.mode != cs8::WorkingMode::kRemote) found.push_back(unmet(FaultCode::kNotRemote));
  if (!flag(cs8::kPowered)) found.push_back(unmet(FaultCode::kNotPowered));
  if (flag(cs8::kHeld)) found.push_back(unmet(FaultCode::kHold));
  if (!flag(cs8::kArmCalibrated)) found.push_back(unmet(FaultCode::kNotCalibrated));
  // Behind a search that was broken off the face may hold the stylus: the run's first motion takes it off.
  if (flag(cs8::kProbeTouched) && !flag(cs8::kRetractDue)) found.push_back(unmet(FaultCode::kProbeTouched));
  if (state.task_error != 0)
    found.push_back(unmet(FaultCode::kTaskError, fmt::format("error {}", state.task_error)));
  if (state.monitor_speed_percent != 100)
    found.push_back(unmet(FaultCode::kMonitorSpeed, fmt::format("it is {} %", state.monitor_speed_percent)));
  return found;
}

}  // namespace

std::vector<Unmet> unmet_by_controller(bool connected, const std::optional<cs8::State>& state,
                                       const std::optional<Fault>& fault) {
  if (!connected) {
    return {{std::string(describe(FaultCode::kControllerNotConnected).name),
             fault ? fault->message() : "there is no link to the controller yet"}};
  }
  if (!state) return {unmet(FaultCode::kControllerStateUnknown)};
  return unmet_by(*state);
}

const AwaitedAction* awaited_before_start(const std::vector<Unmet>& unmet) {
  for (const Unmet& one : unmet) {
    if (const AwaitedAction* awaited = awaited_by_precondition(one.code)) return awaited;
  }
  return nullptr;
}

std::optional<Unmet> unmet_by_temperature(const Cell& cell, const StartConditions& start) {
  auto refusal = refuse_temperature(cell, start.block_temperature, start.now);
  if (!refusal) return std::nullopt;
  return Unmet{std::move(refusal->code), std::move(refusal->words)};
}

std::vector<Unmet> unmet_for_run(std::vector<Unmet> by_controller, const Cell& cell,
                                 const StartConditions& start, const std::optional<Fault>& fault,
                                 const PlanRefusal* no_plan) {
  std::vector<Unmet> found = std::move(by_controller);
  // Reset and clear acknowledge too; a fault with which a run came to its end is still there to be read.
  if (fault && !is_link_fault(fault->code))
    found.push_back(unmet(FaultCode::kFaultUnacknowledged, fault->message()));
  if (!cell.probe.tip_is_contact_point && cell.speeds.contact_m_s() != cell.probe.calibration_speed_m_s)
    found.push_back(unmet(FaultCode::kProbeNotCalibrated));
  if (auto one = unmet_by_temperature(cell, start)) found.push_back(*std::move(one));
  if (no_plan) found.push_back(unmet(FaultCode::kRecipeUnreachable, no_plan->message));
  return found;
}

std::optional<Unmet> unmet_by_lost_place(const RunPage& runs, const std::optional<std::string>& config_digest,
                                         bool place_is_known) {
  if (place_is_known) return std::nullopt;
  const std::int64_t newest = runs.runs.empty() ? 0 : runs.runs.front().id;
  if (!runs.damaged.empty() && runs.damaged.front().id > newest) {
    const DamagedRun& damaged = runs.damaged.front();
    return Unmet{
        "place_lost",
        fmt::format("find the block with touchcal locate, or mend the state directory (whether run {} "
                    "had it at a place that was found by touches cannot be read: {})",
                    damaged.id, damaged.what)};
  }
  if (runs.runs.empty()) return std::nullopt;
  const StoredRun& last = runs.runs.front();
  if (!names_place(last.conditions_json)) return std::nullopt;
  if (last.config_digest != config_digest) {
    return Unmet{
        "place_lost",
        fmt::format("find the block with touchcal locate (run {} had it at a place that was found by "
                    "touches, which files that have changed since do not know)",
                    last.id)};
  }
  return Unmet{
      "place_lost",
      fmt::format("restore {} of the state directory, or find the block with touchcal locate (run {} had "
                  "it at a place that was found by touches, and that file is gone)",
                  kBlockPoseFile, last.id)};
}

std::vector<Unmet> unmet_without_motion(std::vector<Unmet> of_run) {
  constexpr std::array kForMotion{
      FaultCode::kEmergencyStop, FaultCode::kNotRemote,    FaultCode::kNotPowered,        FaultCode::kHold,
      FaultCode::kProbeTouched,  FaultCode::kMonitorSpeed, FaultCode::kProbeNotCalibrated};
  std::erase_if(of_run, [&](const Unmet& one) {
    return std::ranges::any_of(kForMotion, [&](FaultCode code) { return describe(code).name == one.code; });
  });
  return of_run;
}

}  // namespace cell
