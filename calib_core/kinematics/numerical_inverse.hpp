#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// Bound on the difference between the requested pose and the forward kinematics of a solution: metres,
/// radians.
inline constexpr double kPoseErrorMax = 1e-9;

/// The postures that reach one pose: six revolute joints have at most sixteen. Uses no heap memory.
class Postures {
 public:
  static constexpr std::size_t kMax = 16;

  void push_back(const JointVector& joints) { joints_[size_++] = joints; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == kMax; }
  [[nodiscard]] const JointVector& operator[](std::size_t index) const { return joints_[index]; }
  [[nodiscard]] const JointVector* begin() const { return joints_.data(); }
  [[nodiscard]] const JointVector* end() const { return joints_.data() + size_; }

 private:
  std::array<JointVector, kMax> joints_;
  std::size_t size_ = 0;
};

/// Newton's method from a near start, for any model: the joint vector that brings R_7 to the pose, or nothing
/// when it does not converge (singular posture, out of reach). Joint limits are not checked.
std::optional<JointVector> solve_near(const KinematicModel& model, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start);
std::optional<JointVector> solve_near(const PreparedModel& prepared, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start);

/// d pose / d joint, 6 x 6, in R_-1: the tip's displacement (metres) above the rotation vector (radians), per
/// radian (per metre for a prismatic joint).
Eigen::Matrix<double, 6, kJointCount> pose_jacobian(const KinematicModel& model, const Chain& chain);

/// The postures of any arm of six revolute joints, whatever its wrist: Newton's method from a table of
/// starts.
///
/// The axis of joint 6 is a line that joints 2 to 5 place, but for a turn about the axis of joint 1. The
/// table holds this line for 4096 Halton postures of joints 2 to 5; the starts are the entries that come
/// nearest to the wanted line, and joints 1 and 6 follow from the pose. About 0.4 ms a pose, reached or not;
/// at most 0.3 % of an arm's regular postures are missed (numerical_inverse_test). The constructor takes heap
/// memory and 2 ms, solve() takes none.
class NumericalInverse {
 public:
  /// All joints of the model must be revolute (std::logic_error).
  explicit NumericalInverse(const KinematicModel& model);

  /// Each joint within half a turn of 0; joint limits are not checked. Postures that differ by less than 0.01
  /// rad in every joint are returned once; of a singular pose with infinitely many postures there are some.
  /// Deterministic. Empty when the pose is out of reach.
  [[nodiscard]] Postures solve(const Eigen::Isometry3d& block_from_tip) const;

 private:
  /// Place and direction of the axis of joint 6 in cylinder coordinates about the axis of joint 1; padded to
  /// whole SIMD registers.
  using AxisKey = Eigen::Array<float, 8, 1>;

  [[nodiscard]] AxisKey axis_key(const Eigen::Isometry3d& frame1_from_frame6) const;
  [[nodiscard]] JointVector start_from(const JointVector& entry,
                                       const Eigen::Isometry3d& frame1_from_frame6) const;
  [[nodiscard]] std::optional<JointVector> converge(const Eigen::Isometry3d& block_from_tip,
                                                    JointVector joints, const Postures& known) const;
  [[nodiscard]] bool is_known(const JointVector& joints, const Postures& known) const;
  [[nodiscard]] JointVector angles_between(const JointVector& a, const JointVector& b) const;

  PreparedModel prepared_;
  JointVector gains_;
  Eigen::Isometry3d frame1_from_block_, tip_from_frame6_;
  double direction_weight_m_ = 0.0;  // metres that a radian of the axis' direction counts as
  std::vector<JointVector> entries_;
  std::vector<AxisKey> keys_;  // one per entry
};

}  // namespace calib
