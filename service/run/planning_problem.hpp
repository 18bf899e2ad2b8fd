#pragma once

#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"

namespace cell {

/// What the planner needs to know of the cell to make a recipe's touches.
calib::PlanningProblem planning_problem(const Cell& cell, const Recipe& recipe);

}  // namespace cell
