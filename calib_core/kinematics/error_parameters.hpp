#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// The candidates of the identification (section II of the paper): alpha d theta r beta of frames 1 to 7,
/// theta and r of frame 0.
inline constexpr int kErrorParameterCount = 37;

enum class ParameterKind { kAlpha, kD, kTheta, kR, kBeta };

/// What an error belongs to: the place of the block (all that comes before joint 1's motion), the arm, the
/// tool.
enum class ParameterGroup { kPlace, kArm, kTool };

struct ErrorParameter {
  int frame = 0;
  ParameterKind kind = ParameterKind::kAlpha;

  [[nodiscard]] bool is_length() const { return kind == ParameterKind::kD || kind == ParameterKind::kR; }
  [[nodiscard]] ParameterGroup group() const;
  [[nodiscard]] std::string name() const;  // "alpha1", "r0"
};

/// One value a candidate, in the order of error_parameters(): metres and radians.
using ErrorVector = Eigen::Matrix<double, kErrorParameterCount, 1>;

/// One standard deviation of each error as the maker promises it, metres and radians; nothing where nobody
/// promises anything.
using ErrorTolerances = std::array<std::optional<double>, kErrorParameterCount>;

/// How far from the block's middle the touches lie, about: what a turn of the block's place moves by as much
/// as it is displaced.
inline constexpr double kPlaceLeverMetres = 0.6;

/// All that is identified of an arm: the candidates, then the compliance (radians per newton metre) of joints
/// 2 and 3, which carry the arm's weight.
inline constexpr int kComplianceCount = 2;
inline constexpr std::array<int, kComplianceCount> kCompliantJoints{1, 2};  // indices
inline constexpr int kArmParameterCount = kErrorParameterCount + kComplianceCount;
using ArmVector = Eigen::Matrix<double, kArmParameterCount, 1>;
using ArmRow = Eigen::Matrix<double, 1, kArmParameterCount>;
using ArmMatrix = Eigen::Matrix<double, kArmParameterCount, kArmParameterCount>;

/// All candidates: frame 0 to 7 and, in a frame, alpha d theta r beta.
const std::array<ErrorParameter, kErrorParameterCount>& error_parameters();

/// Index of a candidate by its name, or nothing.
std::optional<int> error_parameter_index(std::string_view name);

/// The model's value of a candidate, metres or radians.
double parameter_value(const KinematicModel& model, int index);

/// The model with `errors` added to its parameters.
KinematicModel apply(const KinematicModel& model, const ErrorVector& errors);
KinematicModel apply(const KinematicModel& model, const ArmVector& errors);

/// An expression of either length, which could become either vector.
template <class Expression>
concept ErrorExpression = Expression::RowsAtCompileTime == kErrorParameterCount ||
                          Expression::RowsAtCompileTime == kArmParameterCount;

template <ErrorExpression Expression>
KinematicModel apply(const KinematicModel& model, const Eigen::MatrixBase<Expression>& errors) {
  return apply(model, errors.eval());
}

/// d tip / d error parameter, 3 x 37, in R_-1: metres per metre and metres per radian; the psi of eq. 6.
Eigen::Matrix<double, 3, kErrorParameterCount> tip_derivatives(const KinematicModel& model,
                                                               const Chain& chain);

/// The derivatives that follow are by all parameters of the arm, in R_-1: metres per metre, per radian and
/// per rad/Nm. They hold the moments of gravity at their values on the chain that is given: exact for a rigid
/// arm, else wrong by a share of the order of the deflection in radians (3e-4 for 0.3 mrad). Where they are
/// used to find a root, that costs no accuracy.

/// Of the distance of the tip along `outward`: a row of W. The prepared form is the fast one.
ArmRow distance_derivatives(const PreparedModel& prepared, const Chain& chain,
                            const Eigen::Vector3d& outward);
ArmRow distance_derivatives(const KinematicModel& model, const Chain& chain, const Eigen::Vector3d& outward);

/// Of the tip, 3 x 39.
Eigen::Matrix<double, 3, kArmParameterCount> tip_arm_derivatives(const KinematicModel& model,
                                                                 const Chain& chain);

/// Of a point that is fixed in R_last_frame, 3 x 39; frames after that one do not move it.
Eigen::Matrix<double, 3, kArmParameterCount> point_arm_derivatives(const PreparedModel& prepared,
                                                                   const Chain& chain,
                                                                   const Eigen::Vector3d& point_in_block_m,
                                                                   int last_frame);
Eigen::Matrix<double, 3, kArmParameterCount> point_arm_derivatives(const KinematicModel& model,
                                                                   const Chain& chain,
                                                                   const Eigen::Vector3d& point_in_block_m,
                                                                   int last_frame);

}  // namespace calib
