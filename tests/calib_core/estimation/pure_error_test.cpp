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

}  // namespace
}  // namespace calib
