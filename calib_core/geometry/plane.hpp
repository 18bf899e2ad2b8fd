#pragma once

#include <Eigen/Core>

namespace calib {

/// A plane in R_-1: outward . X = offset_m, `outward` of unit length and pointing out of the material.
struct Plane {
  Eigen::Vector3d outward;
  double offset_m = 0.0;
};

/// Metres from the plane, positive outside the material.
inline double signed_distance_m(const Plane& plane, const Eigen::Vector3d& point_m) {
  return plane.outward.dot(point_m) - plane.offset_m;
}

}  // namespace calib
