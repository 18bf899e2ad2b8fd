#pragma once

#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// Standard acceleration of free fall (ISO 80000-3), m/s^2.
inline constexpr double kFreeFall = 9.80665;

/// Torque of gravity about each joint axis, newton metres, positive where it increases the joint position:
/// gain * axis . sum of (centre - origin of the joint's frame) x weight over the masses of the joint's frame
/// and of all later frames. 0 for a prismatic joint.
JointVector gravity_torques_nm(const KinematicModel& model, const Chain& chain);

}  // namespace calib
