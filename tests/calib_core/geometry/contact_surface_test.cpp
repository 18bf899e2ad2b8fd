#include "calib_core/geometry/contact_surface.hpp"

#include <gtest/gtest.h>

#include "calib_core/geometry/face.hpp"

namespace calib {
namespace {

const Eigen::Vector3d kCenter(0.14, -0.18, 0.11);
constexpr double kRadius = 0.025;

ContactSurface ball() { return surface_of(sphere_face(kCenter, kRadius, {0, -1, 0}, 1.5)); }

TEST(ContactSurface, OfASphereIsTheRadiusFromItsCentreInEveryDirection) {
  EXPECT_DOUBLE_EQ(ball().radius_m(), kRadius);
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0.6, 0, 0.8),
                                     Eigen::Vector3d(-2, 3, 6), Eigen::Vector3d(0, 1, 0)}) {
    const Eigen::Vector3d outward = way.normalized();
    const Eigen::Vector3d point_m = kCenter + 0.031 * outward;
    EXPECT_NEAR(signed_distance_m(ball(), point_m), 0.006, 1e-15);
    EXPECT_NEAR(signed_distance_m(ball(), kCenter + 0.02 * outward), -0.005, 1e-15);
    EXPECT_TRUE(normal_at(ball(), point_m).isApprox(outward, 1e-14));
    const Plane tangent = tangent_plane(ball(), point_m);
    EXPECT_NEAR(signed_distance_m(tangent, point_m), 0.006, 1e-15);
    EXPECT_NEAR(signed_distance_m(tangent, kCenter), -kRadius, 1e-15);
  }
}

/// A bore of 84 mm about a line along (0, -3, 4), touched around +x.
const Eigen::Vector3d kAxis(0.0, -0.6, 0.8);
Face bore_wall() {
  return bore_face({.center_m = kCenter, .axis = kAxis, .mouth_m = 0.025, .half_angle_rad = 3.2}, 0.042,
                   {1, 0, 0}, 0.020);
}

TEST(ContactSurface, OfABoreIsTheRadiusFromItsAxisAndItsMaterialIsOutside) {
  const ContactSurface bore = surface_of(bore_wall());
  EXPECT_DOUBLE_EQ(bore.radius_m(), 0.042);
  EXPECT_TRUE(bore.is_bore());
  EXPECT_FALSE(bore.is_sphere());
  for (const Eigen::Vector3d& way :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0.8, 0.6), Eigen::Vector3d(-0.6, 0.64, 0.48)}) {
    for (const double along_m : {-0.02, 0.0, 0.3}) {
      const Eigen::Vector3d on_axis_m = kCenter + along_m * kAxis;
      EXPECT_NEAR(signed_distance_m(bore, on_axis_m), 0.042, 1e-15);
      EXPECT_NEAR(signed_distance_m(bore, on_axis_m + 0.040 * way), 0.002, 1e-15);
      EXPECT_NEAR(signed_distance_m(bore, on_axis_m + 0.045 * way), -0.003, 1e-15);
      EXPECT_TRUE(normal_at(bore, on_axis_m + 0.040 * way).isApprox(-way, 1e-12));
      const Plane tangent = tangent_plane(bore, on_axis_m + 0.040 * way);
      EXPECT_NEAR(signed_distance_m(tangent, on_axis_m + 0.040 * way), 0.002, 1e-15);
      EXPECT_NEAR(signed_distance_m(tangent, on_axis_m), 0.042, 1e-15);
    }
  }
  EXPECT_EQ(normal_at(bore, kCenter), Eigen::Vector3d(-1, 0, 0));  // on the axis: any one
}

TEST(ContactSurface, OfTheStylusBallLiesItsRadiusLessPretravelInsideABore) {
  const ContactSurface contact = contact_plane(bore_wall(), {.radius_m = 0.003, .pretravel_m = 1e-5});
  EXPECT_DOUBLE_EQ(contact.radius_m(), 0.03901);  // where the ball's centre is at the trigger
  EXPECT_NEAR(signed_distance_m(contact, kCenter + Eigen::Vector3d(0.03901, 0, 0)), 0.0, 1e-15);
}

TEST(BoreFace, HasTheTangentPlaneOfTheMiddleOfItsWall) {
  const Face face = bore_wall();
  EXPECT_NEAR(signed_distance_m(face.plane, kCenter), 0.042, 1e-15);
  EXPECT_TRUE(face.center_m.isApprox(kCenter + Eigen::Vector3d(0.042, 0, 0)));
  EXPECT_EQ(face.edge_u, kAxis);
  EXPECT_DOUBLE_EQ(face.half_extent_m.x(), 0.020);
  EXPECT_DOUBLE_EQ(face.half_extent_m.y(), 0.042);
}

TEST(ContactSurface, HasTheDerivativeOfItsDistanceAsNormal) {
  constexpr double kStep = 1e-6;
  const ContactSurface plane{Eigen::Vector3d(0.6, 0, 0.8), 0.1};
  const Eigen::Vector3d point_m(0.17, -0.20, 0.12);
  for (const ContactSurface& surface : {plane, ball(), surface_of(bore_wall())}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const double slope =
          (signed_distance_m(surface, point_m + step) - signed_distance_m(surface, point_m - step)) /
          (2.0 * kStep);
      EXPECT_NEAR(normal_at(surface, point_m)[axis], slope, 1e-8);
    }
  }
}

TEST(ContactSurface, OfTheStylusBallLiesItsRadiusLessPretravelOutsideASphere) {
  const Face face = sphere_face(kCenter, kRadius, {0, -1, 0}, 1.5);
  const ContactSurface contact = contact_plane(face, {.radius_m = 0.003, .pretravel_m = 1e-5});
  EXPECT_DOUBLE_EQ(contact.radius_m(), 0.02799);
  EXPECT_EQ(*contact.center_m, kCenter);
}

TEST(SphereFace, HasTheTangentPlaneOfItsPole) {
  const Face face = sphere_face(kCenter, kRadius, {0, -1, 0}, 0.5);
  EXPECT_NEAR(signed_distance_m(face.plane, kCenter), -kRadius, 1e-15);
  EXPECT_TRUE(face.center_m.isApprox(Eigen::Vector3d(0.14, -0.205, 0.11)));
  EXPECT_NEAR(face.edge_u.dot(face.plane.outward), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(face.half_extent_m.x(), kRadius * std::sin(0.5));
}

}  // namespace
}  // namespace calib
