#include "calib_core/estimation/goodness_of_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib_core/numerics/distributions.hpp"

namespace calib {
namespace {

/// Residuals with fewer say nothing of the noise.
constexpr double kNoiseDegreesMin = 0.5;

/// Residuals so small are improbable.
constexpr double kTooSmallProbability = 0.001;

double chi_square_tail(double chi_square, double degrees) {
  const double shrink = std::min(1.0, kChiSquareDegreesMax / degrees);
  return chi_square_survival(chi_square * shrink, degrees * shrink);
}

/// P of a mean square over the variance that it is tested against.
double tail(double ratio, double degrees, double noise_degrees) {
  if (std::isinf(noise_degrees)) return chi_square_tail(ratio * degrees, degrees);
  return f_survival(std::min(ratio, std::numeric_limits<double>::max()), degrees, noise_degrees);
}

/// Sum of squares of the residuals of each face in units of the fit's noise, and their degrees of freedom.
struct FaceSums {
  std::vector<double> squares, freedom;
};

FaceSums face_sums(const IdentificationProblem& problem, LeastSquares& fit) {
  const Eigen::VectorXd& leverages = fit.leverages();
  const std::size_t faces = problem.artefact.contact_planes.size();
  FaceSums sums{std::vector<double>(faces, 0.0), std::vector<double>(faces, 0.0)};
  for (Eigen::Index row = 0; row < leverages.size(); ++row) {
    const auto index = static_cast<std::size_t>(row);
    if (!fit.kept()[index]) continue;
    const auto face = static_cast<std::size_t>(problem.touches[fit.touches()[index]].face);
    sums.squares[face] += std::pow(fit.weighted_residuals()[row], 2);
    sums.freedom[face] += std::max(0.0, 1.0 - leverages[row]);
  }
  return sums;
}

/// Against the declared noise, by all terms of the fit.
std::optional<LackOfFit> against_declared(const IdentificationProblem& problem, const LeastSquares& fit,
                                          const Estimate& estimate) {
  const int degrees = fit.degrees_of_freedom();
  if (degrees <= 0) return std::nullopt;
  return LackOfFit{.statistic = fit.chi_square(estimate) / degrees,
                   .degrees_of_freedom = static_cast<double>(degrees),
                   .noise_m = problem.touch_noise_m};
}

/// Against the repeated touches and the gears: the maker's figure of these is taken as known.
std::optional<LackOfFit> against_repeats(const LeastSquares& fit, const ResidualSum& residuals,
                                         const ExpectedNoise& expected) {
  const double degrees = residuals.noise_degrees();
  if (degrees < kNoiseDegreesMin) return std::nullopt;
  const double of_repeats = expected.repeats.std_m * expected.repeats.std_m;
  const double variance = of_repeats + expected.gear_variance_m2;
  const double share = of_repeats / variance;
  return LackOfFit{.statistic = std::max(0.0, residuals.sum_of_squares - residuals.of_priors()) / degrees *
                                fit.noise_unit_m() * fit.noise_unit_m() / variance,
                   .degrees_of_freedom = degrees,
                   .noise_degrees = expected.repeats.degrees_of_freedom / (share * share),
                   .noise_m = std::sqrt(variance),
                   .repeats_m = expected.repeats.std_m,
                   .gears_m = std::sqrt(expected.gear_variance_m2)};
}

}  // namespace

double DroopTest::power(double p_min) const {
  if (p_min <= 0.0) return 0.0;
  return f_power(p_min, directions, residual_degrees, noncentrality);
}

TouchNoise repeat_noise(double declared_m, const std::optional<TouchNoise>& pure_error) {
  const TouchNoise declared{declared_m, declared_m > 0.0 ? kDeclaredNoiseDegrees : 0.0};
  return pooled(declared, pure_error.value_or(TouchNoise{}));
}

bool is_declared_too_large(const IdentificationProblem& problem, const LeastSquares& fit,
                           const Estimate& estimate) {
  const auto test = against_declared(problem, fit, estimate);
  return test && problem.touch_noise_m > 0.0 &&
         1.0 - tail(test->statistic, test->degrees_of_freedom, test->noise_degrees) < kTooSmallProbability;
}

std::optional<LackOfFit> lack_of_fit(const IdentificationProblem& problem, LeastSquares& fit,
                                     const Estimate& estimate, const ResidualSum& residuals,
                                     const ExpectedNoise& expected) {
  if (problem.touch_noise_m <= 0.0) return std::nullopt;
  auto result = problem.pure_error ? against_repeats(fit, residuals, expected)
                                   : against_declared(problem, fit, estimate);
  if (!result) return std::nullopt;
  result->p = tail(result->statistic, result->degrees_of_freedom, result->noise_degrees);
  const double unit = std::pow(fit.noise_unit_m() / result->noise_m, 2);
  const FaceSums sums = face_sums(problem, fit);
  for (std::size_t face = 0; face < sums.squares.size(); ++face) {
    const double freedom = sums.freedom[face];
    result->p_of_face.push_back(
        freedom > kNoiseDegreesMin ? tail(unit * sums.squares[face] / freedom, freedom, result->noise_degrees)
                                   : 1.0);
  }
  return result;
}

std::optional<double> estimated_noise_m(const LeastSquares& fit, const Estimate& estimate) {
  const int degrees = fit.degrees_of_freedom();
  if (degrees <= 0) return std::nullopt;
  return fit.noise_unit_m() * std::sqrt(fit.chi_square(estimate) / degrees);
}

ResidualSum residual_sum(const LeastSquares& fit, const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd hat = covariance * fit.touch_information();
  return {fit.kept_count(), fit.weighted_square_sum(), hat.trace(), hat.cwiseProduct(hat.transpose()).sum()};
}

TouchNoise measured_noise(double declared_m, const ResidualSum& residuals, double noise_unit_m) {
  // 1 - hat is the inverse of V = 1 + rows * prior covariance * rows^T, the covariance of the residuals
  // before the fit in units of the assumed noise. For a true noise of r units the sum of squares is expected
  // to be r^2 tr(V^-2) + tr(V^-1) - tr(V^-2); the last two are the share of the priors.
  const double degrees = residuals.noise_degrees();
  const double declared_degrees = declared_m > 0.0 ? kDeclaredNoiseDegrees : 0.0;
  if (degrees < kNoiseDegreesMin) return {declared_m, declared_degrees};
  const double of_declared = declared_degrees * std::pow(declared_m / noise_unit_m, 2);
  const double sum_of_squares = std::max(0.0, residuals.sum_of_squares - residuals.of_priors());
  const double variance = (of_declared + sum_of_squares) / (declared_degrees + degrees);
  return {noise_unit_m * std::sqrt(variance), declared_degrees + degrees};
}

}  // namespace calib
