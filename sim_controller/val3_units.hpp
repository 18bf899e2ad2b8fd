#pragma once

#include <Eigen/Geometry>

#include "calib_core/geometry/joint_vector.hpp"
#include "sim_controller/val3/program/values.hpp"

/// VAL3 counts in degrees and millimetres, the cell in radians and metres.
namespace sim {

calib::JointVector joints_from_val3(const val3::Joint& joints_deg);
val3::Joint val3_from_joints(const calib::JointVector& joints);

Eigen::Isometry3d pose_from_val3(const val3::Trsf& trsf_mm);
/// Angles from -180 to 180, ry within -90 and 90; at ry = +-90 rx is 0 (manual 6, page 115).
val3::Trsf val3_from_pose(const Eigen::Isometry3d& pose);

}  // namespace sim
