#include "calib_core/planning/internal/bore_room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib_core/planning/touch_feasibility.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr double kRingMissMetres = 0.012;
constexpr double kRingContactMetres = 0.039;
constexpr std::size_t kRingBore = 5;

/// The ring beside the block as the sixth face, with depths that may be touched and a radius.
PlanningProblem ring_problem(double half_depth_m = 0.020, double radius_m = 0.042) {
  PlanningProblem problem{.nominal = paper::nominal(),
                          .joint_ranges = tx90::joint_ranges(),
                          .faces = tx90::faces(),
                          .stylus = {.radius_m = 0.003},
                          .scene = tx90::scene(0.003),
                          .park_joints = tx90::park_joints(),
                          .nominal_position_error_m = kRingMissMetres,
                          .tilt_max_rad = radians_from_degrees(70)};
  const BoreWall wall = *drawn::bore().bore;
  problem.faces.push_back(bore_face(wall, radius_m, {1, 0, 0}, half_depth_m));
  Box ring = drawn::bored_ring();
  ring.holes[0].radius_m = radius_m;
  problem.scene.obstacles.push_back(ring);
  return problem;
}

/// A body of the probe from 4 to 50 mm behind the ball, leaning over the axis of the bore (-y).
Segment stem_behind(const Eigen::Vector3d& ball_m, const Eigen::Vector3d& outward, double lean_rad,
                    double aside_rad) {
  const Eigen::Vector3d axis(0, -1, 0);
  const Eigen::Vector3d back =
      std::cos(lean_rad) * axis + std::sin(lean_rad) * (Eigen::AngleAxisd(aside_rad, axis) * outward);
  return {ball_m + 0.004 * back, ball_m + 0.050 * back};
}

TEST(BoreRoom, KnowsTheSolidThatTheBoreIsIn) {
  const PlanningProblem problem = ring_problem();
  const int ring = static_cast<int>(problem.scene.obstacles.size()) - 1;
  EXPECT_EQ(find_bored_solid(problem, problem.faces[kRingBore]), ring);
  const TouchTarget target = find_target(problem, kRingBore);
  EXPECT_EQ(target.solid, ring);
  EXPECT_TRUE(target.is_behind.back());
  EXPECT_FALSE(target.is_behind.front());  // the block
  EXPECT_EQ(find_bored_solid(problem, bore_face(*drawn::bore().bore, 0.030, {1, 0, 0}, 0.02)), -1);
}

TEST(BoreRoom, IsEnoughAtTheSmallestRadiusForTheApproachOfAnyMiss) {
  for (const double error_m : {0.001, 0.004, 0.012, 0.020}) {
    PlanningProblem problem = ring_problem();
    problem.nominal_position_error_m = error_m;
    const double standoff_m = std::max(error_m + 0.003, 0.015);
    const double contact_m = bore_radius_min_m(problem, standoff_m) - problem.stylus.radius_m;
    const double at_approach_m =
        std::sqrt(contact_m * contact_m - error_m * error_m) - standoff_m;  // of the wall beside
    EXPECT_GE(contact_m, 2.0 * error_m);
    EXPECT_LE(std::abs(at_approach_m) + error_m, contact_m + 1e-12) << error_m;
  }
}

// The wall by itself: balls within the position error and up to the wall, stems as badly turned as may be.
TEST(BoreRoom, AStemThatStaysOffTheWallMeetsItNowhere) {
  const PlanningProblem problem = ring_problem();
  const Face& bore = problem.faces[kRingBore];
  const Capsule stem{"stem", 7, {0, 0, -0.050}, {0, 0, -0.004}, 0.0015};
  UniformChance chance(5);
  const auto even = [&](double most) { return (2.0 * chance() - 1.0) * most; };
  int stays = 0, meets = 0;
  for (int i = 0; i < 2'000; ++i) {
    const Eigen::Vector3d outward =
        Eigen::AngleAxisd(even(std::numbers::pi), Eigen::Vector3d::UnitY()) * Eigen::Vector3d::UnitX();
    const double height_m = chance() * 0.015;
    const Eigen::Vector3d ball_m = bore.bore->center_m - (kRingContactMetres - height_m) * outward;
    const Segment axis = stem_behind(ball_m, outward, even(0.9), even(std::numbers::pi / 2.0));
    const bool off = stays_off_wall(problem, bore, problem.scene.obstacles.back(), stem, axis, ball_m);
    bool met = false;
    for (int k = 0; k < 200; ++k) {
      const Eigen::Vector3d beside_m(even(kRingMissMetres), 0, even(kRingMissMetres));
      const Eigen::Vector3d from_axis_m = ball_m + beside_m - bore.bore->center_m;
      if (beside_m.norm() > kRingMissMetres || from_axis_m.norm() > kRingContactMetres) continue;
      const Eigen::AngleAxisd turned(even(kOrientationErrorMaxRadians),
                                     Eigen::Vector3d(even(1), even(1), even(1)).normalized());
      for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Eigen::Vector3d point_m =
            ball_m + beside_m + turned * (axis.from_m + share * (axis.to_m - axis.from_m) - ball_m);
        if (point_m.y() < -0.06 - 0.0015) continue;  // above the mouth
        met = met || std::hypot(point_m.x() - 0.14, point_m.z() - 0.11) + stem.radius_m > 0.0421;
      }
    }
    EXPECT_FALSE(off && met) << i;
    ++(off ? stays : meets);
  }
  EXPECT_GT(stays, 300);
  EXPECT_GT(meets, 300);
}

