#pragma once

#include <cstddef>
#include <vector>

#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {

/// One standard deviation of the mean distance of touches of one face from its plane by the fitted model,
/// metres: the noise of the touches over the root of their number, and what is uncertain in the model that
/// the distance is taken with: arm and artefact, fitted or left out, with their correlations. `touches` are
/// indices into those of the problem and none of them was fitted; at least one.
double mean_distance_std_m(const IdentificationProblem& problem, const LeastSquares& fit,
                           const FullLinearisation& whole, const UncertaintyBudget& budget,
                           const Estimate& estimate, const std::vector<std::size_t>& touches);

}  // namespace calib
