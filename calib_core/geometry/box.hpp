#pragma once

#include <Eigen/Core>
#include <string>

namespace calib {

/// A box with edges along the axes of R_-1, and all points within round_m of it: a ball is a point with a
/// round_m.
struct Box {
  std::string name;
  Eigen::Vector3d min_m;
  Eigen::Vector3d max_m;
  double round_m = 0.0;

  /// Whether the point is inside or at most `margin_m` outside, axis by axis; without round_m.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point_m, double margin_m = 0.0) const {
    return (point_m.array() >= min_m.array() - margin_m).all() &&
           (point_m.array() <= max_m.array() + margin_m).all();
  }
};

}  // namespace calib
