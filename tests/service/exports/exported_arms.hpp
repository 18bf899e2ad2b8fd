#pragma once

#include <random>
#include <string>
#include <vector>

#include "calib_core/kinematics/error_parameters.hpp"
#include "config/arm_file.hpp"
#include "tests/config/folder.hpp"

namespace cell {

inline Arm shipped_arm(const std::string& name) {
  return read_arm(kSourceDir / "config/arms" / (name + ".json"));
}

/// With errors in all candidates: up to 3 mm and 3 mrad.
inline Arm calibrated(Arm arm) {
  std::mt19937_64 chance(5);
  std::uniform_real_distribution<double> within(-0.003, 0.003);
  calib::ErrorVector errors;
  for (double& error : errors) error = within(chance);
  arm.model = calib::apply(arm.model, errors);
  return arm;
}

/// Joint 3 slides, joint 5 counts backwards.
inline Arm sliding(Arm arm) {
  arm.model.joint_types[2] = calib::JointType::kPrismatic;
  arm.model.gains[4] = -1.0;
  arm.joint_ranges.lower[2] = -0.1;
  arm.joint_ranges.upper[2] = 0.3;
  return arm;
}

inline Arm rigid(Arm arm) {
  arm.model.compliance_rad_per_nm = {};
  arm.model.harmonics_rad = arm.model.second_harmonics_rad = arm.model.ripples_rad = calib::kEvenJoints;
  return arm;
}

/// A hundred within the joint ranges.
inline std::vector<calib::JointVector> postures(const Arm& arm) {
  std::mt19937_64 chance(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<calib::JointVector> result(100);
  for (calib::JointVector& joints : result) {
    for (int joint = 0; joint < calib::kJointCount; ++joint) {
      const double from = arm.joint_ranges.lower[joint], to = arm.joint_ranges.upper[joint];
      joints[joint] = from + share(chance) * (to - from);
    }
  }
  return result;
}

}  // namespace cell
