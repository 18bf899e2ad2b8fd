#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "calib_core/joint_vector.hpp"
#include "calib_core/kinematic_model.hpp"

namespace calib {

/// Joint vectors that bring R_7 to a pose, for a six-joint arm with a spherical wrist; closed form on the
/// nominal model. Empty when the pose is out of reach. Every branch (shoulder, elbow, wrist), each with the whole
/// turns that fit into the joint ranges.
std::vector<JointVector> inverse_kinematics(const KinematicModel& model, const JointRanges& ranges,
                                            const Eigen::Isometry3d& block_from_tip);

/// Newton from a near start, for any model: the joint vector that brings R_7 to the pose, or nothing when it does
/// not converge. Used along straight lines, where the previous posture is the start. Ranges are not checked.
std::optional<JointVector> solve_near(const KinematicModel& model, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start);

}  // namespace calib
