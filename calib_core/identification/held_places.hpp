#pragma once

#include "calib_core/estimation/identification_problem.hpp"

namespace calib {

/// The problem while a place of the artefact without a prior has no fitted touch, or while those with a
/// further tip of the stylus do not find its ball: nothing is known of it and nothing depends on it, so that
/// it stays about where it is and the other touches have a result. What was touched with such a tip is not
/// fitted.
IdentificationProblem with_held_places(const IdentificationProblem& problem);

}  // namespace calib
