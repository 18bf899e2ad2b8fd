#include "calib_core/planning/touch_pose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"

namespace calib {
namespace {

constexpr double kMissMetres = 0.012;

PlanningProblem problem_with(double tilt_max_deg) {
  return {.stylus = {.radius_m = 0.003},
          .nominal_position_error_m = kMissMetres,
          .tilt_max_rad = radians_from_degrees(tilt_max_deg)};
}

Face ball(double half_angle_deg) {
  return sphere_face({0.14, -0.18, 0.11}, 0.025, Eigen::Vector3d(0.2, -1, 0.1).normalized(),
                     radians_from_degrees(half_angle_deg));
}

TEST(SampledSpherePose, TouchesTheCapWhereverTheArmMayBe) {
  const PlanningProblem problem = problem_with(40.0);
  UniformChance chance(7);
  for (const double half_angle_deg : {35.0, 80.0, 120.0}) {
    const Face face = ball(half_angle_deg);
    const double rim_rad = radians_from_degrees(half_angle_deg) - std::asin(kMissMetres / 0.028);
    double farthest_rad = 0.0;
    for (int i = 0; i < 2'000; ++i) {
      const TouchPose pose = sample_touch_pose(problem, face, chance, 0.7);
      const Eigen::Vector3d from_center_m = pose.block_from_tip.translation() - face.cap->center_m;
      EXPECT_NEAR(from_center_m.norm(), 0.028, 1e-12);
      const Eigen::Vector3d outward = from_center_m.normalized();
      const double off_pole_rad = std::acos(outward.dot(face.plane.outward));
      EXPECT_LE(off_pole_rad, rim_rad + 1e-9);
      farthest_rad = std::max(farthest_rad, off_pole_rad);
      const double lean_rad = std::acos(-outward.dot(pose.block_from_tip.linear().col(2)));
      EXPECT_NEAR(lean_rad, pose.tilt_rad, 1e-6);
      EXPECT_LE(lean_rad, radians_from_degrees(40.0) + 1e-9);
    }
    EXPECT_NEAR(farthest_rad, rim_rad, 1e-9);  // 70 % of them lie there
  }
}

TEST(SampledSpherePose, LeansLessThanOnAPlaneWhereTheArmMayComeDownBeside) {
  const PlanningProblem problem = problem_with(70.0);
  UniformChance chance(8);
  double most_rad = 0.0;
  for (int i = 0; i < 2'000; ++i)
    most_rad = std::max(most_rad, sample_touch_pose(problem, ball(90.0), chance, 0.7).tilt_rad);
  EXPECT_LE(most_rad, kSphereLeanMaxRadians - std::asin(kMissMetres / 0.028));
  EXPECT_GT(most_rad, 0.8 * (kSphereLeanMaxRadians - std::asin(kMissMetres / 0.028)));
}

Face bore(double half_angle_deg) {
  return bore_face({.center_m = {0.14, -0.038, 0.11},
                    .axis = Eigen::Vector3d(0.1, -1, 0).normalized(),
                    .mouth_m = 0.022,
                    .half_angle_rad = radians_from_degrees(half_angle_deg)},
                   0.042, {0, 0, 1}, 0.020);
}

TEST(SampledBorePose, TouchesTheWallWhereverTheArmMayBeAndStandsAlongTheAxis) {
  const PlanningProblem problem = problem_with(40.0);
  UniformChance chance(9);
  for (const double half_angle_deg : {50.0, 180.0}) {
    const Face face = bore(half_angle_deg);
    const double rim_rad = half_angle_deg == 180.0
                               ? radians_from_degrees(180.0)
                               : radians_from_degrees(half_angle_deg) - std::asin(kMissMetres / 0.039);
    double farthest_rad = 0.0, deepest_m = 0.0;
    for (int i = 0; i < 2'000; ++i) {
      const TouchPose pose = sample_touch_pose(problem, face, chance, 0.7);
      const Eigen::Vector3d ball_m = pose.block_from_tip.translation();
      EXPECT_NEAR(signed_distance_m(surface_of(face), ball_m), 0.003, 1e-12);
      const Eigen::Vector3d outward = normal_at(surface_of(face), ball_m);
      const double around_rad = std::acos(std::clamp(outward.dot(face.plane.outward), -1.0, 1.0));
      EXPECT_LE(around_rad, rim_rad + 1e-9);
      farthest_rad = std::max(farthest_rad, around_rad);
      const double along_m = std::abs((ball_m - face.bore->center_m).dot(face.bore->axis));
      EXPECT_LE(along_m, 0.008 + 1e-12);
      deepest_m = std::max(deepest_m, along_m);
      const Eigen::Vector3d into = pose.block_from_tip.linear().col(2);
      EXPECT_LE(std::acos(std::clamp(-into.dot(face.bore->axis), -1.0, 1.0)), kBoreLeanMaxRadians + 1e-6);
      EXPECT_LE(into.dot(outward), 1e-9);  // what is outside the mouth leans over the axis
      EXPECT_NEAR(std::acos(-outward.dot(into)), pose.tilt_rad, 1e-9);
      EXPECT_NEAR(pose.block_from_tip.linear().determinant(), 1.0, 1e-12);
    }
    EXPECT_GT(farthest_rad, 0.98 * rim_rad);
    EXPECT_NEAR(deepest_m, 0.008, 1e-9);
  }
}

TEST(ContactRise, IsWhatTheWallOfABoreComesCloserByWithinThePositionError) {
  const PlanningProblem problem = problem_with(40.0);
  EXPECT_NEAR(contact_rise_m(problem, bore(90.0)), 0.039 - std::sqrt(0.039 * 0.039 - 0.012 * 0.012), 1e-15);
  EXPECT_EQ(contact_drop_m(problem, bore(90.0)), 0.0);
  EXPECT_EQ(contact_rise_m(problem, ball(90.0)), 0.0);
}

TEST(ContactDrop, IsWhatASphereFallsAwayByWithinThePositionError) {
  const PlanningProblem problem = problem_with(40.0);
  EXPECT_NEAR(contact_drop_m(problem, ball(90.0)), 0.028 - std::sqrt(0.028 * 0.028 - 0.012 * 0.012), 1e-15);
  const Face flat{{{0, -1, 0}, 0.15}, {0, -0.15, 0}, {1, 0, 0}, {0.075, 0.075}};
  EXPECT_EQ(contact_drop_m(problem, flat), 0.0);
}

}  // namespace
}  // namespace calib
