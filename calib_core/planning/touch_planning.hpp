#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <variant>

#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/planning/touch_plan.hpp"

namespace calib {

/// Progress callback: the current stage and the completed share of the whole, 0 to 1.
using PlanningProgress = std::function<void(std::string_view stage, double share)>;

/// Plans the requested touches: finds feasible postures (TouchMaker states the conditions), chooses those
/// that determine the kinematic errors best (fitted) and others at a distance from them (held out), and
/// orders them so that all parameters are determined early and travel is short. There is a transfer between
/// any two of the touches: see find_transfer. Throws std::logic_error for a face that does not exist.
std::variant<TouchPlan, PlanningFailure> plan_touches(const PlanningProblem& problem,
                                                      const PlanningProgress& progress = {});

/// Plans touches of one artefact at several places, one after the other: chosen together, ordered and joined
/// by transfers place by place. `places`: the same arm, artefact and goal in the R_-1 of each place, each
/// with the requests of its own faces; the goal counts the touches of all.
std::variant<TouchPlan, PlanningFailure> plan_touches(std::span<const PlanningProblem> places,
                                                      const PlanningProgress& progress = {});

}  // namespace calib
