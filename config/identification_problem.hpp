#pragma once

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"

namespace cell {

/// Everything that identifies an arm in this cell but the touches: the nominal arm, the artefact with what is
/// uncertain of it, the declared noise, the tolerances. The only place where a cell becomes a problem.
calib::IdentificationProblem identification_problem(const Cell& cell, const Recipe& recipe);

}  // namespace cell
