#include "calib_core/uncertainty/residual_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/distributions.hpp"

namespace calib {
namespace {

constexpr int kGearScaleSteps = 24;
constexpr double kGearScaleMax = 4.0;
constexpr int kNoiseSteps = 24;
/// The least and the largest noise that is tried, of the largest one that was seen.
constexpr double kNoiseShareMin = 0.02, kNoiseShareMax = 2.5;

/// Of the information that touches have on the droop, in its deviations: less than this beside what was
/// estimated is rounding.
constexpr double kSeenMin = 1e-9;

/// Of the declared noise's: residuals with less are rounding, of touches that nobody measured.
constexpr double kVarianceMin = 1e-6;
/// With more the test finds the droop for certain.
constexpr double kNoncentralityMax = 1e5;

/// Logarithm of the density of a variance that was seen with these degrees of freedom, of what does not
/// depend on `variance_seen` alone.
double log_likelihood(double variance_seen, double degrees, double variance) {
  return -0.5 * degrees * (std::log(variance) + variance_seen / variance);
}

}  // namespace

double gear_variance_m2(const IdentificationProblem& problem, const JointVector& gear_std_rad,
                        const std::vector<std::size_t>& touches) {
  if (gear_std_rad.isZero(0.0) || touches.empty()) return 0.0;
  const PreparedModel nominal = prepare(problem.nominal);
  double sum = 0.0;
  for (const std::size_t index : touches) {
    const Touch& touch = problem.touches[index];
    const Chain chain = forward_chain(nominal, touch.joints);
    const BallContact contact = contact_at(
        problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)], chain.block_from_frame.back());
    const JointVector per_rad =
        point_jacobian(problem.nominal, chain, contact.ball_m).transpose() * contact.normal;
    const double factor = noise_factor(touch, problem.touch_noise_m);
    sum += per_rad.cwiseProduct(gear_std_rad).squaredNorm() / (factor * factor);
  }
  return sum / static_cast<double>(touches.size());
}

std::optional<DroopTest> test_droop(const IdentificationProblem& problem, const LeastSquares& fit,
                                    const FullLinearisation& whole, const ResidualSum& residuals) {
  std::vector<Eigen::Index> left_out;
  std::vector<double> std;
  for (const int position : estimable_compliances(problem.nongeometric_std)) {
    const int column = nongeometric_index(position);
    if (std::ranges::find(fit.arm_columns(), column) != fit.arm_columns().end()) return std::nullopt;
    left_out.push_back(column);
    std.push_back(*problem.nongeometric_std[static_cast<std::size_t>(position)]);
  }
  if (left_out.empty()) return std::nullopt;
  const Eigen::VectorXd scale = Eigen::Map<const Eigen::VectorXd>(std.data(), std::ssize(std));
  const Eigen::MatrixXd shared = whole.touch_information(whole.estimated, left_out) * scale.asDiagonal();
  const Eigen::VectorXd gradient = scale.cwiseProduct(whole.touch_gradient(left_out));
  const Eigen::MatrixXd own =
      scale.asDiagonal() * whole.touch_information(left_out, left_out) * scale.asDiagonal();
  SymmetricEigen beside;
  beside.compute(own - shared.transpose() * whole.estimated_covariance * shared);
  DroopTest test;
  double explained = 0.0;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    const double seen = beside.values()[i];
    if (seen <= kSeenMin * own.trace()) continue;  // this droop looks like what was estimated
    explained += std::pow(beside.vectors().col(i).dot(gradient), 2) / seen;
    test.noncentrality += seen * std::pow(beside.vectors().col(i).sum(), 2);
    test.directions += 1.0;
  }
  test.residual_degrees = residuals.noise_degrees() - test.directions;
  if (test.directions == 0.0 || test.residual_degrees < 1.0) return std::nullopt;
  const double squares = residuals.sum_of_squares - residuals.of_priors() - explained;
  // Residuals that are smaller than the priors alone make them leave the declared noise.
  const double variance = squares > 0.0 ? std::max(squares / test.residual_degrees, kVarianceMin) : 1.0;
  test.f = explained / test.directions / variance;
  test.p = f_survival(test.f, test.directions, test.residual_degrees);
  test.noncentrality = std::min(test.noncentrality / variance, kNoncentralityMax);
  return test;
}

double mean_gear_share(const GearEvidence& evidence) {
  const double of_residuals = evidence.residuals.std_m * evidence.residuals.std_m;
  const double of_repeats = evidence.repeats.std_m * evidence.repeats.std_m;
  const double most = std::max(evidence.residuals.std_m, evidence.repeats.std_m);
  if (!(evidence.gear_variance_m2 > 0.0) || !(most > 0.0)) return 1.0;
  std::array<std::array<double, kNoiseSteps>, kGearScaleSteps> logs{};
  const auto scale_at = [](std::size_t i) {
    return kGearScaleMax * (static_cast<double>(i) + 0.5) / kGearScaleSteps;
  };
  double largest = -std::numeric_limits<double>::infinity();
  const double ratio = std::pow(kNoiseShareMax / kNoiseShareMin, 2.0 / (kNoiseSteps - 1));
  double noise_variance = std::pow(kNoiseShareMin * most, 2);
  for (std::size_t k = 0; k < kNoiseSteps; ++k, noise_variance *= ratio) {
    const double of_noise = log_likelihood(of_repeats, evidence.repeats.degrees_of_freedom, noise_variance);
    for (std::size_t i = 0; i < kGearScaleSteps; ++i) {
      const double share = scale_at(i) * scale_at(i);
      logs[i][k] = of_noise - 0.5 * share +
                   log_likelihood(of_residuals, evidence.residuals.degrees_of_freedom,
                                  noise_variance + share * evidence.gear_variance_m2);
      largest = std::max(largest, logs[i][k]);
    }
  }
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < kGearScaleSteps; ++i) {
    double weight = 0.0;
    for (const double value : logs[i]) weight += std::exp(value - largest);
    sum += weight * scale_at(i) * scale_at(i);
    weights += weight;
  }
  return sum / weights;
}

}  // namespace calib
