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

/// Bound on the difference between the requested pose and the forward kinematics of a solution: metres,
/// radians.
inline constexpr double kPoseErrorMax = 1e-9;

/// The postures that reach one pose, at most one per branch (shoulder, elbow, wrist). Uses no heap memory.
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

/// Joint vectors that bring R_7 to a pose, for an arm of six revolute joints with a spherical wrist: alpha2
/// and alpha4 to alpha6 are a quarter turn, alpha3 is 0, offsets d2 r2 d3 r3 d4 r4, frames 0, 1 and 7
/// arbitrary. Prismatic joints are not supported. A model with small errors on top of this structure is
/// solved in closed form without the errors, then refined by solve_near. Closed form: Craig, Introduction to
/// Robotics, chapter 4. No member function allocates heap memory.
class InverseKinematics {
 public:
  explicit InverseKinematics(const KinematicModel& model);

  /// All branches, each joint within half a turn of 0; joint limits are not checked. Branches that coincide
  /// (straight wrist or elbow, wrist centre at its smallest distance from the axis of joint 1) are returned
  /// once; with a straight wrist joint 4 is 0. Empty when the pose is out of reach or the arm has another
  /// structure.
  [[nodiscard]] Postures solve(const Eigen::Isometry3d& block_from_tip) const;

  /// The posture on the same branch as `start`, each joint within half a turn of it; nothing when the pose is
  /// out of reach. A model without the exact structure is solved by Newton's method from `start`: see
  /// solve_near.
  [[nodiscard]] std::optional<JointVector> follow(const Eigen::Isometry3d& block_from_tip,
                                                  const JointVector& start) const;

  /// A full turn of each joint axis in joint positions, radians.
  [[nodiscard]] const JointVector& turns() const { return turns_; }

 private:
  enum class Structure { kUnsupported, kNearSphericalWrist, kSphericalWrist };
  struct Branch;       // one sign each for shoulder, elbow and wrist
  struct ArmSolution;  // joints 1 to 3 of one branch

  [[nodiscard]] Eigen::Isometry3d frame1_from_wrist(const Eigen::Isometry3d& block_from_tip) const;
  [[nodiscard]] std::optional<ArmSolution> solve_arm(const Eigen::Vector3d& wrist_m,
                                                     const Branch& branch) const;
  [[nodiscard]] JointVector solve_wrist(const Eigen::Matrix3d& frame1_from_frame6, const ArmSolution& arm,
                                        double wrist_sign, bool& is_straight) const;
  [[nodiscard]] Branch branch_of(const JointVector& joints) const;
  [[nodiscard]] Postures refined(const Postures& rough, const Eigen::Isometry3d& block_from_tip) const;

  PreparedModel prepared_;
  Structure structure_ = Structure::kUnsupported;
  Eigen::Isometry3d frame1_from_block_, tip_from_wrist_;
  double side2_ = 0.0, side4_ = 0.0, side5_ = 0.0, side6_ = 0.0;  // sines of the quarter turns
  double upper_m_ = 0.0, lateral_m_ = 0.0, forearm_m_ = 0.0;
  std::complex<double> forearm_direction_;  // at theta_3 = 0
  JointVector offsets_rad_, turns_;
};

/// All branches with all full turns that are within the joint ranges.
std::vector<JointVector> inverse_kinematics(const KinematicModel& model, const JointRanges& ranges,
                                            const Eigen::Isometry3d& block_from_tip);

/// Newton's method from a near start, for any model: the joint vector that brings R_7 to the pose, or nothing
/// when it does not converge (singular posture, out of reach). Joint limits are not checked.
std::optional<JointVector> solve_near(const KinematicModel& model, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start);

/// d pose / d joint, 6 x 6, in R_-1: the tip's displacement (metres) above the rotation vector (radians), per
/// radian (per metre for a prismatic joint).
Eigen::Matrix<double, 6, kJointCount> pose_jacobian(const KinematicModel& model, const Chain& chain);

}  // namespace calib
