#pragma once

#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"

namespace cell {

/// The planner's input for a recipe in this cell.
calib::PlanningProblem planning_problem(const Cell& cell, const Recipe& recipe);

}  // namespace cell
