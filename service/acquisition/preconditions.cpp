// What stands in the way of a start: all of it at once, before anything moves.
#include <spdlog/fmt/fmt.h>

#include "service/acquisition/operation.hpp"
#include "service/run/run_conditions.hpp"

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

std::vector<Unmet> Operation::unmet_preconditions() const {
  if (!client_.connected()) {
    return {{std::string(describe(FaultCode::kControllerNotConnected).name),
             status_.fault ? status_.fault->message() : "there is no link to the controller yet"}};
  }
  const auto state = client_.latest_state();
  if (!state) return {unmet(FaultCode::kControllerStateUnknown)};
  return unmet_by(*state);
}

/// Those of a run by this recipe.
std::vector<Unmet> Operation::unmet_for(const std::string& recipe) const {
  std::vector<Unmet> found = unmet_preconditions();
  // Reset and clear acknowledge too; a fault with which a run came to its end is still there to be read.
  if (status_.fault && !is_link_fault(status_.fault->code))
    found.push_back(unmet(FaultCode::kFaultUnacknowledged, status_.fault->message()));
  if (!cell_.probe.tip_is_contact_point && cell_.speeds.contact_m_s() != cell_.probe.calibration_speed_m_s)
    found.push_back(unmet(FaultCode::kProbeNotCalibrated));
  if (const auto gap = unknown_temperature_reason(cell_)) found.push_back({"temperature_missing", *gap});
  const auto outcome = planned(recipe);
  const auto* refusal = outcome ? std::get_if<PlanRefusal>(&*outcome) : nullptr;
  if (refusal) found.push_back(unmet(FaultCode::kRecipeUnreachable, refusal->message));
  return found;
}

}  // namespace cell
