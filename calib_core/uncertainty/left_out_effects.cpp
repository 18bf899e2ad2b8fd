#include "calib_core/uncertainty/left_out_effects.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "calib_core/kinematics/inverse_kinematics.hpp"

namespace calib {
namespace {

/// Of the variance that was thought to be the noise's: less is rounding.
constexpr double kLeastVarianceShare = 1e-3;

constexpr int kScaleSteps = 48;
/// The maker's figure may be too small: what the touches show counts.
constexpr double kScaleMax = 4.0;

/// Directions with a smaller share of the largest information say nothing.
constexpr double kInformationShareMin = 1e-12;

/// The evidence along one direction of the group that the touches see.
struct Direction {
  double gain = 0.0;       // information
  double explained = 0.0;  // of chi-square
};

std::vector<Direction> seen_directions(const GroupEvidence& group) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(group.information);
  const Eigen::VectorXd& gains = solver.eigenvalues();
  const double least = kInformationShareMin * gains.cwiseAbs().maxCoeff();
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * group.score;
  std::vector<Direction> seen;
  for (Eigen::Index k = 0; k < gains.size(); ++k) {
    if (gains[k] > least) seen.push_back({gains[k], along[k] * along[k] / gains[k]});
  }
  return seen;
}

double noise_variance_beside(const std::vector<Direction>& seen, const NoiseEvidence& noise) {
  const double left = noise.degrees - static_cast<double>(seen.size());
  if (left < kNoiseDegreesBesideMin) return noise.otherwise;
  double squares = noise.squares;
  for (const Direction& direction : seen) squares -= direction.explained;
  return std::max(squares / left, kLeastVarianceShare * noise.otherwise);
}

}  // namespace

GroupEvidence evidence_of_group(const Eigen::MatrixXd& own, const Eigen::MatrixXd& shared,
                                const Eigen::VectorXd& gradient, const Eigen::VectorXd& std,
                                const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd scaled = shared * std.asDiagonal();
  GroupEvidence group{std.asDiagonal() * own * std.asDiagonal(), std.cwiseProduct(gradient)};
  group.information.noalias() -= scaled.transpose() * covariance * scaled;
  return group;
}

double mean_variance_share(const GroupEvidence& group, const NoiseEvidence& noise, double expected_share) {
  const double decay = std::sqrt(2.0 / expected_share);  // of the density: its mean square is 2 / decay^2
  const std::vector<Direction> seen = seen_directions(group);
  const double noise_variance = noise_variance_beside(seen, noise);
  std::array<double, kScaleSteps> log_likelihoods{};
  // Dense where they are small: the step of the scale grows with it.
  const auto root_at = [](std::size_t step) { return (static_cast<double>(step) + 0.5) / kScaleSteps; };
  const auto scale_at = [&](std::size_t step) { return kScaleMax * root_at(step) * root_at(step); };
  for (std::size_t step = 0; step < log_likelihoods.size(); ++step) {
    for (const Direction& direction : seen) {
      const double variance = noise_variance + std::pow(scale_at(step), 2) * direction.gain;
      log_likelihoods[step] -= 0.5 * (std::log(variance) + direction.explained / variance);
    }
  }
  const double most = *std::ranges::max_element(log_likelihoods);
  double sum = 0.0, weights = 0.0;
  for (std::size_t step = 0; step < log_likelihoods.size(); ++step) {
    const double weight = root_at(step) * std::exp(log_likelihoods[step] - most - decay * scale_at(step));
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
