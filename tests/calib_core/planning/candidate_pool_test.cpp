#include "calib_core/planning/candidate_pool.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "calib_core/numerics/halton.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

PlanningProblem demo_problem() {
  PlanningProblem problem{.nominal = paper::nominal(),
                          .joint_ranges = tx90::joint_ranges(),
                          .faces = tx90::faces(),
                          .stylus = {.radius_m = 0.003},
                          .scene = tx90::scene(0.003),
                          .park_joints = tx90::park_joints(),
                          .tilt_max_rad = radians_from_degrees(70),
                          .candidate_count = 1000};
  for (int face = 0; face < 5; ++face) problem.requests.push_back({face, 5, 5, 2});
  return problem;
}

std::map<int, int> counts_by_face(const CandidatePool& pool) {
  std::map<int, int> counts;
  for (const TouchCandidate& candidate : pool.candidates) ++counts[candidate.face];
  return counts;
}

TEST(CandidatePool, SharesTheCandidatesEvenlyOverTheFaces) {
  const PlanningProblem problem = demo_problem();
  const CandidatePool pool = find_candidates(problem);
  EXPECT_GE(std::ssize(pool.candidates), problem.candidate_count);
  const auto counts = counts_by_face(pool);
  ASSERT_EQ(counts.size(), problem.requests.size());
  for (const auto& [face, count] : counts) EXPECT_NEAR(count, 200, static_cast<int>(Postures::kMax)) << face;
}

TEST(CandidatePool, EveryCandidateIsATouchThatCanBeMade) {
  PlanningProblem problem = demo_problem();
  problem.candidate_count = 200;
  const CandidatePool pool = find_candidates(problem);
  for (const TouchCandidate& candidate : pool.candidates) {
    const auto touch =
        make_touch(problem, find_target(problem, candidate.face), candidate.pose, candidate.joints);
    ASSERT_TRUE(std::holds_alternative<PlannedTouch>(touch)) << std::get<std::string>(touch);
    EXPECT_EQ(std::get<PlannedTouch>(touch).clear_joints, candidate.clear_joints);
    EXPECT_EQ(std::get<PlannedTouch>(touch).predicted_position_error_m, problem.nominal_position_error_m);
  }
}

/// The probe turned about the ball by what the true arm may be off, this way.
Segment turned(const Segment& body, const Eigen::Vector3d& ball_m, const Eigen::Vector3d& axis) {
  const Eigen::AngleAxisd turn(kOrientationErrorMaxRadians, axis);
  return {ball_m + turn * (body.from_m - ball_m), ball_m + turn * (body.to_m - ball_m)};
}

TEST(CandidatePool, TheBallTouchesFirstHoweverTheProbeIsTiltedAndTheArmIsOff) {
  const PlanningProblem problem = demo_problem();
  const CandidatePool pool = find_candidates(problem);
  double tilt_max_rad = 0.0;
  for (const TouchCandidate& candidate : pool.candidates) {
    tilt_max_rad = std::max(tilt_max_rad, candidate.pose.tilt_rad);
    const int touched = find_target(problem, candidate.face).solid;
    ASSERT_GE(touched, 0);
    const Box& solid = problem.scene.obstacles[static_cast<std::size_t>(touched)];
    const Chain chain = forward_chain(problem.nominal, candidate.joints);
    const Eigen::Isometry3d& probe = chain.block_from_frame.back();
    for (const Capsule& body : problem.scene.bodies) {
      if (body.frame != kFrameCount - 1 || body.name == "ball") continue;
      for (int way = 0; way < 8; ++way) {
        const double angle = way * std::numbers::pi / 4.0;
        const Eigen::Vector3d axis = probe.linear() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
        const Segment off = turned(axis_in_block(body, chain), probe.translation(), axis);
        // 1e-5: kOrientationErrorMaxRadians is taken times the distance, a little more than the turn lowers
        // it.
        ASSERT_GT(segment_box_distance_m(off, solid), body.radius_m - 1e-5) << body.name;
      }
    }
  }
  EXPECT_GT(tilt_max_rad, radians_from_degrees(65)) << "so steep that stem and holder limit it";
}

TEST(CandidatePool, CountsWhatWasTriedAndWhatStoodInTheWay) {
  const CandidatePool pool = find_candidates(demo_problem());
  const auto counts = counts_by_face(pool);
  for (const FaceEffort& effort : pool.efforts) {
    int refused = 0;
    for (const Obstruction& obstruction : effort.obstructions) refused += obstruction.count;
    EXPECT_EQ(effort.feasible, counts.at(effort.face));
    EXPECT_EQ(effort.tried, effort.feasible + refused);
    EXPECT_TRUE(std::ranges::is_sorted(effort.obstructions, std::ranges::greater{}, &Obstruction::count));
  }
}

