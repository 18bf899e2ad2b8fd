#pragma once

#include <Eigen/Geometry>
#include <array>

#include "calib_core/geometry/joint_vector.hpp"

namespace calib {

/// Frames R_0 to R_7. R_0 is the arm's base in the block's frame R_-1, R_1 to R_6 belong to the joints, the
/// origin of R_7 is the centre of the stylus ball.
inline constexpr int kFrameCount = 8;

/// Constant parameters of one frame (Khalil and Kleinfinger's modified DH, with Hayati's beta).
/// The transform from R_(j-1) to R_j is Rot(y,beta) Rot(x,alpha) Trans(x,d) Rot(z,theta) Trans(z,r).
/// At a joint, theta_rad (r_m for a prismatic joint) is the offset added to gain * joint position (eq. 1).
struct LinkParameters {
  double alpha_rad = 0.0;
  double d_m = 0.0;
  double theta_rad = 0.0;
  double r_m = 0.0;
  double beta_rad = 0.0;
};

struct CosSin {
  double cos = 1.0;
  double sin = 0.0;
};

enum class JointType { kRevolute, kPrismatic };

/// The mass that moves with one frame.
struct PointMass {
  double mass_kg = 0.0;
  Eigen::Vector3d center_in_frame_m = Eigen::Vector3d::Zero();
};

inline constexpr std::array<CosSin, kJointCount> kEvenJoints = [] {
  std::array<CosSin, kJointCount> none{};
  none.fill({0.0, 0.0});
  return none;
}();

struct KinematicModel {
  std::array<LinkParameters, kFrameCount> links{};
  std::array<JointType, kJointCount> joint_types{};                     // of frames 1 to 6
  std::array<double, kJointCount> gains{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};  // K_j of eq. 1
  /// Gravity deflects a revolute joint by compliance * torque; see gravity_torques_nm(). All 0: a rigid arm.
  std::array<PointMass, kFrameCount> masses{};  // the mass of frame 0 does not move
  std::array<double, kJointCount> compliance_rad_per_nm{};
  /// The direction of gravity, a unit vector in R_1 where joint 1 is at 0: along -z for an arm that stands on
  /// the floor, along z for one that hangs from the ceiling, across z on a wall.
  Eigen::Vector3d down_in_frame_1{0.0, 0.0, -1.0};
  /// First harmonic of each joint's transmission: a revolute joint stands cos * cos(gain * position) + sin *
  /// sin(gain * position) too far (radians).
  std::array<CosSin, kJointCount> harmonics_rad = kEvenJoints;
  /// The same twice a turn: of an oval gear. Never estimated; the budget and simulated arms have it.
  std::array<CosSin, kJointCount> second_harmonics_rad = kEvenJoints;
  /// Ripple of each joint's gear: with p periods a turn of the joint a revolute joint stands cos * cos(p *
  /// gain * position) + sin * sin(p * gain * position) too far (radians). No periods: they are not known.
  std::array<double, kJointCount> ripple_periods_per_turn{};
  std::array<CosSin, kJointCount> ripples_rad = kEvenJoints;
};

/// The pose of every frame of the arm in the block's frame R_-1.
struct Chain {
  std::array<Eigen::Isometry3d, kFrameCount> block_from_frame;
  std::array<CosSin, kJointCount> turned;  // of gain * commanded position
  JointVector commanded = JointVector::Zero();

  [[nodiscard]] Eigen::Vector3d tip_in_block_m() const { return block_from_frame.back().translation(); }
};

/// Pose of a frame in the previous frame.
Eigen::Isometry3d frame_transform(const LinkParameters& link);

/// A model with the sines and cosines of its constant angles. Compute it once to evaluate many joint vectors.
struct PreparedModel {
  KinematicModel model;
  std::array<CosSin, kFrameCount> alpha;
  std::array<CosSin, kFrameCount> beta;
  std::array<CosSin, kFrameCount> theta;  // at a joint, of its offset
  Eigen::Vector3d down_in_frame_0;        // the direction of gravity in R_0
  bool has_masses = false;
  bool is_compliant = false;
  bool has_harmonics = false;
  bool has_periods = false;  // of ripple; without them there is none
};

PreparedModel prepare(const KinematicModel& model);

/// All frames at a joint vector. A compliant joint is deflected by the torque that gravity exerts on the
/// undeflected chain, a joint with a harmonic or a ripple by that of its commanded position.
Chain forward_chain(const PreparedModel& prepared, const JointVector& joints);
Chain forward_chain(const KinematicModel& model, const JointVector& joints);

/// A joint vector with the sines and cosines of its joint angles. Compute it once to evaluate many models of
/// one arm.
struct PreparedJoints {
  JointVector joints;
  std::array<CosSin, kJointCount> turned;  // of gain * position; not used for a prismatic joint
};

PreparedJoints prepare(const std::array<double, kJointCount>& gains, const JointVector& joints);

/// Cosine and sine of twice the angle.
CosSin twice_a_turn(const CosSin& turned);

/// Cosine and sine of the phase of each joint's ripple at commanded joints; 0 for a joint without periods and
/// for a prismatic one.
std::array<CosSin, kJointCount> ripple_phases(const KinematicModel& model, const JointVector& joints);

/// As above; `joints` must have been prepared with the gains of the model.
Chain forward_chain(const PreparedModel& prepared, const PreparedJoints& joints);

/// Pose of R_7 in R_-1; its origin is the centre of the stylus ball.
Eigen::Isometry3d forward_kinematics(const KinematicModel& model, const JointVector& joints);

/// Bound on |forward_kinematics - reference| for this size of arm; see tests/data/reference_poses.csv.
inline constexpr double kPositionErrorMaxMetres = 1e-9;

/// d tip / d joint, 3 x 6, in R_-1: metres per radian (per metre for a prismatic joint). The change of the
/// gravity torque is neglected: a relative error of the order of the deflection in radians.
Eigen::Matrix<double, 3, kJointCount> tip_jacobian(const KinematicModel& model, const Chain& chain);
/// The same of another point that is fixed in R_7.
Eigen::Matrix<double, 3, kJointCount> point_jacobian(const KinematicModel& model, const Chain& chain,
                                                     const Eigen::Vector3d& point_in_block_m);

}  // namespace calib
