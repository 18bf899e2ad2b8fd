#pragma once

#include <vector>

#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"

namespace cell {

/// The planner's input for a recipe in this cell, whose block stands at a place of the recipe: the touches
/// there, in R_-1 there. The goal counts those of all places.
calib::PlanningProblem planning_problem(const Cell& cell, const Recipe& recipe, int place = 0);

/// For each place of the recipe, in order.
std::vector<calib::PlanningProblem> planning_problems(const Cell& cell, const Recipe& recipe);

}  // namespace cell
