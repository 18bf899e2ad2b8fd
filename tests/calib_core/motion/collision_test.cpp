#include "calib_core/motion/collision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr double kDistanceErrorMaxMetres = 1e-6;

double point_box_distance(const Eigen::Vector3d& point, const Box& box) {
  return (point - point.cwiseMax(box.min_m).cwiseMin(box.max_m)).norm();
}

/// The least of a convex function of one variable in [0, 1], by cutting thirds.
template <class F>
double least(const F& value) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double third = (high - low) / 3.0;
    if (value(low + third) < value(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  return value(0.5 * (low + high));
}

struct Chance {
  std::mt19937_64 generator{7};
  std::uniform_real_distribution<double> coordinate{-1.0, 1.0};
  Eigen::Vector3d point() { return {coordinate(generator), coordinate(generator), coordinate(generator)}; }
};

TEST(Collision, SegmentToBoxIsTheLeastDistanceOfItsPoints) {
  Chance chance;
  const Box box{"box", {-0.3, -0.1, -0.2}, {0.2, 0.4, 0.1}};
  for (int i = 0; i < 20000; ++i) {
    const Segment segment{chance.point(), chance.point()};
    const double expected = least([&](double t) {
      return point_box_distance(segment.from_m + t * (segment.to_m - segment.from_m), box);
    });
    ASSERT_NEAR(segment_box_distance_m(segment, box), expected, kDistanceErrorMaxMetres);
  }
}

TEST(Collision, ARoundedBoxIsNearerByItsRounding) {
  Chance chance;
  const Box ball{"ball", {0.1, 0.2, -0.1}, {0.1, 0.2, -0.1}, 0.15};
  const Box box{"box", {-0.3, -0.1, -0.2}, {0.2, 0.4, 0.1}, 0.05};
  for (int i = 0; i < 5000; ++i) {
    const Segment segment{chance.point(), chance.point()};
    const auto from_core_m = [&](const Box& core) {
      return least([&](double t) {
        return point_box_distance(segment.from_m + t * (segment.to_m - segment.from_m), core);
      });
    };
    for (const Box& solid : {ball, box}) {
      const double expected = std::max(from_core_m(solid) - solid.round_m, 0.0);
      ASSERT_NEAR(segment_box_distance_m(segment, solid), expected, kDistanceErrorMaxMetres);
      if (expected == 0.0) continue;
      ASSERT_TRUE(is_apart(segment, solid, expected - kDistanceErrorMaxMetres));
      ASSERT_FALSE(is_apart(segment, solid, expected + kDistanceErrorMaxMetres));
    }
  }
}

/// A box with an oblique and a straight hole.
Box holed_box() {
  Box box{"ring", {-0.5, -0.3, -0.5}, {0.5, 0.3, 0.5}};
  box.holes.push_back({{0.25, 0, 0}, {0, 1, 0}, 0.2});
  box.holes.push_back({{-0.25, 0, 0}, Eigen::Vector3d(0.1, 1, 0.05).normalized(), 0.15});
  return box;
}

bool is_material(const Box& box, const Eigen::Vector3d& point_m) {
  return box.contains(point_m) && std::ranges::none_of(box.holes, [&](const Hole& hole) {
           return hole.off_axis_m(point_m).norm() < hole.radius_m;
         });
}

TEST(Collision, ABoxWithHolesIsNoNearerThanItsMaterial) {
  Chance chance;
  const Box box = holed_box();
  int in_holes = 0, clear = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d from_m = 0.6 * chance.point();
    const Segment segment{from_m, from_m + 0.3 * chance.point()};
    const double bound_m = segment_box_distance_m(segment, box);
    if (bound_m == 0.0) continue;
    ++clear;
    if (box.contains(from_m)) ++in_holes;
    ASSERT_TRUE(is_apart(segment, box, bound_m - kDistanceErrorMaxMetres));
    ASSERT_FALSE(is_apart(segment, box, bound_m + kDistanceErrorMaxMetres));
    for (int k = 0; k < 200; ++k) {
      const Eigen::Vector3d on_segment_m =
          segment.from_m + 0.5 * (chance.point().x() + 1.0) * (segment.to_m - segment.from_m);
      const Eigen::Vector3d near_m = on_segment_m + 0.999 * bound_m * chance.point().normalized();
      ASSERT_FALSE(is_material(box, near_m)) << i;
    }
  }
  EXPECT_GT(in_holes, 20);
  EXPECT_GT(clear, 500);
}

