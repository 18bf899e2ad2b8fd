#include "sim_controller/val3_units.hpp"

#include <cmath>
#include <numbers>

namespace sim {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr double kMetresPerMillimetre = 1e-3;
/// cos(ry) below this is a quarter turn about y: rx and rz cannot be told apart.
constexpr double kQuarterTurnCosine = 1e-12;

}  // namespace

calib::JointVector joints_from_val3(const val3::Joint& joints_deg) {
  calib::JointVector joints;
  for (int i = 0; i < calib::kJointCount; ++i)
    joints[i] = joints_deg[static_cast<std::size_t>(i)] * kRadiansPerDegree;
  return joints;
}

val3::Joint val3_from_joints(const calib::JointVector& joints) {
  val3::Joint joints_deg{};
  for (int i = 0; i < calib::kJointCount; ++i)
    joints_deg[static_cast<std::size_t>(i)] = joints[i] / kRadiansPerDegree;
  return joints_deg;
}

Eigen::Isometry3d pose_from_val3(const val3::Trsf& t) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(t.x, t.y, t.z) * kMetresPerMillimetre;
  pose.linear() = (Eigen::AngleAxisd(t.rx * kRadiansPerDegree, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(t.ry * kRadiansPerDegree, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(t.rz * kRadiansPerDegree, Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix();
  return pose;
}

val3::Trsf val3_from_pose(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d& r = pose.linear();
  const Eigen::Vector3d mm = pose.translation() / kMetresPerMillimetre;
  const double cos_ry = std::hypot(r(0, 0), r(0, 1));
  val3::Trsf t{.x = mm.x(), .y = mm.y(), .z = mm.z()};
  t.ry = std::atan2(r(0, 2), cos_ry) / kRadiansPerDegree;
  if (cos_ry < kQuarterTurnCosine) {
    t.rz = std::atan2(r(1, 0), r(1, 1)) / kRadiansPerDegree;
  } else {
    t.rx = std::atan2(-r(1, 2), r(2, 2)) / kRadiansPerDegree;
    t.rz = std::atan2(-r(0, 1), r(0, 0)) / kRadiansPerDegree;
  }
  return t;
}

}  // namespace sim
