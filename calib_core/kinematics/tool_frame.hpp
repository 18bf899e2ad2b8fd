#pragma once

#include <Eigen/Geometry>

#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// Puts a tool on the arm in place of its stylus: R_7 is then the tool's frame, its pose in R_6 as given. The
/// five parameters of frame 7 hold every pose but for a turn about the axis of joint 6, which goes into the
/// offset of theta6: R_6 is turned by it, and the frames of the arm before stay as they are.
void mount_tool(KinematicModel& model, const Eigen::Isometry3d& frame6_from_tool);

}  // namespace calib
