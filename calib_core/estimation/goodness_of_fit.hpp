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

/// A smaller p is a doubt: a run does not end early on it.
inline constexpr double kLackOfFitDoubtful = 0.05;

/// Noise of a touch and how well it is known.
struct TouchNoise {
  double std_m = 0.0;
  double degrees_of_freedom = 0.0;
};

/// The residuals of a fit in units of the noise that it assumed, and how many parameters the fit had: the
/// trace of its hat matrix, in which a parameter with a prior counts for the share that the touches
/// determine.
struct ResidualSum {
  int touch_count = 0;
  double sum_of_squares = 0.0;
  double effective_parameters = 0.0;
  double effective_parameters_of_square = 0.0;  // trace of the hat matrix squared

  /// Degrees of freedom of the residuals for the noise: trace of (1 - hat)^2.
  [[nodiscard]] double noise_degrees() const {
    return touch_count - 2.0 * effective_parameters + effective_parameters_of_square;
  }
};

/// `covariance` is that of the unknowns, the inverse of fit.information().
ResidualSum residual_sum(const LeastSquares& fit, const Eigen::MatrixXd& covariance);

/// The declared noise counts as much as one degree of freedom of the residuals.
inline constexpr double kDeclaredNoiseDegrees = 1.0;

/// Nothing without a declared noise or without a degree of freedom. `fit` must have been solved at
/// `estimate`.
std::optional<LackOfFit> lack_of_fit(const IdentificationProblem& problem, LeastSquares& fit,
                                     const Estimate& estimate);

/// Noise of a touch from the residuals and the degrees of freedom, metres; nothing without any.
std::optional<double> estimated_noise_m(const LeastSquares& fit, const Estimate& estimate);

/// The declared noise, corrected by what the residuals say: the mean of both variances, weighted by their
/// degrees of freedom. What is not in the model counts as noise here. Unlike estimated_noise_m() it does not
/// count the priors as observations: they say nothing of the noise. Only the declared noise when the
/// residuals have no degree of freedom, and 0 when neither is known. `declared_m`: 0 is unknown.
/// `noise_unit_m`: that of the fit.
TouchNoise measured_noise(double declared_m, const ResidualSum& residuals, double noise_unit_m);

}  // namespace calib
