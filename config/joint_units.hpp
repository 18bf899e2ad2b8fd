#pragma once

#include "calib_core/kinematics/kinematic_model.hpp"

namespace cell {

/// What 1 in a file's six joint numbers is in SI units: a degree in radians, for a prismatic joint a
/// millimetre in metres.
calib::JointVector joint_units(const calib::KinematicModel& model);

}  // namespace cell
