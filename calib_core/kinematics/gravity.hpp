#pragma once

#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/kinematics/nongeometric_parameters.hpp"

namespace calib {

/// Standard acceleration of free fall (ISO 80000-3), m/s^2.
inline constexpr double kFreeFall = 9.80665;

/// Torque of gravity about each joint axis, newton metres, positive where it increases the joint position:
/// gain * axis . sum of (centre - origin of the joint's frame) x weight over the masses of the joint's frame
/// and of all later frames. 0 for a prismatic joint. The overload with a prepared model is faster.
JointVector gravity_torques_nm(const PreparedModel& prepared, const Chain& chain);
JointVector gravity_torques_nm(const KinematicModel& model, const Chain& chain);

/// The share that the mass of each frame 1 to 7 (columns) has in these torques; the rows' sums.
Eigen::Matrix<double, kJointCount, kMassCount> gravity_torques_of_masses_nm(const PreparedModel& prepared,
                                                                            const Chain& chain);

}  // namespace calib
