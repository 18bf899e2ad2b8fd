#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/acquisition/command_refusal.hpp"
#include "service/documents/plan.hpp"

/// What stands in the way of a start: all of it at once, before anything moves. Functions of what is known.
namespace cell {

/// As far as the controller tells. `fault`: that of the status, which says why there is no link.
std::vector<Unmet> unmet_by_controller(bool connected, const std::optional<cs8::State>& state,
                                       const std::optional<Fault>& fault);

/// Those of a run: `by_controller`, the fault that nobody has acknowledged, the cell's files, and why its
/// recipe has no plan (null: it has, or was not planned).
std::vector<Unmet> unmet_for_run(std::vector<Unmet> by_controller, const Cell& cell,
                                 const std::optional<Fault>& fault, const PlanRefusal* no_plan);

/// Those of a run by hand: all of a run's but what only a command that moves the arm needs.
std::vector<Unmet> unmet_without_motion(std::vector<Unmet> of_run);

}  // namespace cell
