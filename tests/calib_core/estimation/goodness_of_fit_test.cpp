#include "calib_core/estimation/goodness_of_fit.hpp"

#include <gtest/gtest.h>

#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr double kDeclaredMetres = 20e-6;
constexpr int kSeeds = 40;

/// Mean variance of a touch that is measured, in units of the declared one.
double measured_variance(double noise_m, int touch_count) {
  double sum = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(5), kDeclaredMetres);
    const drawn::Truth truth = drawn::draw_truth(problem, chance);
    problem.touches = drawn::touches(truth, {.count = touch_count, .noise_m = noise_m}, chance);
    const IdentificationResult result = identify(problem, {.robust = false, .hold_weak = false});
    EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    const double degrees = result.residual_sum.noise_degrees();
    const double ratio = result.uncertainty->noise_m / kDeclaredMetres;
    // Without the share of the declared noise.
    sum += (ratio * ratio * (degrees + kDeclaredNoiseDegrees) - kDeclaredNoiseDegrees) / degrees;
    EXPECT_DOUBLE_EQ(result.uncertainty->degrees_of_freedom, degrees + kDeclaredNoiseDegrees);
  }
  return sum / kSeeds;
}

// 40 seeds of about 60 degrees of freedom: the mean of the variance scatters by 3 %.
TEST(MeasuredNoise, IsThatOfTheTouchesWhateverIsDeclaredAndHoweverUncertainTheArtefactIs) {
  // Below 9 um the parameters that touches do not show count: to second order they are worth 2 um.
  for (const double noise_m : {9e-6, 20e-6, 60e-6}) {
    const double expected = noise_m * noise_m / (kDeclaredMetres * kDeclaredMetres);
    EXPECT_NEAR(measured_variance(noise_m, 100), expected, 0.12 * expected + 0.002) << noise_m;
  }
}

TEST(MeasuredNoise, IsTheDeclaredOneWhereNoResidualIsLeft) {
  const TouchNoise noise = measured_noise(kDeclaredMetres, {25, 0.0, 25.0, 25.0}, kDeclaredMetres);
  EXPECT_EQ(noise.std_m, kDeclaredMetres);
  EXPECT_EQ(noise.degrees_of_freedom, kDeclaredNoiseDegrees);
}

}  // namespace
}  // namespace calib
