#include "calib_core/planning/touch_feasibility.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

PlanningProblem top_problem() {
  return {.nominal = paper::nominal(),
          .joint_ranges = tx90::joint_ranges(),
          .faces = tx90::faces(),
          .stylus = {.radius_m = 0.003},
          .scene = tx90::scene(0.003),
          .park_joints = tx90::park_joints(),
          .tilt_max_rad = radians_from_degrees(70)};
}

/// A touch in the middle of the top, tilted towards the column, in the posture nearest to park.
struct TopTouch {
  PlanningProblem problem = top_problem();
  TouchPose pose;
  JointVector joints;

  explicit TopTouch(double tilt_deg) {
    pose.tilt_rad = radians_from_degrees(tilt_deg);
    const Eigen::Vector3d axis(std::sin(pose.tilt_rad), std::cos(pose.tilt_rad), 0);
    const Eigen::Vector3d across = Eigen::Vector3d::UnitZ();
    pose.block_from_tip.linear() << across.cross(axis), across, axis;
    pose.block_from_tip.translation() = Eigen::Vector3d(0, -0.153, 0);
    joints = nearest_to_park();
  }

  JointVector nearest_to_park() const {
    const auto all = inverse_kinematics(problem.nominal, problem.joint_ranges, pose.block_from_tip);
    return *std::ranges::min_element(
        all, {}, [&](const JointVector& each) { return (each - problem.park_joints).norm(); });
  }

  [[nodiscard]] std::string trouble() const {
    const auto touch = make_touch(problem, find_target(problem, 2), pose, joints);
    const auto* text = std::get_if<std::string>(&touch);
    return text ? *text : "";
  }
};

/// The same cell with a ball beside the block as the sixth face.
PlanningProblem ball_problem(double radius_m) {
  PlanningProblem problem = top_problem();
  const Eigen::Vector3d center_m(0.14, -0.18, 0.11);
  problem.faces.push_back(sphere_face(center_m, radius_m, {0, -1, 0}, radians_from_degrees(100)));
  problem.scene.obstacles.push_back({"ball", center_m, center_m, radius_m});
  return problem;
}

/// What becomes of every posture of random poses on the ball.
std::vector<std::variant<PlannedTouch, TouchInfeasibility>> touches_on_ball(const PlanningProblem& problem) {
  const TouchMaker maker(problem);
  const TouchTarget target = find_target(problem, 5);
  UniformChance chance(9);
  std::vector<std::variant<PlannedTouch, TouchInfeasibility>> all;
  for (int i = 0; i < 300; ++i) {
    const TouchPose pose = sample_touch_pose(problem, problem.faces[5], chance, 0.7);
    for (const JointVector& joints : maker.inverse().solve(pose.block_from_tip))
      all.push_back(maker.make(target, pose, joints));
  }
  return all;
}

TEST(TouchOnASphere, SearchesAlongTheNormalAtItsContact) {
  const PlanningProblem problem = ball_problem(0.025);
  const auto on_normal_m = [&](const JointVector& joints, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d off_m =
        forward_kinematics(problem.nominal, joints).translation() - problem.faces[5].cap->center_m;
    EXPECT_LT(off_m.cross(normal).norm(), 1e-9);
    return off_m.dot(normal);
  };
  const double drop_m = 0.028 - std::sqrt(0.028 * 0.028 - 0.012 * 0.012);
  int feasible = 0;
  double lowest = -1.0;  // of the normals, along -y
  for (const auto& made : touches_on_ball(problem)) {
    const auto* touch = std::get_if<PlannedTouch>(&made);
    if (!touch) continue;
    ++feasible;
    const Eigen::Vector3d normal = -touch->search_direction;
    lowest = std::max(lowest, normal.y());
    EXPECT_NEAR(on_normal_m(touch->joints, normal), 0.028, 1e-9);
    EXPECT_NEAR(on_normal_m(touch->approach_joints, normal), 0.028 + 0.015, 1e-9);
    EXPECT_NEAR(on_normal_m(touch->search_end_joints, normal), 0.028 - 0.015 - drop_m, 1e-9);
    EXPECT_NEAR(touch->search_length_m, 0.030 + drop_m, 1e-12);
    const Chain chain = forward_chain(problem.nominal, touch->joints);
    for (const Capsule& body : problem.scene.bodies) {  // in contact nothing else is in the ball
      if (body.name == "ball") continue;
      const double gap_m =
          segment_box_gap_m(axis_in_block(body, chain), problem.scene.obstacles.back()).norm();
      EXPECT_GT(gap_m, 0.025 + body.radius_m) << body.name;
    }
  }
  EXPECT_GT(feasible, 50);
  EXPECT_GT(lowest, -0.5);  // from its sides too
}

TEST(TouchOnASphere, IsRefusedWhereTheArmMayMissIt) {
  const PlanningProblem problem = ball_problem(0.020);  // 23 mm with the stylus ball, for a miss of 12 mm
  for (const auto& made : touches_on_ball(problem)) {
    const auto* infeasibility = std::get_if<TouchInfeasibility>(&made);
    ASSERT_TRUE(infeasibility);
    EXPECT_EQ(infeasibility->cause, TouchInfeasibility::Cause::kSmallSphere);
    EXPECT_NE(describe(problem, *infeasibility).find("nominal_miss_mm"), std::string::npos);
  }
  EXPECT_FALSE(touches_on_ball(problem).empty());
}

