#pragma once

#include <Eigen/Core>
#include <cmath>

namespace calib {

/// The shapes of SidewaysPretravel for a push on the ball (unit vector in R_7): s^2, s^2 cos 3a, s^2 sin 3a,
/// with s the sine of the angle between push and stylus and a the push's direction about z, from x to y.
inline Eigen::Vector3d sideways_shapes(const Eigen::Vector3d& push) {
  const double x = push.x(), y = push.y();
  const double squared = x * x + y * y;
  if (squared == 0.0) return Eigen::Vector3d::Zero();
  const double sine = std::sqrt(squared);
  return {squared, x * (x * x - 3.0 * y * y) / sine, y * (3.0 * x * x - y * y) / sine};
}

/// By how much the pre-travel of a push from the side exceeds that of one along the stylus: tilt_m s^2 +
/// lobes_m s^2 cos 3 (a - lobe_direction_rad). A kinematic probe rests on three points, hence three lobes.
/// It turns with the stylus: by at most |tilt_m| + 3 |lobes_m| a radian. Distances have it at the
/// orientation of the arm that they are computed with; derivatives by errors of the arm leave its turning
/// out, 1e-4 of a row for 10 um against a lever of 0.1 m.
struct SidewaysPretravel {
  double tilt_m = 0.0;
  double lobes_m = 0.0;
  double lobe_direction_rad = 0.0;

  [[nodiscard]] bool is_zero() const { return tilt_m == 0.0 && lobes_m == 0.0; }
  /// Factors of sideways_shapes().
  [[nodiscard]] Eigen::Vector3d factors_m() const {
    return {tilt_m, lobes_m * std::cos(3.0 * lobe_direction_rad),
            lobes_m * std::sin(3.0 * lobe_direction_rad)};
  }
  [[nodiscard]] double at(const Eigen::Vector3d& push) const {
    return is_zero() ? 0.0 : factors_m().dot(sideways_shapes(push));
  }
};

}  // namespace calib
