#include "calib_core/compensation/arm_sides.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace calib {
namespace {

/// A shorter link has no direction.
constexpr double kLinkMinMetres = 1e-6;

double margin_of(double angle_rad) {
  const double size_rad = std::abs(angle_rad);
  return std::min(size_rad, std::numbers::pi - size_rad);
}

/// From one direction to another about an axis; neither has to be a unit vector.
double angle_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

Eigen::Vector3d across(const Eigen::Vector3d& axis, const Eigen::Vector3d& vector) {
  return vector - axis.dot(vector) * axis;
}

double elbow_angle(const Chain& chain) {
  const Eigen::Vector3d axis = chain.block_from_frame[3].linear().col(2);
  const Eigen::Vector3d elbow_m = chain.block_from_frame[3].translation();
  const Eigen::Vector3d upper_m = across(axis, elbow_m - chain.block_from_frame[2].translation());
  const Eigen::Vector3d forearm_m = across(axis, chain.block_from_frame[4].translation() - elbow_m);
  if (std::min(upper_m.norm(), forearm_m.norm()) < kLinkMinMetres) return std::numbers::pi / 2.0;
  return angle_about(axis, upper_m, forearm_m);
}

}  // namespace

double ArmBend::elbow_margin_rad() const { return margin_of(elbow_rad); }
double ArmBend::wrist_margin_rad() const { return margin_of(wrist_rad); }

ArmBend arm_bend(const Chain& chain) {
  const auto axis = [&chain](std::size_t frame) -> Eigen::Vector3d {
    return chain.block_from_frame[frame].linear().col(2);
  };
  const Eigen::Vector3d ahead =
      chain.block_from_frame[1].linear().col(0);  // across the axes of joints 1 and 2
  const Eigen::Vector3d reach_m =
      chain.block_from_frame[4].translation() - chain.block_from_frame[1].translation();
  ArmBend bend{.elbow_rad = elbow_angle(chain), .wrist_rad = angle_about(axis(5), axis(4), axis(6))};
  bend.sides = {.ahead = ahead.dot(reach_m) >= 0.0,
                .elbow_positive = bend.elbow_rad >= 0.0,
                .wrist_positive = bend.wrist_rad >= 0.0};
  return bend;
}

}  // namespace calib
