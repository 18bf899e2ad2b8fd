#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"

namespace calib {

/// F test of the residuals for one thing that is not in the model: a droop of the joints under the masses, in
/// the directions in which it would move the touches. What else is in the residuals counts as noise here, the
/// gears with it, so that it finds far less than a test of all residuals at once does.
struct DroopTest {
  double f = 0.0;
  double p = 1.0;
  double directions = 0.0;        // numerator's degrees of freedom
  double residual_degrees = 0.0;  // denominator's
  /// Of F when the compliance of each joint is off by one standard deviation.
  double noncentrality = 0.0;

  /// The probability that this test gives less than `p_min` (in (0, 1)) with such a droop.
  [[nodiscard]] double power(double p_min) const;
};

/// Such a droop is told of: chance makes it of nothing in 1 of 1,000 runs.
inline constexpr double kDroopShownP = 0.001;

/// Test of the residuals in total and per face (a face without touches has p = 1), against the noise that
/// they should have: where touches were repeated, an F test against what these say of it, with the maker's
/// figures of the gears; else a chi-square test against the declared noise. A small p: the model does not
/// describe the touched artefact.
struct LackOfFit {
  double statistic = 0.0;  // F, or chi-square over its degrees of freedom
  double degrees_of_freedom = 0.0;
  double noise_degrees = std::numeric_limits<double>::infinity();  // of the noise that is tested against
  double noise_m = 0.0;                                            // that noise
  double p = 1.0;
  std::vector<double> p_of_face;
  /// Of `noise_m`, where it is made of them: what repeats say, and the maker's figures of the gears, which
  /// bound it.
  double repeats_m = 0.0;
  double gears_m = 0.0;
  /// Nothing where the droop is in the model or has no deviation.
  std::optional<DroopTest> droop;

  [[nodiscard]] bool is_f_test() const { return std::isfinite(noise_degrees); }
};

/// A smaller p is a doubt: a run does not end early on it.
inline constexpr double kLackOfFitDoubtful = 0.05;

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
  /// What the uncertainty of everything with a prior is expected to add to the sum of squares.
  [[nodiscard]] double of_priors() const { return effective_parameters - effective_parameters_of_square; }
};

/// `covariance` is that of the unknowns, the inverse of fit.information().
ResidualSum residual_sum(const LeastSquares& fit, const Eigen::MatrixXd& covariance);

/// The declared noise counts as much as one degree of freedom of the residuals.
inline constexpr double kDeclaredNoiseDegrees = 1.0;

/// What repeated touches say of the noise of a touch, with the declared noise as its prior (0: unknown).
TouchNoise repeat_noise(double declared_m, const std::optional<TouchNoise>& pure_error);

/// Whether the residuals are so small that the declared noise is too large (1 in 1,000).
bool is_declared_too_large(const IdentificationProblem& problem, const LeastSquares& fit,
                           const Estimate& estimate);

/// What the residuals are expected to be made of.
struct ExpectedNoise {
  TouchNoise repeats;
  double gear_variance_m2 = 0.0;  // of a touch by the maker's figures
};

/// Nothing without a declared noise or without a degree of freedom. `fit` must have been solved at
/// `estimate`.
std::optional<LackOfFit> lack_of_fit(const IdentificationProblem& problem, LeastSquares& fit,
                                     const Estimate& estimate, const ResidualSum& residuals,
                                     const ExpectedNoise& expected);

/// Noise of a touch from the residuals and the degrees of freedom, metres; nothing without any.
std::optional<double> estimated_noise_m(const LeastSquares& fit, const Estimate& estimate);

/// The declared noise, corrected by what the residuals say: the mean of both variances, weighted by their
/// degrees of freedom. What is not in the model counts as noise here. Unlike estimated_noise_m() it does not
/// count the priors as observations: they say nothing of the noise. Only the declared noise when the
/// residuals have no degree of freedom, and 0 when neither is known. `declared_m`: 0 is unknown.
/// `noise_unit_m`: that of the fit.
TouchNoise measured_noise(double declared_m, const ResidualSum& residuals, double noise_unit_m);

}  // namespace calib
