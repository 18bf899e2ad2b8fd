#include "calib_core/estimation/gear_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <numeric>

namespace calib {
namespace {

constexpr int kTouchCount = 120;

std::vector<std::size_t> every_touch_of(const IdentificationProblem& problem) {
  std::vector<std::size_t> touches(problem.touches.size());
  std::iota(touches.begin(), touches.end(), std::size_t{0});
  return touches;
}

/// Touches whose joints turn evenly through so many degrees, each in an order of its own.
IdentificationProblem turned_through(double degrees) {
  IdentificationProblem problem;
  problem.nongeometric_std.fill(1e-5);
  problem.nominal.ripple_periods_per_turn.fill(72.0);
  constexpr std::array kStrides{7, 11, 13, 17, 19, 23};  // through all of them
  for (int i = 0; i < kTouchCount; ++i) {
    JointVector joints;
    for (int joint = 0; joint < kJointCount; ++joint)
      joints[joint] = i * kStrides[static_cast<std::size_t>(joint)] % kTouchCount / (kTouchCount - 1.0);
    problem.touches.push_back({.joints = radians_from_degrees(degrees) * joints});
  }
  return problem;
}

TEST(ShownHarmonics, AreThoseOfJointsThatTurnFarEnough) {
  const IdentificationProblem problem = turned_through(60.0);
  const GearColumns shown = shown_harmonics(problem, every_touch_of(problem));
  EXPECT_EQ(shown.positions.size(), 2U * kJointCount);
  EXPECT_EQ(shown.positions.front(), harmonic_position(0));
  EXPECT_EQ(shown.held, "");
}

TEST(ShownHarmonics, OfAJointThatHardlyTurnsAreHeldAndNamedWithItsTurn) {
  IdentificationProblem problem = turned_through(60.0);
  for (Touch& touch : problem.touches) touch.joints[2] /= 3.0;
  const GearColumns shown = shown_harmonics(problem, every_touch_of(problem));
  EXPECT_EQ(shown.positions.size(), 2U * kJointCount - 2U);
  EXPECT_THAT(shown.positions, testing::Not(testing::Contains(harmonic_position(2))));
  EXPECT_EQ(shown.held, "joint 3 (20 degrees)");
}

TEST(ShownHarmonics, CountTheTurnOfTheJointAndNotOfItsDrive) {
  IdentificationProblem problem = turned_through(60.0);
  problem.nominal.gains[4] = -0.1;
  EXPECT_EQ(shown_harmonics(problem, every_touch_of(problem)).held, "joint 5 (6 degrees)");
}

TEST(ShownHarmonics, OfAJointWithoutADeviationAreNeitherTriedNorHeld) {
  IdentificationProblem problem = turned_through(10.0);
  problem.nongeometric_std = {};
  const GearColumns shown = shown_harmonics(problem, every_touch_of(problem));
  EXPECT_TRUE(shown.positions.empty());
  EXPECT_EQ(shown.held, "");
}

TEST(ShownRipples, AreThoseOfJointsThatTurnThroughAPeriod) {
  IdentificationProblem problem = turned_through(20.0);
  problem.nominal.ripple_periods_per_turn = {118.0, 0.0, 17.0, 72.0, 60.0, 48.0};
  const GearColumns shown = shown_ripples(problem, every_touch_of(problem));
  EXPECT_EQ(shown.positions,
            (std::vector<int>{ripple_position(0), ripple_position(0) + 1, ripple_position(3),
                              ripple_position(3) + 1, ripple_position(4), ripple_position(4) + 1,
                              ripple_position(5), ripple_position(5) + 1}));
  EXPECT_EQ(shown.held, "joint 3 (20 degrees)") << "a period of 21 degrees";
}

TEST(ShownRipples, OfAJointThatGoesByWholePeriodsLookLikeItsOffset) {
  IdentificationProblem problem = turned_through(60.0);
  for (std::size_t i = 0; i < problem.touches.size(); ++i)
    problem.touches[i].joints[1] = 2.0 * std::numbers::pi / 72.0 * static_cast<double>(i % 12);
  EXPECT_EQ(shown_ripples(problem, every_touch_of(problem)).held, "joint 2 (60 degrees)");
}

TEST(ShownRipples, OfOnePeriodATurnLookLikeTheFirstHarmonic) {
  IdentificationProblem problem = turned_through(400.0);
  problem.nominal.ripple_periods_per_turn = {1.0, 72.0, 72.0, 72.0, 72.0, 72.0};
  EXPECT_THAT(shown_ripples(problem, every_touch_of(problem)).held, testing::StartsWith("joint 1"));
}

}  // namespace
}  // namespace calib
