#include "calib_core/estimation/pure_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace calib {
namespace {

// Readings 1, 2, 2, 5 at 0, 1, 2, 3: slope 1.2, intercept 0.7, squares about the line 0.09 + 0.01 + 1.21 +
// 0.49 = 1.8, which are R's lm() figures.
TEST(PureError, IsTheScatterAboutTheLineOfTheDrift) {
  const auto line = line_through(std::vector<double>{1.0, 2.0, 2.0, 5.0});
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->slope, 1.2, 1e-12);
  EXPECT_NEAR(line->scatter.std_m, std::sqrt(1.8 / 2.0), 1e-12);
  EXPECT_EQ(line->scatter.degrees_of_freedom, 2.0);
  EXPECT_NEAR(line->variance_of_slope, 0.9 / 5.0, 1e-12);
}

// Readings 0, 1, 4 at 0, 1, 4 s lie on a line over their times and not over their order.
TEST(PureError, TheLineRunsOverTheTimesWhereTheyAreKnown) {
  const std::vector<double> readings{0.0, 1.0, 4.0};
  const auto over_time = line_through(readings, std::vector<double>{0.0, 1.0, 4.0});
  ASSERT_TRUE(over_time);
  EXPECT_NEAR(over_time->slope, 1.0, 1e-12);
  EXPECT_EQ(over_time->span, 4.0);
  EXPECT_NEAR(over_time->scatter.std_m, 0.0, 1e-12);
  const auto over_order = line_through(readings);
  EXPECT_EQ(over_order->span, 2.0);
  EXPECT_GT(over_order->scatter.std_m, 0.3);
  for (const std::vector<double>& useless :
       {std::vector{0.0, 1.0}, std::vector{5.0, 5.0, 5.0}, std::vector{0.0, 1e-300, 2e-300}})
    EXPECT_EQ(line_through(readings, useless)->slope, over_order->slope);
}

TEST(PureError, NeedsThreeReadings) { EXPECT_FALSE(line_through(std::vector<double>{1.0, 2.0})); }

std::vector<Touch> at_place(const std::vector<double>& first_joints) {
  std::vector<Touch> touches;
  for (const double joint : first_joints) {
    touches.emplace_back();
    touches.back().joints[0] = joint;
  }
  return touches;
}

TEST(CountedReadings, AreAllOfThemWhereAnEncodersStepMakesSomeAlike) {
  EXPECT_EQ(counted_readings(at_place({1.0, 2.0, 1.0, 2.0})).size(), 4U);
  EXPECT_TRUE(counted_readings({}).empty());
}

TEST(CountedReadings, AreCopiesAlsoWhereTheyDifferByLessThanAnEncoderReads) {
  EXPECT_EQ(counted_readings(at_place({1.0, 1.0 + 1e-9, 1.0 - 2e-9, 1.0 + 3e-9})).size(), 1U);
}

TEST(CountedReadings, CountCopiesOnce) {
  const std::vector<Touch> counted = counted_readings(at_place({2.0, 1.0, 1.0, 2.0, 1.0}));
  ASSERT_EQ(counted.size(), 2U);
  EXPECT_EQ(counted[0].joints[0], 2.0);
  EXPECT_EQ(counted[1].joints[0], 1.0);
}

TEST(PureError, IsPooledByDegreesOfFreedom) {
  const TouchNoise both = pooled({3.0, 1.0}, {1.0, 3.0});
  EXPECT_NEAR(both.std_m, std::sqrt((9.0 + 3.0) / 4.0), 1e-12);
  EXPECT_EQ(both.degrees_of_freedom, 4.0);
  EXPECT_EQ(pooled({3.0, 0.0}, {1.0, 0.0}).degrees_of_freedom, 0.0);
}

// R: qchisq(0.001, c(1, 4, 9)) is 1.570797e-06, 0.09080404, 1.151950.
TEST(PureError, IsDoubtedWhereChanceMakesItSoSmallInOneOfAThousandRuns) {
  for (const auto& [degrees, quantile] : {std::pair{1.0, 1.570797e-06}, {4.0, 0.09080404}, {9.0, 1.151950}}) {
    const double limit_m = 2e-6 * std::sqrt(quantile / degrees);
    EXPECT_TRUE(is_implausibly_small({0.999 * limit_m, degrees}, 2e-6));
    EXPECT_FALSE(is_implausibly_small({1.001 * limit_m, degrees}, 2e-6));
  }
  EXPECT_TRUE(is_implausibly_small({0.0, 1.0}, kProbeScatterMinMetres));
  EXPECT_FALSE(is_implausibly_small({}, kProbeScatterMinMetres)) << "nothing is said";
}

}  // namespace
}  // namespace calib
