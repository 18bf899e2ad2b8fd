#pragma once

#include <Eigen/Geometry>

#include "service/offline_programs/number_places.hpp"

/// A VAL3 trsf {x, y, z, rx, ry, rz}: turned about x, then the new y, then the new z, R = Rx Ry Rz; degrees,
/// lengths in the application's unit (manual 6, pages 114 and 115).
namespace cell {

/// In metres; `mm_per_unit` is 1, or 25.4 where the application counts in inches.
Eigen::Isometry3d pose_of_trsf(const SixNumbers& trsf, double mm_per_unit);

/// The writing of the pose that is nearest to `near`: of the two sets of angles, whole turns added, the one
/// with the smallest changes, so that what stays as it was keeps its numbers. At ry = +-90 deg, where rx and
/// rz turn about one axis, rx stays as it is.
SixNumbers trsf_of_pose(const Eigen::Isometry3d& pose, const SixNumbers& near, double mm_per_unit);

/// cos(ry) below which rx and rz are taken as turns about one axis: what is lost by that and what is lost in
/// dividing by it are both 1e-8 rad there.
inline constexpr double kOneAxisCosine = 1e-8;

}  // namespace cell
