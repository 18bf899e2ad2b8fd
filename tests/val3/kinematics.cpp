#include "tests/val3/kinematics.hpp"

#include <cmath>
#include <numbers>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "config/arm_file.hpp"

namespace val3 {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

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

Eigen::Isometry3d isometry(const Trsf& t) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = Eigen::Vector3d(t.x, t.y, t.z) / 1000.0;
  result.linear() = (Eigen::AngleAxisd(t.rx * kRadiansPerDegree, Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(t.ry * kRadiansPerDegree, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(t.rz * kRadiansPerDegree, Eigen::Vector3d::UnitZ()))
                        .toRotationMatrix();
  return result;
}

Trsf trsf(const Eigen::Isometry3d& isometry) {
  const Eigen::Matrix3d& r = isometry.linear();
  const Eigen::Vector3d mm = isometry.translation() * 1000.0;
  return {.x = mm.x(),
          .y = mm.y(),
          .z = mm.z(),
          .rx = std::atan2(-r(1, 2), r(2, 2)) / kRadiansPerDegree,
          .ry = std::atan2(r(0, 2), std::hypot(r(0, 0), r(0, 1))) / kRadiansPerDegree,
          .rz = std::atan2(-r(0, 1), r(0, 0)) / kRadiansPerDegree};
}

}  // namespace val3
