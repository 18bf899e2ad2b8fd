#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace calib {

/// A round hole through a solid from end to end: all points within radius_m of a line. In R_-1.
struct Hole {
  Eigen::Vector3d center_m;  // on the line
  Eigen::Vector3d axis;      // along it, of unit length
  double radius_m = 0.0;

  /// Vector from the line to a point, perpendicular to it.
  [[nodiscard]] Eigen::Vector3d off_axis_m(const Eigen::Vector3d& point_m) const {
    const Eigen::Vector3d from_center_m = point_m - center_m;
    return from_center_m - axis.dot(from_center_m) * axis;
  }
};

/// A box with edges along the axes of R_-1, and all points within round_m of it: a ball is a point with a
/// round_m. A box without round_m may have holes, where there is no material.
struct Box {
  std::string name;
  Eigen::Vector3d min_m;
  Eigen::Vector3d max_m;
  double round_m = 0.0;
  std::vector<Hole> holes = {};

  /// Whether the point is inside or at most `margin_m` outside, axis by axis; without round_m and holes.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point_m, double margin_m = 0.0) const {
    return (point_m.array() >= min_m.array() - margin_m).all() &&
           (point_m.array() <= max_m.array() + margin_m).all();
  }
};

}  // namespace calib
