#include "calib_core/proof/control_chart.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/calib_core/block_study.hpp"

namespace calib {
namespace {

std::vector<ChartedValue> quiet_values(std::size_t count, UniformChance& chance) {
  std::vector<ChartedValue> values;
  while (values.size() < count) values.push_back({3.0 + 0.5 * study::normal(chance)});
  return values;
}

TEST(ControlChart, HasNoLimitsUntilItsBaseIsWhole) {
  UniformChance chance(1);
  const auto points = control_chart(quiet_values(kChartBaseCount, chance));
  ASSERT_EQ(points.size(), static_cast<std::size_t>(kChartBaseCount));
  for (const ChartPoint& point : points) {
    EXPECT_FALSE(point.standardised);
    EXPECT_FALSE(point.is_beyond_shewhart || point.is_beyond_ewma);
  }
}

TEST(ControlChart, SeesALargeStepAtOnce) {
  UniformChance chance(2);
  std::vector<ChartedValue> values = quiet_values(kChartBaseCount + 1, chance);
  values.back().value += 10.0;
  const ChartPoint last = control_chart(values).back();
  EXPECT_TRUE(last.is_beyond_shewhart);
  EXPECT_GT(last.standardised.value(), 10.0);
  EXPECT_GT(std::abs(last.value - last.centre.value()), last.shewhart_limit.value());
}

TEST(ControlChart, SeesACreepByItsWeightedMeanBeforeOneValueIsStriking) {
  UniformChance chance(3);
  std::vector<ChartedValue> values = quiet_values(kChartBaseCount, chance);
  for (int check = 1; check <= 60; ++check) values.push_back({3.0 + 0.03 * check});
  const auto points = control_chart(values);
  const auto by_mean = std::ranges::find(points, true, &ChartPoint::is_beyond_ewma);
  const auto by_value = std::ranges::find(points, true, &ChartPoint::is_beyond_shewhart);
  ASSERT_NE(by_mean, points.end());
  EXPECT_LT(by_mean, by_value);
}

TEST(ControlChart, AlarmsOfTheFirstCheckAfterItsBaseAsSeldomAsKnownDeviationsWould) {
  constexpr int kCharts = 20'000;
  constexpr double kShare = 0.0027, kOff = 0.0012;  // three standard deviations of so many charts
  UniformChance chance(4);
  int alarms = 0;
  for (int chart = 0; chart < kCharts; ++chart)
    alarms += control_chart(quiet_values(kChartBaseCount + 1, chance)).back().is_beyond_shewhart ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(alarms) / kCharts, kShare, kOff);
}

TEST(ControlChart, OfABaseThatDoesNotVaryAlarmsOfNothing) {
  std::vector<ChartedValue> values(kChartBaseCount, {1.0});
  values.push_back({2.0});
  EXPECT_FALSE(control_chart(values).back().is_beyond_shewhart);
}

TEST(ControlChart, AValueThatDoesNotCountMovesNeitherTheLimitsNorTheWeightedMean) {
  UniformChance chance(5);
  const std::vector<ChartedValue> quiet = quiet_values(kChartBaseCount + 2, chance);
  std::vector<ChartedValue> values = quiet;
  values.insert(values.end() - 1, {100.0, false});
  values.insert(values.begin() + 3, {100.0, false});
  const auto points = control_chart(values), without = control_chart(quiet);
  EXPECT_FALSE(points[3].shewhart_limit) << "the base is not whole";
  const ChartPoint& apart = points[points.size() - 2];
  EXPECT_TRUE(apart.is_beyond_shewhart);
  EXPECT_FALSE(apart.mean || apart.ewma_limit || apart.is_beyond_ewma);
  EXPECT_DOUBLE_EQ(points.back().mean.value(), without.back().mean.value());
  EXPECT_DOUBLE_EQ(points.back().ewma_limit.value(), without.back().ewma_limit.value());
  EXPECT_DOUBLE_EQ(points.back().centre.value(), without.back().centre.value());
}

TEST(ControlChart, IsRefusedABaseOfOne) {
  EXPECT_THROW(control_chart(std::vector<ChartedValue>{{1.0}, {2.0}}, 1), std::logic_error);
}

}  // namespace
}  // namespace calib
