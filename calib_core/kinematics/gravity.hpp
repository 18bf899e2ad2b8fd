#pragma once

#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// Standard acceleration of free fall (ISO 80000-3), m/s^2.
inline constexpr double kFreeFall = 9.80665;

/// Moment of gravity about each joint's axis, newton metres, positive where it drives the joint position up:
/// gain * axis . sum of (centre - origin of the joint's frame) x weight over the masses of its frame and of
/// those after it. 0 for a prismatic joint.
JointVector gravity_torques_nm(const KinematicModel& model, const Chain& chain);

}  // namespace calib
