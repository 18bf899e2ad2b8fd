#include "service/offline_programs/predicted_error.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(PredictedError, OfAPointMovedOnIsTheComputedFigureAndLinearBetween) {
  EXPECT_DOUBLE_EQ(carried_error_um(0), 0);
  EXPECT_DOUBLE_EQ(carried_error_um(5), 19);
  EXPECT_DOUBLE_EQ(carried_error_um(10), 38);
  EXPECT_DOUBLE_EQ(carried_error_um(20), 75);
  EXPECT_DOUBLE_EQ(carried_error_um(50), 185);
  EXPECT_DOUBLE_EQ(carried_error_um(75), 277.5);
  EXPECT_DOUBLE_EQ(carried_error_um(100), 370);
  EXPECT_DOUBLE_EQ(carried_error_um(200), 200 * kCarriedErrorUmPerMm);
}

TEST(PredictedError, OfALineIsTheComputedFigureAndGrowsAboutAsTheSquare) {
  EXPECT_DOUBLE_EQ(line_deviation(0).median_um, 0);
  EXPECT_DOUBLE_EQ(line_deviation(20).median_um, 0.6);
  EXPECT_DOUBLE_EQ(line_deviation(50).one_in_twenty_um, 20);
  EXPECT_DOUBLE_EQ(line_deviation(100).median_um, 15);
  EXPECT_DOUBLE_EQ(line_deviation(400).median_um, 203);
  EXPECT_DOUBLE_EQ(line_deviation(800).median_um, 4 * 203);
  EXPECT_NEAR(line_deviation(150).median_um, 0.25 * 9 * 15, 2.0);
  for (double length = 1; length < 1000; length += 1) {
    EXPECT_GT(line_deviation(length + 1).median_um, line_deviation(length).median_um) << length;
    EXPECT_GT(line_deviation(length).one_in_twenty_um, line_deviation(length).median_um) << length;
  }
  EXPECT_LE(line_deviation(kStraightLineMaxMm).one_in_twenty_um, 1e3 * kLineDeviationMaxMm)
      << "what the remedy promises";
}

TEST(PredictedError, ALineIsHeldByAPointEvery50Millimetres) {
  EXPECT_EQ(points_between(0), 0);
  EXPECT_EQ(points_between(50), 0);
  EXPECT_EQ(points_between(50.1), 1);
  EXPECT_EQ(points_between(100), 1);
  EXPECT_EQ(points_between(400), 7);
}

}  // namespace
}  // namespace cell
