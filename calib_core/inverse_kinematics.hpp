#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "calib_core/joint_vector.hpp"
#include "calib_core/kinematic_model.hpp"

namespace calib {

/// What is left between the pose asked for and the forward kinematics of a solution: metres, radians.
inline constexpr double kPoseErrorMax = 1e-9;

/// Joint vectors that bring R_7 to a pose, for six revolute joints that end in a spherical wrist: alpha2 and
/// alpha4 to alpha6 a quarter turn, alpha3 zero, offsets d2 r2 d3 r3 d4 r4, any frames 0, 1 and 7. Every
/// branch (shoulder, elbow, wrist), each with the whole turns that fit into the joint ranges. With the wrist
/// straight joint 4 is put at its offset. A model that is off this structure by small errors is solved in
/// closed form without them and polished by solve_near. Empty when the pose is out of reach or the arm is
/// another one. Closed form: Craig, Introduction to Robotics, chapter 4.
std::vector<JointVector> inverse_kinematics(const KinematicModel& model, const JointRanges& ranges,
                                            const Eigen::Isometry3d& block_from_tip);

/// Newton from a near start, for any model: the joint vector that brings R_7 to the pose, or nothing when it
/// does not converge, as at a singular posture or out of reach. Used along straight lines, where the previous
/// posture is the start. Ranges are not checked.
std::optional<JointVector> solve_near(const KinematicModel& model, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start);

/// d pose / d joint, 6 x 6, in R_-1: the tip's displacement (metres) above the rotation vector (radians), per
/// radian (per metre for a prismatic joint).
Eigen::Matrix<double, 6, kJointCount> pose_jacobian(const KinematicModel& model, const Chain& chain);

}  // namespace calib
