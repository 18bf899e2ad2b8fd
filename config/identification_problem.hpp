#pragma once

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"

namespace cell {

/// Everything that identifies an arm in this cell but the touches: the nominal arm, the artefact with what is
/// uncertain of it at each place of the recipe, the declared noise, the tolerances. The only place where a
/// cell becomes a problem. `in`: the place where the block stands in `cell`, whose R_-1 the problem has.
calib::IdentificationProblem identification_problem(const Cell& cell, const Recipe& recipe, int in = 0);

}  // namespace cell
