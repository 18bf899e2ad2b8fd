#include "tests/val3/kinematics.hpp"

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "config/arm_file.hpp"
#include "sim_controller/val3/machine/geometry.hpp"

namespace val3 {
namespace {

calib::JointVector radians(const Joint& joints_deg) {
  calib::JointVector result;
  for (int i = 0; i < calib::kJointCount; ++i)
    result[i] = joints_deg[static_cast<std::size_t>(i)] * kRadiansPerDegree;
  return result;
}

Joint degrees(const calib::JointVector& joints) {
  Joint result{};
  for (int i = 0; i < calib::kJointCount; ++i)
    result[static_cast<std::size_t>(i)] = joints[i] / kRadiansPerDegree;
  return result;
}

}  // namespace

NominalArm::NominalArm() {
  const cell::Arm arm = cell::read_arm(TOUCHCAL_SOURCE_DIR "/config/arms/tx90.json");
  model_ = arm.model;
  model_.links[0] = {};
  model_.links[1] = {};
  model_.links[7] = {.r_m = 0.1};  // wrist centre to flange
  ranges_ = arm.joint_ranges;
  speeds_deg_s_ = degrees(arm.joint_speeds_max);
}

Eigen::Isometry3d NominalArm::world_from_flange(const Joint& joints_deg) const {
  return calib::forward_kinematics(model_, radians(joints_deg));
}

std::optional<Joint> NominalArm::solve(const Eigen::Isometry3d& world_from_flange,
                                       const Joint& start_deg) const {
  const auto solution = calib::solve_near(model_, world_from_flange, radians(start_deg));
  if (!solution) return std::nullopt;
  return degrees(*solution);
}

bool NominalArm::in_range(const Joint& joints_deg) const {
  // a millionth of a degree of rounding is no violation
  const double slack = 1e-6 * kRadiansPerDegree;
  const calib::JointVector joints = radians(joints_deg);
  return (joints.array() >= ranges_.lower.array() - slack).all() &&
         (joints.array() <= ranges_.upper.array() + slack).all();
}

}  // namespace val3
