#pragma once

#include <Eigen/Geometry>
#include <array>

#include "calib_core/kinematics/kinematic_model.hpp"

namespace cell {

/// The axis of a joint, where all joints are at 0.
struct JointAxis {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction =
      Eigen::Vector3d::UnitZ();  // unit vector; joints turn about it by the right hand
};

/// The links of six revolute axes in a base and of a tip (with all joints at 0): R_-1 is the base, R_7 the
/// tip. Between axes that are more than kParallelRadians from parallel runs their common normal, and beta is
/// 0; between others the parameters are Hayati's, whose r is 0 on the first one, so that no length becomes
/// large where two axes are parallel but for the rounding of a file. Exact but for rounding.
calib::KinematicModel model_of_axes(const std::array<JointAxis, calib::kJointCount>& axes,
                                    const Eigen::Isometry3d& base_from_tip);

inline constexpr double kParallelRadians = 0.1;

}  // namespace cell
