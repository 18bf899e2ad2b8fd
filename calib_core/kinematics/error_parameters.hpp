#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/kinematics/nongeometric_parameters.hpp"

namespace calib {

/// The kinematic errors that may be identified (section II of the paper): alpha d theta r beta of frames 1 to
/// 7, theta and r of frame 0. Called candidates until the identifiable ones are chosen.
inline constexpr int kErrorParameterCount = 37;

enum class ParameterKind { kAlpha, kD, kTheta, kR, kBeta };

/// What a parameter describes: the pose of the block relative to the arm (everything before the motion of
/// joint 1), the arm, or the tool.
enum class ParameterGroup { kBlockPose, kArm, kTool };

struct ErrorParameter {
  int frame = 0;
  ParameterKind kind = ParameterKind::kAlpha;

  [[nodiscard]] bool is_length() const { return kind == ParameterKind::kD || kind == ParameterKind::kR; }
  [[nodiscard]] ParameterGroup group() const;
  [[nodiscard]] std::string name() const;  // "alpha1", "r0"
};

/// One value per candidate in the order of error_parameters(), metres and radians.
using ErrorVector = Eigen::Matrix<double, kErrorParameterCount, 1>;

/// Standard deviation of each error from the maker's tolerances, metres and radians; nothing where no
/// tolerance is known.
using ErrorTolerances = std::array<std::optional<double>, kErrorParameterCount>;

/// Lever that compares rotations of the block's pose with translations: about the distance of the touches
/// from the middle of the block.
inline constexpr double kBlockPoseLeverMetres = 0.6;

/// All errors of an arm: the candidates, then what it does beside rigid kinematics.
inline constexpr int kArmParameterCount = kErrorParameterCount + kNongeometricCount;
using ArmVector = Eigen::Matrix<double, kArmParameterCount, 1>;
using ArmRow = Eigen::Matrix<double, 1, kArmParameterCount>;
using ArmMatrix = Eigen::Matrix<double, kArmParameterCount, kArmParameterCount>;

/// All candidates by frame, 0 to 7; within a frame alpha d theta r beta.
const std::array<ErrorParameter, kErrorParameterCount>& error_parameters();

/// Index into ArmVector of a position in nongeometric_parameters().
constexpr int nongeometric_index(int position) { return kErrorParameterCount + position; }
/// Name of a parameter by its index in ArmVector: "alpha1", "compliance2".
std::string arm_parameter_name(int index);

/// Index of theta of the frame that a joint moves; joint: index, 0 to 5. Frame 0 has two candidates, the
/// others five.
constexpr int theta_index(int joint) { return 2 + 5 * joint + 2; }

/// Whether an error of this parameter, by its index in ArmVector, moves the whole arm against the block as
/// one rigid body: it is then no error of the arm in the arm's own frame. These are all parameters before the
/// motion of joint 1: the group kBlockPose and beta1. Where the z axes of block and joint 1 are parallel,
/// beta1 is the tilt of the base that alpha1 does not give; elsewhere it moves the arm as others of the group
/// do together, which is why it does not count as one of them there.
bool is_place_error(int index);

/// The errors of an arm that has grown by this share since its model held: all lengths after joint 1 and
/// before the tool.
ArmVector errors_by_growth(const KinematicModel& model, double share);

/// Index of the candidate with this name, or nothing.
std::optional<int> error_parameter_index(std::string_view name);

/// Value of the parameter in the model, metres or radians.
double parameter_value(const KinematicModel& model, int index);

/// The model with `errors` added to its parameters.
KinematicModel apply(const KinematicModel& model, const ErrorVector& errors);
KinematicModel apply(const KinematicModel& model, const ArmVector& errors);

/// An Eigen expression of either length; without this overload the call would be ambiguous.
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

/// The following derivatives are with respect to all parameters of the arm, in R_-1: metres per metre, per
/// radian, per rad/Nm and per share of a mass. The gravity torques are held constant: exact for a rigid arm,
/// else a relative error of the order of the deflection in radians (3e-4 for 0.3 mrad). Root finding with
/// them converges to the exact root.

/// Of the tip's coordinate along `outward`: a row of W. The overload with a prepared model is faster.
ArmRow distance_derivatives(const PreparedModel& prepared, const Chain& chain,
                            const Eigen::Vector3d& outward);
/// The same of another point that is fixed in R_7: the ball of another tip.
ArmRow distance_derivatives(const PreparedModel& prepared, const Chain& chain,
                            const Eigen::Vector3d& point_in_block_m, const Eigen::Vector3d& outward);
ArmRow distance_derivatives(const KinematicModel& model, const Chain& chain, const Eigen::Vector3d& outward);

/// Of the tip, 3 x kArmParameterCount.
Eigen::Matrix<double, 3, kArmParameterCount> tip_arm_derivatives(const KinematicModel& model,
                                                                 const Chain& chain);

/// Of a point that is fixed in R_last_frame; later frames do not move it.
Eigen::Matrix<double, 3, kArmParameterCount> point_arm_derivatives(const PreparedModel& prepared,
                                                                   const Chain& chain,
                                                                   const Eigen::Vector3d& point_in_block_m,
                                                                   int last_frame);
Eigen::Matrix<double, 3, kArmParameterCount> point_arm_derivatives(const KinematicModel& model,
                                                                   const Chain& chain,
                                                                   const Eigen::Vector3d& point_in_block_m,
                                                                   int last_frame);

}  // namespace calib
