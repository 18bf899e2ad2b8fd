#include "calib_core/qualification/qualification_planning.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/qualification/turned_touches.hpp"
#include "tests/calib_core/qualification/qualified_cell.hpp"

namespace calib {
namespace {

using ::testing::HasSubstr;

TEST(QualificationPlanning, TurnsTheStylusAtOnePlaceAndComesBackTenTimes) {
  const std::vector<Touch> touches = qualified::planned_touches();
  const TurnedTouches turned = turned_touches(paper::nominal(), qualified::surfaces(), touches);
  EXPECT_EQ(turned.directions, kTurnCount);
  EXPECT_EQ(std::ssize(turned.repeats), kRepeatCount);
  EXPECT_EQ(std::ssize(turned.all), kRepeatCount + kTurnCount - 1);
  for (const std::size_t i : turned.all) {
    // The axis of joint 6 goes through the ball: nothing else has to move.
    const JointVector moved = touches[i].joints - touches[turned.all.front()].joints;
    EXPECT_LT(moved.head<kJointCount - 1>().cwiseAbs().maxCoeff(), 1e-6) << i;
  }
}

TEST(QualificationPlanning, EveryTouchOfATurnIsMadeAnew) {
  const std::vector<Touch> touches = qualified::planned_touches();
  int in_a_row = 0, most = 0;
  for (std::size_t i = 1; i < touches.size(); ++i) {
    const bool is_same = touches[i].joints == touches[i - 1].joints;
    in_a_row = is_same ? in_a_row + 1 : 0;
    most = std::max(most, in_a_row);
  }
  EXPECT_LE(most, kRepeatCount - kTurnCount) << "only what is left after the last turn";
}

TEST(QualificationPlanning, TouchesTheKnownLengthsInPosturesThatAreAlike) {
  const std::vector<Touch> touches = qualified::planned_touches();
  const TurnedTouches turned = turned_touches(paper::nominal(), qualified::surfaces(), touches);
  std::vector<Touch> others;
  for (std::size_t i = 0; i < touches.size(); ++i)
    if (std::ranges::find(turned.all, i) == turned.all.end()) others.push_back(touches[i]);
  ASSERT_EQ(others.size(), 2 * kStepTouches * qualified::kLengths.size());
  for (std::size_t i = 0; i < others.size(); i += 2) {
    const KnownLength& length = qualified::kLengths[i / (2 * kStepTouches)];
    EXPECT_EQ(others[i].face, length.faces[0]);
    EXPECT_EQ(others[i + 1].face, length.faces[1]);
    const Eigen::Matrix3d between =
        forward_kinematics(paper::nominal(), others[i].joints).linear().transpose() *
        forward_kinematics(paper::nominal(), others[i + 1].joints).linear();
    // A stylus that leans by 70 degrees at most turns by 40 at least from one side to the opposite one.
    const bool is_step_up = length.faces == qualified::kLengths.front().faces;
    EXPECT_LT(Eigen::AngleAxisd(between).angle(), radians_from_degrees(is_step_up ? 20.0 : 70.0)) << i;
  }
}

TEST(QualificationPlanning, FailsWithTheBestThereWasWhereTheStylusMayNotLean) {
  PlanningProblem upright = qualified::planning_problem();
  upright.tilt_max_rad = 0.9 * kQualifyingLeanMinRadians;
  const auto outcome = plan_qualification(upright, qualified::kLengths);
  const auto& failure = std::get<PlanningFailure>(outcome);
  EXPECT_EQ(failure.found, 0);
  EXPECT_EQ(failure.wanted, kTurnCount);
  EXPECT_FALSE(failure.efforts.empty());
}

std::string refusal_of(const PlanningProblem& problem) {
  const auto outcome = plan_qualification(problem, qualified::kLengths);
  const auto* failure = std::get_if<PlanningFailure>(&outcome);
  return failure ? failure->reason : "";
}

TEST(QualificationPlanning, IsRefusedWhereTurningWouldMoveTheWholeArm) {
  PlanningProblem beside = qualified::planning_problem();
  // They would move with the ball, into the forearm.
  std::erase_if(beside.scene.bodies, [](const Capsule& body) { return body.frame == kFrameCount - 1; });
  beside.nominal = apply(beside.nominal, qualified::bent(6e-3));
  EXPECT_THAT(refusal_of(beside), HasSubstr("beside the axis of joint 6"));
  beside.nominal = apply(paper::nominal(), qualified::bent(0.5e-3));
  EXPECT_EQ(refusal_of(beside), "");
}

TEST(QualificationPlanning, IsRefusedAtOnceWithoutAClearParkPostureOrAFlatFace) {
  PlanningProblem problem = qualified::planning_problem();
  problem.requests.clear();
  EXPECT_THAT(refusal_of(problem), HasSubstr("the block has none"));
  problem = qualified::planning_problem();
  problem.park_joints = qualified::planned_touches().front().joints;
  EXPECT_THAT(refusal_of(problem), HasSubstr("in the park posture"));
}

}  // namespace
}  // namespace calib
