#pragma once

#include <Eigen/Geometry>

#include "sim_controller/val3/program/values.hpp"

namespace val3 {

inline constexpr double kRadiansPerDegree = 0.017453292519943295;

/// Lengths in the trsf's own unit.
Eigen::Isometry3d isometry(const Trsf& trsf);
/// Angles as manual 6, page 115 has them: two of three within -90..90, rx 0 where ry is 90 or -90.
Trsf trsf_of(const Eigen::Isometry3d& isometry);
Trsf composed(const Trsf& first, const Trsf& second);
Trsf inverse(const Trsf& trsf);
/// With lengths in another unit.
Trsf scaled(const Trsf& trsf, double factor);
/// Of two translations.
double distance(const Trsf& a, const Trsf& b);

}  // namespace val3
