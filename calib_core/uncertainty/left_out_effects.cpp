#include "calib_core/uncertainty/left_out_effects.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "calib_core/kinematics/inverse_kinematics.hpp"

namespace calib {
namespace {

constexpr int kScaleSteps = 32;

/// Directions with a smaller share of the largest information say nothing.
constexpr double kInformationShareMin = 1e-12;

}  // namespace

double mean_variance_share(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                           double noise_variance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(information);
  const Eigen::VectorXd& gains = directions.eigenvalues();
  const double least = kInformationShareMin * gains.cwiseAbs().maxCoeff();
  const Eigen::VectorXd along = directions.eigenvectors().transpose() * score;
  std::array<double, kScaleSteps> log_likelihoods{};
  const auto scale_at = [](std::size_t step) { return (static_cast<double>(step) + 0.5) / kScaleSteps; };
  for (std::size_t step = 0; step < log_likelihoods.size(); ++step) {
    for (Eigen::Index k = 0; k < gains.size(); ++k) {
      if (gains[k] <= least) continue;
      const double variance = noise_variance + std::pow(scale_at(step), 2) * gains[k];
      log_likelihoods[step] -= 0.5 * (std::log(variance) + along[k] * along[k] / (gains[k] * variance));
    }
  }
  const double most = *std::ranges::max_element(log_likelihoods);
  double sum = 0.0, weights = 0.0;
  for (std::size_t step = 0; step < log_likelihoods.size(); ++step) {
    const double weight = (1.0 - scale_at(step)) * std::exp(log_likelihoods[step] - most);
    sum += weight * std::pow(scale_at(step), 2);
    weights += weight;
  }
  return sum / weights;
}

JointVector search_directions(const KinematicModel& model, const Chain& chain,
                              const Eigen::Vector3d& outward) {
  Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
  motion.head<3>() = -outward;
  const JointVector speeds = pose_jacobian(model, chain).partialPivLu().solve(motion);
  return speeds.unaryExpr(
      [](double speed) { return std::isfinite(speed) && speed != 0.0 ? std::copysign(1.0, speed) : 0.0; });
}

}  // namespace calib
