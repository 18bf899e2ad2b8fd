#pragma once

#include <Eigen/Geometry>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// Where the block stands: six touches, made by hand, and the arm as it is known.
namespace calib {

/// Puts the arm at a pose in R_-1 through the parameters of frames 0 and 1: Rot(z,theta0) Trans(z,r0)
/// Rot(x,alpha1) Trans(x,d1) Rot(z,theta1) Trans(z,r1) is any pose. Signs stay as they were; beta1 becomes 0.
void set_place(KinematicModel& model, const Eigen::Isometry3d& block_from_frame1);

/// The pose that set_place() sets: R_1 with joint 1 at 0, in R_-1.
Eigen::Isometry3d place_of(const KinematicModel& model);

/// The ball of a stylus that a person brought to a face.
struct PlaceTouch {
  int face = 0;  // index into the faces
  JointVector joints = JointVector::Zero();
  double std_m = 0.0;  // of the ball along the face's normal: the trigger, and what the arm moved since
};

struct BlockPlaceProblem {
  KinematicModel nominal;   // with the block where it was last known to stand
  std::vector<Face> faces;  // in R_-1
  Stylus stylus;
  std::vector<PlaceTouch> touches;
  double tilt_max_rad = 0.0;  // stylus axis to inward normal
  /// One standard deviation of each error of arm and tool, which the touches do not tell from the place;
  /// those of the place are not looked at.
  ErrorTolerances arm_errors{};
};

struct BlockPlaceFit {
  /// R_-1 as it stands now, in R_-1 as it was believed to stand.
  Eigen::Isometry3d old_from_new;
  KinematicModel model;  // nominal with frames 0 and 1 as they are now
  /// Of the block's shift (metres) above its turn (rotation vector, radians), in R_-1.
  Eigen::Matrix<double, 6, 6> covariance;
  /// One standard deviation of the six errors of the place, by covariance; nothing elsewhere.
  ErrorTolerances std_place{};
  double residual_rms_m = 0.0;  // 0 for six touches, which six numbers always fit
};

/// Why touches do not tell where the block stands: one sentence with the remedy.
struct BlockPlaceRefusal {
  std::string message;
};

/// A block that stands turned by more than this (20 degrees) is not told from one whose faces were mixed up.
inline constexpr double kBlockTurnMaxRadians = 0.35;
/// Touches of one face that are nearer to each other, or to one line, tell too little of its tilt.
inline constexpr double kPlaceSpreadMinMetres = 0.02;
/// A touch may lean by so much more than the limit.
inline constexpr double kTiltMarginRadians = 0.1;
/// A touch may lie so far outside the rectangle of its face; the ball's radius and the arm's errors are in
/// it.
inline constexpr double kOffFaceMaxMetres = 0.02;

/// Gauss-Newton over the six numbers of a rigid move, weighted by each touch's deviation. Three faces with
/// independent normals are needed, three touches (not on a line) on one of them and two on another. Refused:
/// touches too near to each other, faces mixed up, a ball that touches from the inside or beside its face, a
/// turn over kBlockTurnMaxRadians. The covariance takes the arm's own errors as they are linearised there.
std::variant<BlockPlaceFit, BlockPlaceRefusal> fit_block_place(const BlockPlaceProblem& problem);

}  // namespace calib
