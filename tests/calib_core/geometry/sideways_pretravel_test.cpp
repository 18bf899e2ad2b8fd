#include "calib_core/geometry/sideways_pretravel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "calib_core/geometry/face.hpp"

namespace calib {
namespace {

constexpr SidewaysPretravel kLobed{.tilt_m = 8e-6, .lobes_m = 5e-6, .lobe_direction_rad = 0.4};

/// A push that comes from this far off the stylus, in this direction about it.
Eigen::Vector3d push(double tilt_rad, double direction_rad) {
  return {std::sin(tilt_rad) * std::cos(direction_rad), std::sin(tilt_rad) * std::sin(direction_rad),
          -std::cos(tilt_rad)};
}

TEST(SidewaysPretravel, IsTheFormulaOfTheFiles) {
  for (const double tilt_rad : {0.1, 0.7, 1.2}) {
    for (double a = -3.0; a < 3.1; a += 0.3) {
      const double s = std::sin(tilt_rad);
      EXPECT_NEAR(kLobed.at(push(tilt_rad, a)), s * s * (8e-6 + 5e-6 * std::cos(3.0 * (a - 0.4))), 1e-18);
    }
  }
  EXPECT_EQ(kLobed.at({0.0, 0.0, -1.0}), 0.0) << "along the stylus";
  EXPECT_EQ(SidewaysPretravel{}.at(push(0.7, 1.0)), 0.0);
}

// The bound of the header, by differences over the sphere.
TEST(SidewaysPretravel, TurnsWithTheStylusNoFasterThanSaid) {
  const double bound = std::abs(kLobed.tilt_m) + 3.0 * std::abs(kLobed.lobes_m);
  constexpr double kTurnRad = 1e-4;
  for (double tilt_rad = 0.0; tilt_rad < 1.6; tilt_rad += 0.05) {
    for (double a = 0.0; a < 6.3; a += 0.1) {
      const double before_m = kLobed.at(push(tilt_rad, a));
      const double about_m = kLobed.at(push(tilt_rad, a + kTurnRad / std::max(std::sin(tilt_rad), 0.05)));
      EXPECT_LE(std::abs(kLobed.at(push(tilt_rad + kTurnRad, a)) - before_m), 1.001 * bound * kTurnRad);
      EXPECT_LE(std::abs(about_m - before_m), 1.001 * bound * kTurnRad);
    }
  }
}

// A ball of 3 mm over a face whose normal is z; the stylus leans to x.
TEST(SidewaysPretravel, LetsTheBallComeDeeperBeforeItTrips) {
  const Face face{.plane = {Eigen::Vector3d::UnitZ(), 0.1},
                  .center_m = {0, 0, 0.1},
                  .edge_u = Eigen::Vector3d::UnitX(),
                  .half_extent_m = {0.05, 0.05}};
  const ContactSurface surface =
      contact_plane(face, {.radius_m = 0.003, .pretravel_m = 1e-5, .sideways = kLobed});
  constexpr double kTiltRad = 0.6;
  Eigen::Isometry3d tip(Eigen::AngleAxisd(std::numbers::pi + kTiltRad, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d here = tip.linear().transpose() * Eigen::Vector3d::UnitZ();
  const double deeper_m = std::pow(std::sin(kTiltRad), 2) *
                          (8e-6 + 5e-6 * std::cos(3.0 * (std::atan2(here.y(), here.x()) - 0.4)));
  tip.translation() = Eigen::Vector3d(0.01, 0.02, 0.1 + 0.003 - 1e-5 - deeper_m);
  EXPECT_NEAR(signed_distance_m(surface, tip), 0.0, 1e-16);
  EXPECT_NEAR(signed_distance_m(surface, Eigen::Vector3d(tip.translation())), -deeper_m, 1e-16);
}

}  // namespace
}  // namespace calib