TEST(Collision, InAHoleTheDistanceIsThatFromItsWall) {
  const Box box = holed_box();
  const Segment along{{0.30, -0.2, 0}, {0.30, 0.2, 0}};
  EXPECT_NEAR(segment_box_distance_m(along, box), 0.15, 1e-9);
  EXPECT_TRUE(segment_box_gap_m(along, box).isApprox(Eigen::Vector3d(-0.15, 0, 0), 1e-6));
  EXPECT_NEAR(segment_box_distance_m({{0.20, -0.9, 0}, {0.36, 0.2, 0}}, box), 0.09, 1e-9);
  EXPECT_NEAR(segment_box_distance_m({{0.25, 0, 0}, {0.25, 0, 0}}, box), 0.2, 1e-9);
  EXPECT_NEAR(segment_box_distance_m({{0.25, 0.4, 0}, {0.25, 0.9, 0}}, box), 0.2, 1e-9);  // over the mouth
  EXPECT_DOUBLE_EQ(segment_box_distance_m({{0.25, 0, 0}, {0.48, 0, 0}}, box), 0.0);       // through the wall
  EXPECT_DOUBLE_EQ(segment_box_distance_m({{0.0, 0.5, 0}, {0.0, 0.5, 0}}, box), 0.2);
}

TEST(Collision, SegmentsAlongABoxAndPointsAreNoSpecialCase) {
  const Box box{"box", {0, 0, 0}, {1, 1, 1}};
  EXPECT_DOUBLE_EQ(segment_box_distance_m({{-1, 0.5, 1.25}, {2, 0.5, 1.25}}, box), 0.25);
  EXPECT_DOUBLE_EQ(segment_box_distance_m({{4, 5, 0.5}, {4, 5, 0.5}}, box), 5.0);
  EXPECT_DOUBLE_EQ(segment_box_distance_m({{-1, 0.5, 0.5}, {2, 0.5, 0.5}}, box), 0.0);
  EXPECT_NEAR(segment_box_distance_m({{2, 1, 0.5}, {1, 2, 0.5}}, box), std::sqrt(0.5), 1e-15);
}

TEST(Collision, CapsuleToBoxIsTheSegmentsDistanceLessTheRadius) {
  const Box box{"box", {0, 0, 0}, {1, 1, 1}};
  EXPECT_NEAR(capsule_box_distance_m({0.5, 1.5, 0.5}, {0.5, 3, 0.5}, 0.2, box), 0.3, 1e-15);
  EXPECT_LE(capsule_box_distance_m({0.5, 0.5, 0.5}, {0.5, 3, 0.5}, 0.2, box), 0.0);
}

TEST(Collision, SegmentToSegmentIsTheLeastDistanceOfTheirPoints) {
  Chance chance;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d a0 = chance.point(), a1 = chance.point(), b0 = chance.point(), b1 = chance.point();
    const double expected = least([&](double s) {
      return least([&](double t) { return (a0 + s * (a1 - a0) - b0 - t * (b1 - b0)).norm(); });
    });
    ASSERT_NEAR(segment_distance_m(a0, a1, b0, b1), expected, kDistanceErrorMaxMetres);
  }
}

