#pragma once

#include <optional>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"

namespace calib {

/// Chi-square test of the residuals against the declared noise, in total and per face (a face without touches
/// has p = 1). A small p: the model does not describe the touched artefact.
struct LackOfFit {
  double chi_square = 0.0;
  double degrees_of_freedom = 0.0;
  double p = 1.0;
  std::vector<double> p_of_face;
};

/// With a smaller p the declared noise is rejected: all uncertainties use the estimated noise instead.
inline constexpr double kLackOfFitWidens = 0.05;

/// Nothing without a declared noise or without a degree of freedom. `fit` must have been solved at
/// `estimate`.
std::optional<LackOfFit> lack_of_fit(const IdentificationProblem& problem, LeastSquares& fit,
                                     const Estimate& estimate);

/// Noise of a touch from the residuals and the degrees of freedom, metres; nothing without any.
std::optional<double> estimated_noise_m(const LeastSquares& fit, const Estimate& estimate);

}  // namespace calib
