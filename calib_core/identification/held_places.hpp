#pragma once

#include "calib_core/estimation/identification_problem.hpp"

namespace calib {

/// The problem while a place of the artefact without a prior, or a further tip of the stylus, has no fitted
/// touch: nothing is known of it and nothing depends on it, so that it stays about where it is and the
/// touches so far have a result.
IdentificationProblem with_held_places(const IdentificationProblem& problem);

}  // namespace calib
