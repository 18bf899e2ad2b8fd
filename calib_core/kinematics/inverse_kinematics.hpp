#pragma once

#include <Eigen/Geometry>
#include <complex>
#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/kinematics/numerical_inverse.hpp"

namespace calib {

/// Joint vectors that bring R_7 to a pose, for any arm of six revolute joints.
///
/// With a spherical wrist in closed form: alpha2 and alpha4 to alpha6 are a quarter turn, alpha3 is 0,
/// offsets d2 r2 d3 r3 d4 r4, frames 0, 1 and 7 arbitrary (Craig, Introduction to Robotics, chapter 4). A
/// model with small errors on top of this structure is solved without the errors, then refined by
/// solve_near. Any other structure, such as three parallel axes or a wrist with offsets, is solved by
/// NumericalInverse. Prismatic joints are not supported. No member function but the constructor allocates
/// heap memory.
class InverseKinematics {
 public:
  explicit InverseKinematics(const KinematicModel& model);

  /// All branches, each joint within half a turn of 0; joint limits are not checked. Branches that coincide
  /// (straight wrist or elbow, wrist centre at its smallest distance from the axis of joint 1) are returned
  /// once; with a straight wrist joint 4 is 0. Empty when the pose is out of reach or a joint is prismatic.
  [[nodiscard]] Postures solve(const Eigen::Isometry3d& block_from_tip) const;

  /// The posture on the same branch as `start`, each joint within half a turn of it; nothing when the pose is
  /// out of reach. A model without the exact structure is solved by Newton's method from `start`: see
  /// solve_near.
  [[nodiscard]] std::optional<JointVector> follow(const Eigen::Isometry3d& block_from_tip,
                                                  const JointVector& start) const;

  /// A full turn of each joint axis in joint positions, radians.
  [[nodiscard]] const JointVector& turns() const { return turns_; }

 private:
  enum class Structure { kWithPrismaticJoint, kGeneral, kNearSphericalWrist, kSphericalWrist };
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
  Structure structure_ = Structure::kWithPrismaticJoint;
  std::optional<NumericalInverse> numerical_;  // of the general structure
  Eigen::Isometry3d frame1_from_block_, tip_from_wrist_;
  double side2_ = 0.0, side4_ = 0.0, side5_ = 0.0, side6_ = 0.0;  // sines of the quarter turns
  double upper_m_ = 0.0, lateral_m_ = 0.0, forearm_m_ = 0.0;
  std::complex<double> forearm_direction_;  // at theta_3 = 0
  JointVector offsets_rad_, turns_;
};

/// All branches with all full turns that are within the joint ranges.
std::vector<JointVector> inverse_kinematics(const KinematicModel& model, const JointRanges& ranges,
                                            const Eigen::Isometry3d& block_from_tip);

}  // namespace calib
