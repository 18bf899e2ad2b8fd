#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "calib_core/kinematic_model.hpp"

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

/// All that is identified of an arm: the candidates, then the compliance (radians per newton metre) of joints 2
/// and 3, which carry the arm's weight.
inline constexpr int kComplianceCount = 2;
inline constexpr int kArmParameterCount = kErrorParameterCount + kComplianceCount;
using ArmVector = Eigen::Matrix<double, kArmParameterCount, 1>;
using ArmMatrix = Eigen::Matrix<double, kArmParameterCount, kArmParameterCount>;

/// All candidates: frame 0 to 7 and, in a frame, alpha d theta r beta.
const std::array<ErrorParameter, kErrorParameterCount>& error_parameters();

/// Index of a candidate by its name, or nothing.
std::optional<int> error_parameter_index(std::string_view name);

/// The model's value of a candidate, metres or radians.
double parameter_value(const KinematicModel& model, int index);

/// The model with `errors` added to its parameters.
KinematicModel apply(const KinematicModel& model, const ErrorVector& errors);

/// d tip / d error parameter, 3 x 37, in R_-1: metres per metre and metres per radian; the psi of eq. 6.
Eigen::Matrix<double, 3, kErrorParameterCount> tip_derivatives(const KinematicModel& model,
                                                               const Chain& chain);

}  // namespace calib
