#include "calib_core/estimation/gear_choice.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <numbers>

namespace calib {
namespace {

constexpr double kTurnRad = 2.0 * std::numbers::pi;

/// Where one joint stands at the touches: gain * position.
Eigen::ArrayXd angles_of(const IdentificationProblem& problem, const std::vector<std::size_t>& fitted,
                         int joint) {
  Eigen::ArrayXd angles(std::ssize(fitted));
  for (std::size_t i = 0; i < fitted.size(); ++i)
    angles[static_cast<Eigen::Index>(i)] = problem.touches[fitted[i]].joints[joint];
  return problem.nominal.gains[static_cast<std::size_t>(joint)] * angles;
}

/// The width of an even spread with the standard deviation of these angles.
double turn_of(const Eigen::ArrayXd& angles) {
  return std::sqrt(12.0 * (angles - angles.mean()).square().mean());
}

/// kRippleShareMin says of what.
double ripple_share(const Eigen::ArrayXd& angles, double periods) {
  Eigen::MatrixX3d smooth(angles.size(), 3);
  smooth << Eigen::ArrayXd::Ones(angles.size()), angles.cos(), angles.sin();
  Eigen::MatrixX2d ripple(angles.size(), 2);
  ripple << (periods * angles).cos(), (periods * angles).sin();
  const Eigen::MatrixX2d left = ripple - smooth * smooth.colPivHouseholderQr().solve(ripple);
  const Eigen::Matrix2d square = left.transpose() * left;
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(square).eigenvalues()[0];
  return least / (0.5 * static_cast<double>(angles.size()));
}

void add_held(int joint, double turn_rad, GearColumns& columns) {
  columns.held += (columns.held.empty() ? "joint " : ", joint ") + std::to_string(joint + 1) + " (" +
                  std::to_string(std::lround(degrees_from_radians(turn_rad))) + " degrees)";
}

bool has_deviation(const IdentificationProblem& problem, int position) {
  return problem.nongeometric_std[static_cast<std::size_t>(position)].has_value();
}

}  // namespace

GearColumns shown_harmonics(const IdentificationProblem& problem, const std::vector<std::size_t>& fitted) {
  GearColumns columns;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const int cosine = harmonic_position(joint);
    if (!has_deviation(problem, cosine)) continue;
    const double turn_rad = turn_of(angles_of(problem, fitted, joint));
    if (turn_rad < kHarmonicTurnMin) {
      add_held(joint, turn_rad, columns);
    } else {
      columns.positions.insert(columns.positions.end(), {cosine, cosine + 1});
    }
  }
  return columns;
}

GearColumns shown_ripples(const IdentificationProblem& problem, const std::vector<std::size_t>& fitted) {
  GearColumns columns;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const int cosine = ripple_position(joint);
    const double periods = problem.nominal.ripple_periods_per_turn[static_cast<std::size_t>(joint)];
    if (!has_deviation(problem, cosine) || periods == 0.0) continue;
    const Eigen::ArrayXd angles = angles_of(problem, fitted, joint);
    const double turn_rad = turn_of(angles);
    if (periods * turn_rad < kTurnRad || ripple_share(angles, periods) < kRippleShareMin) {
      add_held(joint, turn_rad, columns);
    } else {
      columns.positions.insert(columns.positions.end(), {cosine, cosine + 1});
    }
  }
  return columns;
}

}  // namespace calib
