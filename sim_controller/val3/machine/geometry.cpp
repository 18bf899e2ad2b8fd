#include "sim_controller/val3/machine/geometry.hpp"

#include <cmath>

namespace val3 {

Eigen::Isometry3d isometry(const Trsf& trsf) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = Eigen::Vector3d(trsf.x, trsf.y, trsf.z);
  result.linear() = (Eigen::AngleAxisd(trsf.rx * kRadiansPerDegree, Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(trsf.ry * kRadiansPerDegree, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(trsf.rz * kRadiansPerDegree, Eigen::Vector3d::UnitZ()))
                        .toRotationMatrix();
  return result;
}

Trsf trsf_of(const Eigen::Isometry3d& isometry) {
  constexpr double kLockedWithin = 1e-12;
  const Eigen::Matrix3d& r = isometry.linear();
  const Eigen::Vector3d& t = isometry.translation();
  Trsf result{.x = t.x(), .y = t.y(), .z = t.z()};
  const double cosine = std::hypot(r(0, 0), r(0, 1));
  result.ry = std::atan2(r(0, 2), cosine) / kRadiansPerDegree;
  if (cosine < kLockedWithin) {
    result.rz = std::atan2(r(1, 0), r(1, 1)) / kRadiansPerDegree;
  } else {
    result.rx = std::atan2(-r(1, 2), r(2, 2)) / kRadiansPerDegree;
    result.rz = std::atan2(-r(0, 1), r(0, 0)) / kRadiansPerDegree;
  }
  return result;
}

Trsf composed(const Trsf& first, const Trsf& second) { return trsf_of(isometry(first) * isometry(second)); }

Trsf inverse(const Trsf& trsf) { return trsf_of(isometry(trsf).inverse()); }

Trsf scaled(const Trsf& trsf, double factor) {
  Trsf result = trsf;
  result.x *= factor;
  result.y *= factor;
  result.z *= factor;
  return result;
}

double distance(const Trsf& a, const Trsf& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

}  // namespace val3
