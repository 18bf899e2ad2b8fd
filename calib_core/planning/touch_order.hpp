#pragma once

#include <optional>
#include <vector>

#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/planning/touch_plan.hpp"

namespace calib {

/// The touches in execution order. Fitted touches come before all others. No face is repeated while
/// another has touches left, and the completed share of each face stays about proportional. The first
/// touches, a few more than identifiable parameters, are those with the most information for the travel time;
/// the order of the others minimises the travel time from the park posture and back.
std::vector<PlannedTouch> order_touches(const PlanningProblem& problem, std::vector<PlannedTouch> touches);

/// The touches in the given order with transfers and predicted times (PlannedTouch::via, travel_s, touch_s;
/// TouchPlan::park_via, park_s). A transfer keeps the smaller predicted position error of its two touches,
/// the nominal one for a touch without a prediction. Nothing when there is no path, which does not happen
/// with touches from make_touch.
std::optional<TouchPlan> find_paths(const PlanningProblem& problem, std::vector<PlannedTouch> touches);

}  // namespace calib
