#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace calib {

/// The shortest rotation that takes the direction of `from` to that of `to`; of opposite directions, a half
/// turn about some perpendicular axis. Neither may be zero. Eigen's FromTwoVectors does the same by a
/// singular value decomposition, which takes the compiler ten seconds a file.
inline Eigen::Quaterniond shortest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kSineParallel = 1e-12;
  const Eigen::Vector3d across = from.normalized().cross(to.normalized());
  const double sine = across.norm();
  const double angle = std::atan2(sine, from.normalized().dot(to.normalized()));
  const Eigen::Vector3d axis = sine > kSineParallel ? (across / sine).eval() : from.unitOrthogonal();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

}  // namespace calib
