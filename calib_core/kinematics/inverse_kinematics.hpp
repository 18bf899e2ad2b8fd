#pragma once

#include <Eigen/Geometry>
#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// What is left between the pose asked for and the forward kinematics of a solution: metres, radians.
inline constexpr double kPoseErrorMax = 1e-9;

/// The postures of one pose: one a branch (shoulder, elbow, wrist), on the stack.
class Postures {
 public:
  static constexpr std::size_t kMax = 8;

  void push_back(const JointVector& joints) { joints_[size_++] = joints; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const JointVector& operator[](std::size_t index) const { return joints_[index]; }
  [[nodiscard]] const JointVector* begin() const { return joints_.data(); }
  [[nodiscard]] const JointVector* end() const { return joints_.data() + size_; }

 private:
  std::array<JointVector, kMax> joints_;
  std::size_t size_ = 0;
};

/// Joint vectors that bring R_7 to a pose, for six revolute joints that end in a spherical wrist: alpha2 and
/// alpha4 to alpha6 a quarter turn, alpha3 zero, offsets d2 r2 d3 r3 d4 r4, any frames 0, 1 and 7. A model
/// that is off this structure by small errors is solved in closed form without them and polished by
/// solve_near. Closed form: Craig, Introduction to Robotics, chapter 4. Holds what no pose changes; takes no
/// memory from the heap after it is made.
class InverseKinematics {
 public:
  explicit InverseKinematics(const KinematicModel& model);

  /// Every branch, each joint within half a turn of 0; ranges are not looked at. Branches that meet (wrist or
  /// elbow straight, the wrist's centre as near to joint 1's axis as it can be) come once; with the wrist
  /// straight joint 4 is put at 0. Empty when the pose is out of reach or the arm is of another kind.
  [[nodiscard]] Postures solve(const Eigen::Isometry3d& block_from_tip) const;

  /// The posture of the same branch as `start` and within half a turn of it, joint by joint; nothing out of
  /// reach. For a model that is off the structure, Newton from `start`: see solve_near.
  [[nodiscard]] std::optional<JointVector> follow(const Eigen::Isometry3d& block_from_tip,
                                                  const JointVector& start) const;

  /// What a whole turn of each joint's axis is in joint positions, radians.
  [[nodiscard]] const JointVector& turns() const { return turns_; }

 private:
  enum class Kind { kAnother, kNearlyThis, kThis };
  struct Signs;  // +1 or -1 each: which branch
  struct Arm;    // joints 1 to 3 of one

  [[nodiscard]] Eigen::Isometry3d frame1_from_wrist(const Eigen::Isometry3d& block_from_tip) const;
  [[nodiscard]] std::optional<Arm> place_wrist(const Eigen::Vector3d& wrist_m, const Signs& signs) const;
  [[nodiscard]] JointVector turn_wrist(const Eigen::Matrix3d& turned, const Arm& arm, double wrist,
                                       bool& is_straight) const;
  [[nodiscard]] Signs signs_of(const JointVector& joints) const;
  [[nodiscard]] Postures polished(const Postures& rough, const Eigen::Isometry3d& block_from_tip) const;

  PreparedModel prepared_;
  Kind kind_ = Kind::kAnother;
  Eigen::Isometry3d frame1_from_block_, tip_from_wrist_;
  double side2_ = 0.0, side4_ = 0.0, side5_ = 0.0, side6_ = 0.0;  // sines of the quarter turns
  double upper_m_ = 0.0, lateral_m_ = 0.0, forearm_m_ = 0.0;
  std::complex<double> forearm_direction_;  // at theta_3 = 0
  JointVector offsets_rad_, turns_;
};

/// The same with the whole turns that fit into the joint ranges, in a list.
std::vector<JointVector> inverse_kinematics(const KinematicModel& model, const JointRanges& ranges,
                                            const Eigen::Isometry3d& block_from_tip);

/// Newton from a near start, for any model: the joint vector that brings R_7 to the pose, or nothing when it
/// does not converge, as at a singular posture or out of reach. Ranges are not checked.
std::optional<JointVector> solve_near(const KinematicModel& model, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start);

/// d pose / d joint, 6 x 6, in R_-1: the tip's displacement (metres) above the rotation vector (radians), per
/// radian (per metre for a prismatic joint).
Eigen::Matrix<double, 6, kJointCount> pose_jacobian(const KinematicModel& model, const Chain& chain);

}  // namespace calib
