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