TEST(BoreRoom, TheBallItselfMeetsTheWallAndNothingElseIsAsked) {
  const PlanningProblem problem = ring_problem();
  const Face& bore = problem.faces[kRingBore];
  const Capsule ball{"ball", 7, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.003};
  const Eigen::Vector3d ball_m = bore.bore->center_m + Eigen::Vector3d(kRingContactMetres, 0, 0);
  EXPECT_TRUE(stays_off_wall(problem, bore, problem.scene.obstacles.back(), ball, {ball_m, ball_m}, ball_m));
}

/// What becomes of every posture of random poses in the bore.
std::vector<std::variant<PlannedTouch, TouchInfeasibility>> touches_in_bore(const PlanningProblem& problem) {
  const TouchMaker maker(problem);
  const TouchTarget target = find_target(problem, kRingBore);
  UniformChance chance(9);
  std::vector<std::variant<PlannedTouch, TouchInfeasibility>> all;
  for (int i = 0; i < 150; ++i) {
    const TouchPose pose = sample_touch_pose(problem, problem.faces[kRingBore], chance, 0.7);
    for (const JointVector& joints : maker.inverse().solve(pose.block_from_tip))
      all.push_back(maker.make(target, pose, joints));
  }
  return all;
}

TEST(TouchInABore, GoesInAlongTheAxisAndSearchesAcrossIt) {
  const PlanningProblem problem = ring_problem();
  const double rise_m = 0.039 - std::sqrt(0.039 * 0.039 - 0.012 * 0.012);
  const auto tip_m = [&](const JointVector& joints) -> Eigen::Vector3d {
    return forward_kinematics(problem.nominal, joints).translation() -
           problem.faces[kRingBore].bore->center_m;
  };
  int feasible = 0;
  double around_min = 1.0, around_max = -1.0;
  for (const auto& made : touches_in_bore(problem)) {
    const auto* touch = std::get_if<PlannedTouch>(&made);
    if (!touch) continue;
    ++feasible;
    const Eigen::Vector3d way = touch->search_direction;
    EXPECT_NEAR(way.y(), 0.0, 1e-12);
    around_min = std::min(around_min, way.x());
    around_max = std::max(around_max, way.x());
    const Eigen::Vector3d contact_m = tip_m(touch->joints);
    EXPECT_NEAR(contact_m.dot(way), 0.039, 1e-9);
    EXPECT_LE(std::abs(contact_m.y()), 0.008 + 1e-9);
    EXPECT_NEAR((tip_m(touch->approach_joints) - contact_m).dot(way), -(0.015 + rise_m), 1e-9);
    EXPECT_NEAR((tip_m(touch->search_end_joints) - contact_m).dot(way), 0.015, 1e-9);
    EXPECT_NEAR(touch->search_length_m, 0.030 + rise_m, 1e-12);
    EXPECT_LT(tip_m(touch->clear_joints).y(), -0.022 - 0.040);  // out of the mouth and of the slow zone
    const Capsule tip{"tip", 7, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.003};
    for (int step = 0; step <= 20; ++step) {  // on the way in all bodies have room for the miss
      const JointVector joints =
          touch->clear_joints + (touch->approach_joints - touch->clear_joints) * step / 20.0;
      CollisionScene scene = problem.scene;
      scene.bodies.push_back(tip);
      EXPECT_FALSE(find_clash(scene, forward_chain(problem.nominal, joints), kRingMissMetres - 1e-4));
    }
    for (const Capsule& body : problem.scene.bodies) {  // in contact only the ball is at the wall
      if (body.name == "ball") continue;
      const Segment axis = axis_in_block(body, forward_chain(problem.nominal, touch->joints));
      EXPECT_GT(segment_box_distance_m(axis, problem.scene.obstacles.back()), body.radius_m) << body.name;
    }
  }
  EXPECT_GT(feasible, 30);
  EXPECT_LT(around_min, -0.8);
  EXPECT_GT(around_max, 0.8);
}

TEST(TouchInABore, IsRefusedWhereItIsTooNarrowOrTooShallow) {
  const auto all_are = [](const PlanningProblem& problem, TouchInfeasibility::Cause cause, const char* said) {
    const auto all = touches_in_bore(problem);
    EXPECT_FALSE(all.empty());
    for (const auto& made : all) {
      const auto* infeasibility = std::get_if<TouchInfeasibility>(&made);
      ASSERT_TRUE(infeasibility);
      EXPECT_EQ(infeasibility->cause, cause);
      EXPECT_NE(describe(problem, *infeasibility).find(said), std::string::npos)
          << describe(problem, *infeasibility);
    }
  };
  all_are(ring_problem(0.020, 0.026), TouchInfeasibility::Cause::kNarrowBore, "it needs a radius of 27 mm");
  all_are(ring_problem(0.011), TouchInfeasibility::Cause::kShallowBore, "depth_mm");
}

// A stylus that is too short does not get in: the body of the probe is wider than what is left beside it.
TEST(TouchInABore, IsRefusedWhereTheProbeDoesNotEnter) {
  PlanningProblem problem = ring_problem();
  for (Capsule& body : problem.scene.bodies) {
    if (body.name == "stem") body.radius_m = 0.030;
  }
  for (const auto& made : touches_in_bore(problem)) EXPECT_TRUE(std::get_if<TouchInfeasibility>(&made));
}

}  // namespace
}  // namespace calib
