#pragma once

#include <cmath>
#include <cstddef>

#include "calib_core/kinematics/error_parameters.hpp"

namespace calib {

/// Up to this sine of the angle between the z axes of block and joint 1 the base tilts by beta1: theta0 and
/// theta1 would have to turn against each other by more than twice the tilt.
inline constexpr double kTiltedByBetaSineMax = 0.5;

/// What a candidate describes on this arm: ErrorParameter::group(), but where these axes are parallel, or
/// nearly so, beta1 is the tilt of the base that alpha1 does not give, and the block's pose has it as well.
inline ParameterGroup group_on(const KinematicModel& nominal, int index) {
  const ErrorParameter& parameter = error_parameters()[static_cast<std::size_t>(index)];
  const bool is_beta1 = parameter.frame == 1 && parameter.kind == ParameterKind::kBeta;
  const bool tilts = is_beta1 && std::abs(std::sin(nominal.links[1].alpha_rad)) <= kTiltedByBetaSineMax;
  return tilts ? ParameterGroup::kBlockPose : parameter.group();
}

}  // namespace calib
