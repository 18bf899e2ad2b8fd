#include "service/run/reference_drift.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/numerics/uniform_chance.hpp"

namespace cell {
namespace {

TEST(ReferenceDrift, IsTheLineThroughTheReadings) {
  EXPECT_NEAR(reference_place({0.0, 1e-5, 2e-5, 3e-5}).trend_m, 3e-5, 1e-15);
  EXPECT_NEAR(reference_place({0.0, -1e-5, -2e-5}).trend_m, 2e-5, 1e-15);
}

TEST(ReferenceDrift, IsNothingOfTooFewReadings) {
  EXPECT_EQ(reference_place({}).trend_m, 0.0);
  EXPECT_EQ(reference_place({0.0, 1e-4}).trend_m, 0.0) << "two readings cannot tell drift from noise";
}

/// Mean square of the trend over many runs with this drift and noise.
double mean_square(double drift_m, double noise_m) {
  calib::UniformChance chance(11);
  constexpr int kReadings = 16, kRuns = 400;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> readings_m;
    for (int i = 0; i < kReadings; ++i)
      readings_m.push_back(drift_m * i / (kReadings - 1) + noise_m * std::sqrt(12.0) * (chance() - 0.5));
    for (std::size_t i = readings_m.size(); i-- > 0;) readings_m[i] -= readings_m[0];
    sum += std::pow(reference_place(readings_m).trend_m, 2);
  }
  return sum / kRuns;
}

TEST(ReferenceDrift, DoesNotTakeTheNoiseOfTheReadingsForDrift) {
  constexpr double kNoiseM = 20e-6;
  EXPECT_LT(std::sqrt(mean_square(0.0, kNoiseM)), 0.2 * kNoiseM) << "its line alone would have 0.8";
  EXPECT_NEAR(std::sqrt(mean_square(100e-6, kNoiseM)), 100e-6, 5e-6);
}

}  // namespace
}  // namespace cell