TEST(Collision, ParallelSegmentsAndPointsAreNoSpecialCase) {
  EXPECT_DOUBLE_EQ(segment_distance_m({0, 0, 0}, {1, 0, 0}, {0.5, 2, 0}, {3, 2, 0}), 2.0);
  EXPECT_DOUBLE_EQ(segment_distance_m({0, 0, 0}, {1, 0, 0}, {4, 4, 0}, {6, 4, 0}), 5.0);
  EXPECT_DOUBLE_EQ(segment_distance_m({0, 0, 0}, {1, 0, 0}, {6, 4, 0}, {4, 4, 0}), 5.0);
  EXPECT_DOUBLE_EQ(segment_distance_m({0, 0, 0}, {0, 0, 0}, {0, 3, 4}, {0, 3, 4}), 5.0);
  EXPECT_DOUBLE_EQ(segment_distance_m({0, 0, 0}, {2, 0, 0}, {1, 3, 0}, {1, 3, 0}), 3.0);
}

TEST(FindClash, ParkPostureIsFarFromEverything) {
  const Chain chain = forward_chain(paper::nominal(), tx90::park_joints());
  EXPECT_FALSE(find_clash(tx90::scene(0.003), chain, 0.1));
}

TEST(FindClash, NamesTheBodyAndTheObstacle) {
  CollisionScene scene = tx90::scene(0.003);
  const Chain chain = forward_chain(paper::nominal(), tx90::park_joints());
  const Eigen::Vector3d tip = chain.tip_in_block_m();
  const Eigen::Vector3d corner = tip + Eigen::Vector3d(0.001, 0.010, -0.01);
  scene.obstacles = {{"shelf", corner, corner + Eigen::Vector3d::Constant(0.02)}};
  EXPECT_FALSE(find_clash(scene, chain, 0.002));
  const auto clash = find_clash(scene, chain, 0.008);
  ASSERT_TRUE(clash);
  EXPECT_EQ(clash->body, "ball");
  EXPECT_EQ(clash->other, "shelf");
  EXPECT_NEAR(clash->distance_m, std::hypot(0.010, 0.001) - 0.003, 1e-12);
}

TEST(FindClash, SeesTheToolHolderFoldedAgainstTheForearm) {
  const CollisionScene scene = tx90::scene(0.003);
  const auto clash =
      find_clash(scene, forward_chain(paper::nominal(), tx90::degrees(0, 0, 60, 0, 135, 0)), 0.0);
  ASSERT_TRUE(clash);
  EXPECT_EQ(clash->body, "tool holder");
  EXPECT_EQ(clash->other, "forearm");
}

TEST(FindClash, KeepsTheArmOffItselfByTheClearanceUpToAFewMillimetres) {
  CollisionScene scene;
  scene.bodies = {{"base", 0, {0, 0, 0}, {0, 0, 0}, 0.01}, {"hand", 7, {0, 0, 0}, {0, 0, 0}, 0.01}};
  const Chain chain = forward_chain(paper::nominal(), tx90::park_joints());
  const double apart =
      (chain.block_from_frame[7].translation() - chain.block_from_frame[0].translation()).norm();
  scene.bodies[1].radius_m = apart - scene.bodies[0].radius_m - 0.6 * kSelfClearanceMetres;
  EXPECT_FALSE(find_clash(scene, chain, 0.5 * kSelfClearanceMetres));
  EXPECT_TRUE(find_clash(scene, chain, kSelfClearanceMetres));
  scene.bodies[1].radius_m -= kSelfClearanceMetres;
  EXPECT_FALSE(find_clash(scene, chain, 10.0 * kSelfClearanceMetres));
}

TEST(FindClash, NeighboursMayTouch) {
  CollisionScene scene;
  scene.bodies = {{"upper arm", 2, {0, 0, 0}, {0.4, 0, 0}, 0.08},
                  {"forearm", 4, {0, 0, -0.4}, {0, 0, 0}, 0.08}};
  const Chain chain = forward_chain(paper::nominal(), tx90::park_joints());
  EXPECT_FALSE(find_clash(scene, chain, 0.0));
  scene.bodies[0].frame = 1;
  scene.bodies[0].to_m = {0, 0, 0.7};
  EXPECT_TRUE(find_clash(scene, chain, 0.0));
}

}  // namespace
}  // namespace calib
