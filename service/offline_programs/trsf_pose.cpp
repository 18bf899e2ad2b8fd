#include "service/offline_programs/trsf_pose.hpp"

#include <cmath>

#include "calib_core/geometry/units.hpp"

namespace cell {
namespace {

constexpr double kWholeTurnDeg = 360.0;

double with_turns_near(double angle_deg, double near_deg) {
  return angle_deg + kWholeTurnDeg * std::round((near_deg - angle_deg) / kWholeTurnDeg);
}

Eigen::Vector3d angles_near(const Eigen::Vector3d& angles_deg, const Eigen::Vector3d& near_deg) {
  Eigen::Vector3d result;
  for (int i = 0; i < 3; ++i) result[i] = with_turns_near(angles_deg[i], near_deg[i]);
  return result;
}

}  // namespace

Eigen::Isometry3d pose_of_trsf(const SixNumbers& trsf, double mm_per_unit) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(trsf[0], trsf[1], trsf[2]) * calib::metres_from_mm(mm_per_unit);
  pose.linear() = (Eigen::AngleAxisd(calib::radians_from_degrees(trsf[3]), Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(calib::radians_from_degrees(trsf[4]), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(calib::radians_from_degrees(trsf[5]), Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix();
  return pose;
}

SixNumbers trsf_of_pose(const Eigen::Isometry3d& pose, const SixNumbers& near, double mm_per_unit) {
  const Eigen::Matrix3d& r = pose.linear();
  const Eigen::Vector3d near_deg(near[3], near[4], near[5]);
  const double cosine = std::hypot(r(0, 0), r(0, 1));
  const double ry = std::atan2(r(0, 2), cosine);
  Eigen::Vector3d angles_deg;
  if (cosine < kOneAxisCosine) {
    // R(1,0) = sin(rz +- rx), R(1,1) = cos(rz +- rx), + where ry is 90 deg.
    const double both = calib::degrees_from_radians(std::atan2(r(1, 0), r(1, 1)));
    const double rz = r(0, 2) > 0.0 ? both - near_deg[0] : both + near_deg[0];
    angles_deg = angles_near({near_deg[0], calib::degrees_from_radians(ry), rz}, near_deg);
  } else {
    const Eigen::Vector3d usual(calib::degrees_from_radians(std::atan2(-r(1, 2), r(2, 2))),
                                calib::degrees_from_radians(ry),
                                calib::degrees_from_radians(std::atan2(-r(0, 1), r(0, 0))));
    const Eigen::Vector3d one = angles_near(usual, near_deg);
    const Eigen::Vector3d other =
        angles_near({usual[0] + 180.0, 180.0 - usual[1], usual[2] + 180.0}, near_deg);
    angles_deg = (one - near_deg).norm() <= (other - near_deg).norm() ? one : other;
  }
  const Eigen::Vector3d lengths = pose.translation() / calib::metres_from_mm(mm_per_unit);
  return {lengths[0], lengths[1], lengths[2], angles_deg[0], angles_deg[1], angles_deg[2]};
}

}  // namespace cell