TEST(TouchHeights, AreThoseOfTheLargestErrorThatASearchReaches) {
  const TouchHeights heights = touch_heights(position_error_max_m(0.060), 0.015);
  EXPECT_NEAR(heights.approach_m - heights.search_end_m, 0.060, 1e-12);
  EXPECT_GT(heights.approach_m, position_error_max_m(0.060)) << "the ball is off the face at the start";
}

TEST(TouchCandidate, ChanceIsTheStandardsGenerator) {
  // [rand.predef]: the 10000th value of a default-constructed mt19937_64, whose seed is 5489.
  UniformChance chance(5489);
  for (int i = 1; i < 10000; ++i) chance();
  EXPECT_EQ(chance(), static_cast<double>(9981545732273789042ULL >> 11) * 0x1.0p-53);
}

TEST(TouchCandidate, PosesFillTheFaceAndTheTiltsAndKeepTheirLimits) {
  const PlanningProblem problem = top_problem();
  for (const Face& face : problem.faces) {
    UniformChance chance(3);
    std::array<int, 4> quadrants{}, tilts{};
    for (int i = 0; i < 2000; ++i) {
      const TouchPose pose = sample_touch_pose(problem, face, chance);
      const Eigen::Vector3d ball = pose.block_from_tip.translation();
      EXPECT_NEAR(signed_distance_m(contact_plane(face, problem.stylus), ball), 0.0, 1e-12);
      const double u = (ball - face.center_m).dot(face.edge_u), v = (ball - face.center_m).dot(face.edge_v());
      EXPECT_LE(std::abs(u), face.half_extent_m.x() - problem.nominal_position_error_m);
      EXPECT_LE(std::abs(v), face.half_extent_m.y() - problem.nominal_position_error_m);
      EXPECT_NEAR(pose.block_from_tip.linear().determinant(), 1.0, 1e-12);
      EXPECT_NEAR(pose.block_from_tip.linear().col(2).dot(-face.plane.outward), std::cos(pose.tilt_rad),
                  1e-12);
      EXPECT_LE(pose.tilt_rad, problem.tilt_max_rad);
      ++quadrants[(u > 0.0 ? 1u : 0u) + (v > 0.0 ? 2u : 0u)];
      ++tilts[std::min<std::size_t>(3, static_cast<std::size_t>(4.0 * pose.tilt_rad / problem.tilt_max_rad))];
    }
    for (const int count : quadrants) EXPECT_NEAR(count, 500, 100);
    for (const int count : tilts) EXPECT_NEAR(count, 500, 100);
  }
}

TEST(TouchCandidate, KnowsTheSolidThatIsTouchedAndWhatIsBehindIt) {
  const PlanningProblem problem = top_problem();  // obstacles: block, plate, table
  for (const int side : {0, 1, 3}) {
    const TouchTarget around = find_target(problem, side);
    EXPECT_EQ(around.solid, 0);
    EXPECT_EQ(around.is_behind, (std::vector{true, false, false}));
  }
  EXPECT_EQ(find_target(problem, 2).solid, 0);
  EXPECT_EQ(find_target(problem, 2).is_behind, (std::vector{true, true, true}));
  EXPECT_EQ(find_target(problem, 4).solid, 1);
  EXPECT_EQ(find_target(problem, 4).is_behind, (std::vector{false, true, true}));
}

TEST(TouchCandidate, AFaceInTheAirTouchesNothingAndHidesNothing) {
  PlanningProblem problem = top_problem();
  problem.faces[2].plane.offset_m += 0.1;
  problem.faces[2].center_m.y() -= 0.1;
  EXPECT_EQ(find_target(problem, 2).solid, -1);
  EXPECT_EQ(find_target(problem, 2).is_behind, (std::vector{false, false, false}));
}

TEST(TouchCandidate, MakesATouchWhoseProbeStaysOverTheFace) { EXPECT_EQ(TopTouch(40).trouble(), ""); }

TEST(TouchCandidate, RefusesAProbeThatLeansIntoTheFace) {
  // In the middle of the face the holder, 40 mm thick, 91 mm from the ball, meets it at about 64 degrees.
  EXPECT_EQ(TopTouch(70).trouble(), "the tool holder is within 12 mm of the block");
}

TEST(TouchCandidate, RefusesAnObstacleBesideTheTouch) {
  TopTouch touch(40);
  const Eigen::Vector3d beside(0.0, -0.152, 0.010);  // 2 mm over the face
  touch.problem.scene.obstacles.push_back({"clamp", beside, beside + Eigen::Vector3d::Constant(0.005)});
  EXPECT_EQ(touch.trouble(), "the stem is within 12 mm of the clamp");
}

TEST(TouchCandidate, RefusesASearchThatWouldLeaveTheJointRanges) {
  TopTouch touch(40);
  EXPECT_EQ(touch.trouble(), "");
  touch.problem.joint_ranges.upper[1] = touch.joints[1] + radians_from_degrees(1.5);
  EXPECT_EQ(touch.trouble(), "joint ranges");
}

TEST(TouchCandidate, RefusesAStraightWrist) {
  TopTouch touch(40);
  touch.joints[4] = radians_from_degrees(3);
  touch.pose.block_from_tip = forward_kinematics(touch.problem.nominal, touch.joints);
  EXPECT_EQ(touch.trouble(), "postures near a singular one");
}

}  // namespace
}  // namespace calib
