#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/acquisition/command_refusal.hpp"
#include "service/documents/plan.hpp"
#include "service/run/readiness.hpp"
#include "service/store/run_page.hpp"

/// The preconditions of a start, all checked at once before anything moves. Pure functions.
namespace cell {

/// Those that the controller's state does not meet. `fault`: the status's fault, which explains a missing
/// link.
std::vector<Unmet> unmet_by_controller(bool connected, const std::optional<cs8::State>& state,
                                       const std::optional<Fault>& fault);

/// What a person at the cell does about the first of them that a person can meet; null where there is none.
const AwaitedAction* awaited_before_start(const std::vector<Unmet>& unmet);

/// What of a request counts: the temperature of the block that it gives, if it gives one, and its time.
struct StartConditions {
  std::optional<BlockTemperature> block_temperature;
  std::chrono::system_clock::time_point now;
};

/// The temperature of the block, where no run may begin with it.
std::optional<Unmet> unmet_by_temperature(const Cell& cell, const StartConditions& start);

/// Those of a run: `by_controller`, the unacknowledged fault, the cell's files with what the request gives,
/// and why its recipe has no plan (null: it has one, or was not planned).
std::vector<Unmet> unmet_for_run(std::vector<Unmet> by_controller, const Cell& cell,
                                 const StartConditions& start, const std::optional<Fault>& fault,
                                 const PlanRefusal* no_plan);

/// The place where the last run of these files (`config_digest`) had its block, when none is loaded now:
/// without it the arm would pass the block where the files have it. `runs`: newest first, one is enough.
/// Where that one is damaged, nobody can tell whether it had such a place, and one has to be loaded.
std::optional<Unmet> unmet_by_lost_place(const RunPage& runs, const std::optional<std::string>& config_digest,
                                         bool place_is_known);

/// Code of a start that waits for the probe to be mounted where a tool was.
inline constexpr const char* kProbeNotMounted = "probe_not_mounted";

/// Those of a guided run: without the preconditions that only commanded motion needs.
std::vector<Unmet> unmet_without_motion(std::vector<Unmet> of_run);

}  // namespace cell
