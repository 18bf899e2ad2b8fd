#include "config/joint_units.hpp"

#include "calib_core/geometry/units.hpp"

namespace cell {

calib::JointVector joint_units(const calib::KinematicModel& model) {
  calib::JointVector units;
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    const bool turns = model.joint_types[static_cast<std::size_t>(joint)] == calib::JointType::kRevolute;
    units[joint] = turns ? calib::kRadiansPerDegree : calib::kMetresPerMillimetre;
  }
  return units;
}

}  // namespace cell
