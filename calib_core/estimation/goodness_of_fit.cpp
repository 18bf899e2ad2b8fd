#include "calib_core/estimation/goodness_of_fit.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/numerics/distributions.hpp"

namespace calib {
namespace {

/// Residuals with fewer say nothing of the noise.
constexpr double kNoiseDegreesMin = 0.5;

double survival(double chi_square, double degrees) {
  const double shrink = std::min(1.0, kChiSquareDegreesMax / degrees);
  return chi_square_survival(chi_square * shrink, degrees * shrink);
}

}  // namespace

std::optional<LackOfFit> lack_of_fit(const IdentificationProblem& problem, LeastSquares& fit,
                                     const Estimate& estimate) {
  const int degrees = fit.degrees_of_freedom();
  if (problem.touch_noise_m <= 0.0 || degrees <= 0) return std::nullopt;
  LackOfFit result;
  result.chi_square = fit.chi_square(estimate);
  result.degrees_of_freedom = degrees;
  result.p = survival(result.chi_square, degrees);
  const Eigen::VectorXd& leverages = fit.leverages();
  const std::size_t faces = problem.artefact.contact_planes.size();
  std::vector<double> sum(faces, 0.0), freedom(faces, 0.0);
  for (Eigen::Index row = 0; row < leverages.size(); ++row) {
    const auto index = static_cast<std::size_t>(row);
    if (!fit.kept()[index]) continue;
    const auto face = static_cast<std::size_t>(problem.touches[fit.touches()[index]].face);
    const double scaled = fit.residuals_m()[row] / fit.noise_unit_m();
    sum[face] += scaled * scaled;
    freedom[face] += std::max(0.0, 1.0 - leverages[row]);
  }
  for (std::size_t face = 0; face < faces; ++face) {
    result.p_of_face.push_back(freedom[face] > 0.5 ? survival(sum[face], freedom[face]) : 1.0);
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
  const double rms = fit.residual_rms_m() / fit.noise_unit_m();
  return {fit.kept_count(), rms * rms * fit.kept_count(), hat.trace(),
          hat.cwiseProduct(hat.transpose()).sum()};
}

TouchNoise measured_noise(double declared_m, const ResidualSum& residuals, double noise_unit_m) {
  // 1 - hat is the inverse of V = 1 + rows * prior covariance * rows^T, the covariance of the residuals
  // before the fit in units of the assumed noise. For a true noise of r units the sum of squares is expected
  // to be r^2 tr(V^-2) + tr(V^-1) - tr(V^-2); the last two are the share of the priors.
  const double degrees = residuals.noise_degrees();
  const double of_priors = residuals.effective_parameters - residuals.effective_parameters_of_square;
  const double declared_degrees = declared_m > 0.0 ? kDeclaredNoiseDegrees : 0.0;
  if (degrees < kNoiseDegreesMin) return {declared_m, declared_degrees};
  const double of_declared = declared_degrees * std::pow(declared_m / noise_unit_m, 2);
  const double sum_of_squares = std::max(0.0, residuals.sum_of_squares - of_priors);
  const double variance = (of_declared + sum_of_squares) / (declared_degrees + degrees);
  return {noise_unit_m * std::sqrt(variance), declared_degrees + degrees};
}

}  // namespace calib
