#pragma once

#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/identification/identification_result.hpp"

namespace calib {

/// The method of the paper (section III): choose the identifiable parameters once on the nominal model, then
/// solve eq. 15 and update until the step vanishes. Artefact parameters are estimated together with the arm,
/// with their priors. With `robust`, touches that are inconsistent with the others are found and left out:
/// least trimmed squares for the start, then a significance test. Every call starts from all touches. Its
/// only random numbers come from a fixed seed.
IdentificationResult identify(const IdentificationProblem& problem, const IdentificationOptions& options);

}  // namespace calib