TEST(CandidatePool, GivesTheOthersWhatAFaceCannotHave) {
  PlanningProblem problem = demo_problem();
  problem.requests = {{2, 5, 5, 0}, {3, 5, 5, 0}};
  problem.candidate_count = 100;
  problem.faces[2].center_m.y() -= 3.0;
  problem.faces[2].plane.offset_m += 3.0;
  const CandidatePool pool = find_candidates(problem);
  EXPECT_GE(counts_by_face(pool).at(3), problem.candidate_count);
  EXPECT_EQ(pool.efforts[0].feasible, 0);
  ASSERT_FALSE(pool.efforts[0].obstructions.empty());
  EXPECT_EQ(pool.efforts[0].obstructions[0].reason, "out of reach");
}

TEST(CandidatePool, NamesTheJointThatSlidesAndNotTheReach) {
  PlanningProblem problem = demo_problem();
  problem.requests = {{2, 5, 5, 0}};
  problem.candidate_count = 10;
  problem.nominal.joint_types[2] = JointType::kPrismatic;
  const CandidatePool pool = find_candidates(problem);
  ASSERT_EQ(pool.efforts[0].obstructions.size(), 1U);
  EXPECT_EQ(pool.efforts[0].obstructions[0].reason,
            "joint 3 is prismatic, postures are found for six revolute joints only");
}

/// The first posture that is clear of everything, to park in.
JointVector clear_posture(const PlanningProblem& problem) {
  for (int i = 1;; ++i) {
    const JointVector joints = halton_posture(i, problem.joint_ranges);
    const Chain chain = forward_chain(problem.nominal, joints);
    if (!find_clash(travel_scene(problem), chain, problem.nominal_position_error_m)) return joints;
  }
}

void expect_touches_of(const KinematicModel& arm) {
  PlanningProblem problem = demo_problem();
  problem.candidate_count = 100;
  problem.nominal = arm;
  problem.park_joints = clear_posture(problem);
  const CandidatePool pool = find_candidates(problem);
  EXPECT_GE(std::ssize(pool.candidates), problem.candidate_count);
  for (const TouchCandidate& candidate : pool.candidates) {
    const Eigen::Isometry3d reached = forward_kinematics(problem.nominal, candidate.joints);
    EXPECT_LT((reached.matrix() - candidate.pose.block_from_tip.matrix()).norm(), 2 * kPoseErrorMax);
  }
}

TEST(CandidatePool, HasTouchesOfAnArmWithoutASphericalWrist) {
  KinematicModel offset_wrist = paper::nominal();
  offset_wrist.links[5].r_m = 0.05;
  offset_wrist.links[6].d_m = 0.03;
  expect_touches_of(offset_wrist);
}

// Two of the last three axes are parallel: those three alone are never able to turn the tip any way.
TEST(CandidatePool, HasTouchesOfAnArmWhoseLastAxesDoNotSpanAllTurns) {
  constexpr double kQuarterTurn = std::numbers::pi / 2.0;
  KinematicModel parallel = paper::nominal();
  parallel.links[3] = {.alpha_rad = kQuarterTurn, .d_m = 0.1};
  parallel.links[4] = {.d_m = 0.4};
  parallel.links[5] = {.d_m = 0.4};
  expect_touches_of(parallel);
}

TEST(CandidatePool, IsTheSameForTheSameSeedAndAnotherForAnother) {
  PlanningProblem problem = demo_problem();
  problem.candidate_count = 100;
  const auto joints_of = [](const CandidatePool& pool) {
    std::vector<JointVector> joints;
    for (const TouchCandidate& candidate : pool.candidates) joints.push_back(candidate.joints);
    return joints;
  };
  const auto first = joints_of(find_candidates(problem));
  EXPECT_EQ(joints_of(find_candidates(problem)), first);
  problem.seed += 1;
  EXPECT_NE(joints_of(find_candidates(problem)), first);
}

TEST(CandidatePool, ReportsHowFarItIs) {
  std::vector<double> shares;
  find_candidates(demo_problem(), [&](std::string_view, double share) { shares.push_back(share); });
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GE(shares.front(), 0.0);
  EXPECT_LE(shares.back(), 1.0);
}

TEST(CandidatePool, RefusesAFaceThatDoesNotExist) {
  PlanningProblem problem = demo_problem();
  problem.requests = {{5, 1, 1, 0}};
  EXPECT_THROW(find_candidates(problem), std::logic_error);
}

}  // namespace
}  // namespace calib
