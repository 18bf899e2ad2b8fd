#pragma once

#include <Eigen/Geometry>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// The pose of the block relative to the arm, from six touches made by hand.
namespace calib {

/// Sets the pose of the arm in R_-1 with the parameters of frames 0 and 1: Rot(z,theta0) Trans(z,r0)
/// Rot(x,alpha1) Trans(x,d1) Rot(z,theta1) Trans(z,r1) is a general pose. The signs of sin(alpha1) and d1 are
/// kept; beta1 becomes 0.
void set_block_pose(KinematicModel& model, const Eigen::Isometry3d& block_from_frame1);

/// The pose that set_block_pose() sets: R_1 in R_-1 with joint 1 at 0.
Eigen::Isometry3d block_pose_of(const KinematicModel& model);

/// A touch that a person made by hand.
struct RegistrationTouch {
  int face = 0;  // index of the face
  JointVector joints = JointVector::Zero();
  double std_m = 0.0;  // of the ball along the normal of the face: trigger, and motion of the arm since
};

struct BlockRegistrationProblem {
  KinematicModel nominal;   // with the last known pose of the block
  std::vector<Face> faces;  // in R_-1
  Stylus stylus;
  std::vector<RegistrationTouch> touches;
  double tilt_max_rad = 0.0;  // stylus axis to inward normal
  /// Standard deviations of the errors of arm and tool, which these touches cannot separate from the pose of
  /// the block; those of the pose are ignored.
  ErrorTolerances arm_errors{};
};

struct BlockRegistration {
  /// Pose of the current R_-1 in the last known R_-1.
  Eigen::Isometry3d old_from_new;
  KinematicModel model;  // nominal with the new frames 0 and 1
  /// Covariance of the block's translation (metres) above its rotation vector (radians), in R_-1.
  Eigen::Matrix<double, 6, 6> covariance;
  /// Standard deviations of the six errors of the block pose from `covariance`; nothing elsewhere.
  ErrorTolerances std_block_pose{};
  double residual_rms_m = 0.0;  // 0 for six touches: there are six unknowns
};

/// Why the touches do not determine the pose of the block: one sentence with the remedy.
struct BlockRegistrationRefusal {
  std::string message;
};

/// A rotation larger than this (20 degrees) cannot be distinguished from touches on the wrong faces.
inline constexpr double kBlockTurnMaxRadians = 0.35;
/// Touches of one face that are closer to each other, or to one line, do not determine its tilt.
inline constexpr double kRegistrationSpreadMinMetres = 0.02;
/// A stylus may be inclined by this much more than tilt_max_rad.
inline constexpr double kTiltMarginRadians = 0.1;
/// A touch may lie this far outside the rectangle of its face: ball radius and errors of the arm.
inline constexpr double kOffFaceMaxMetres = 0.02;

/// Gauss-Newton for the rigid motion of the block, weighted by the standard deviation of each touch. It needs
/// three faces with independent normals: three touches (not on a line) on one and two on another. Refused:
/// touches too close to each other, mixed-up faces, a ball inside the block or beside its face, a rotation
/// over kBlockTurnMaxRadians. The covariance includes the errors of the arm to first order.
std::variant<BlockRegistration, BlockRegistrationRefusal> register_block(
    const BlockRegistrationProblem& problem);

}  // namespace calib
