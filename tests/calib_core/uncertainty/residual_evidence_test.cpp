#include "calib_core/uncertainty/residual_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr double kGearVariance = 1e-10;  // 10 um squared
constexpr double kCompliance = 3e-7;     // one standard deviation, rad/Nm

TEST(GearShare, FollowsWhatTheResidualsHaveBeyondTheRepeats) {
  const auto share = [](double residuals_um, double repeats_um) {
    return mean_gear_share({{1e-6 * residuals_um, 100.0}, {1e-6 * repeats_um, 50.0}, kGearVariance});
  };
  EXPECT_LT(share(10.0, 10.0), 0.15) << "repeats explain all";
  EXPECT_NEAR(share(std::sqrt(125.0), 5.0), 1.0, 0.15) << "just the maker's";
  EXPECT_GT(share(std::sqrt(325.0), 5.0), 2.5) << "worn: three times the variance";
  EXPECT_LT(share(5.0, 5.0), share(8.0, 5.0));
}

TEST(GearShare, IsTheMakersWhereNothingIsKnown) {
  EXPECT_NEAR(mean_gear_share({{1e-5, 0.0}, {1e-5, 0.0}, kGearVariance}), 1.0, 0.02);
  EXPECT_EQ(mean_gear_share({{1e-5, 30.0}, {1e-5, 5.0}, 0.0}), 1.0);
}

TEST(GearShare, IsLimitedByTheResidualsAlone) {
  EXPECT_LT(mean_gear_share({{5e-6, 60.0}, {0.0, 0.0}, kGearVariance}), 0.3);
}

struct Held {
  IdentificationProblem problem;
  IdentificationOptions options{.robust = false, .hold_weak = false};
};

/// Touches of an arm that droops by `sigmas` of its compliances' deviations, which is not estimated.
Held drooping(double sigmas, double noise_m, UniformChance& chance) {
  Held held{drawn::problem(drawn::certain_artefact(5), noise_m)};
  held.problem.nominal.masses[3] = {30.0, {0.2, 0.0, 0.1}};
  held.problem.nominal.masses[6] = {10.0, {0.0, 0.0, 0.1}};
  for (const int joint : {1, 2})
    held.problem.nongeometric_std[static_cast<std::size_t>(compliance_position(joint))] = kCompliance;
  drawn::Truth truth = drawn::draw_truth(held.problem, chance);
  for (const int joint : {1, 2})
    truth.arm.compliance_rad_per_nm[static_cast<std::size_t>(joint)] += sigmas * kCompliance;
  held.problem.touches = drawn::touches(truth, {.count = 100, .noise_m = noise_m}, chance);
  return held;
}

struct Alarms {
  double share = 0.0;  // of the runs in which the test for a droop gave less than the level
  double told = 0.0;   // the mean of the power
};

Alarms alarms_of(double sigmas, double noise_m, double level) {
  constexpr int kRuns = 200;
  int alarms = 0, made = 0;
  double told = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    const Held held = drooping(sigmas, noise_m, chance);
    const IdentificationResult result = identify(held.problem, held.options);
    if (result.status == IdentificationStatus::kFarTouch) continue;  // a drawn arm too far off to be touched
    EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    ++made;
    const DroopTest& droop = result.lack_of_fit.value().droop.value();
    alarms += droop.p < level ? 1 : 0;
    told += droop.power(level);
  }
  EXPECT_GT(made, 190);
  return {static_cast<double>(alarms) / made, told / made};
}

// The power that is told, against how often the test really alarms.
TEST(DroopPower, IsHowOftenTheTestFindsIt) {
  const Alarms found = alarms_of(1.0, 20e-6, 0.05);
  EXPECT_GT(found.told, 0.1) << "else the test shows nothing";
  EXPECT_LT(found.told, 0.95);
  EXPECT_NEAR(found.share, found.told, 0.1);
}

TEST(DroopPower, WithoutDroopTheTestAlarmsAsOftenAsItsLevelSays) {
  EXPECT_NEAR(alarms_of(0.0, 20e-6, 0.05).share, 0.05, 0.035);
}

// The test of all residuals takes such a droop for the declared noise of 10 um.
TEST(DroopTest, FindsWhatTheTestOfAllResidualsOverlooks) {
  UniformChance chance(3);
  Held held = drooping(3.0, 10e-6, chance);
  const IdentificationResult left_out = identify(held.problem, held.options);
  EXPECT_LT(left_out.lack_of_fit->droop.value().p, kDroopShownP);
  ASSERT_FALSE(left_out.warnings.empty());
  EXPECT_NE(left_out.warnings.front().find("look like a droop"), std::string::npos);
  held.options.stiffness = true;
  const IdentificationResult estimated = identify(held.problem, held.options);
  EXPECT_FALSE(estimated.lack_of_fit->droop);
  EXPECT_TRUE(estimated.warnings.empty()) << estimated.warnings.front();
}

TEST(LackOfFit, IsTestedAgainstRepeatsWhereThereAreSome) {
  UniformChance chance(7);
  Held held = drooping(0.0, 10e-6, chance);
  held.problem.touch_noise_m = 30e-6;  // too large: it hides the misfit
  const IdentificationResult hidden = identify(held.problem, held.options);
  EXPECT_FALSE(hidden.lack_of_fit->is_f_test());
  EXPECT_GT(hidden.lack_of_fit->p, 0.99);
  EXPECT_TRUE(hidden.is_declared_noise_too_large);
  EXPECT_FALSE(hidden.warnings.empty());
  IdentificationOptions as_declared = held.options;
  as_declared.measure_noise = false;  // as for the touches of a plan
  EXPECT_TRUE(identify(held.problem, as_declared).warnings.empty());
  held.problem.pure_error = TouchNoise{3e-6, 200.0};
  const IdentificationResult shown = identify(held.problem, held.options);
  EXPECT_TRUE(shown.lack_of_fit->is_f_test());
  EXPECT_LT(shown.lack_of_fit->p, 1e-3);
}

}  // namespace
}  // namespace calib
