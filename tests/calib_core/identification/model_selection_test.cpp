#include "calib_core/identification/model_selection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr double kStdHarmonicRad = 50e-6;

TEST(NestedTest, IsFishersFOfTheResiduals) {
  // Two more parameters, ten degrees of freedom left, F = 3: P = (1 + 2 * 3 / 10)^-5 exactly.
  const ResidualSum smaller{20, 16.0, 8.0, 8.0}, larger{20, 10.0, 10.0, 10.0};
  const auto test = test_nested(smaller, larger);
  ASSERT_TRUE(test);
  EXPECT_DOUBLE_EQ(test->f, 3.0);
  EXPECT_NEAR(test->p, 0.095367431640625, 1e-12);
}

TEST(NestedTest, NeedsAParameterMoreAndADegreeOfFreedom) {
  EXPECT_FALSE(test_nested({20, 16.0, 8.0, 8.0}, {20, 16.0, 8.0, 8.0}));
  EXPECT_FALSE(test_nested({20, 16.0, 8.0, 8.0}, {20, 16.0, 20.0, 20.0}));
}

/// An arm whose joint 2 has a mass to carry, with even gears or eccentric ones.
IdentificationProblem problem_with_harmonics(double eccentricity_rad, int touch_count) {
  IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(5));
  problem.nominal.masses[4] = {20.0, {0.0, 0.0, -0.25}};
  problem.nongeometric_std[static_cast<std::size_t>(compliance_position(1))] = 1e-6;
  for (int i = harmonic_position(0); i < mass_position(1); ++i)
    problem.nongeometric_std[static_cast<std::size_t>(i)] = kStdHarmonicRad;
  UniformChance chance(5);
  drawn::Truth truth = drawn::draw_truth(problem, chance);
  for (CosSin& harmonic : truth.arm.harmonics_rad) harmonic = {eccentricity_rad, -eccentricity_rad};
  problem.touches = drawn::touches(truth, {.count = touch_count}, chance);
  return problem;
}

IdentificationResult identified(double eccentricity_rad, int touch_count) {
  return identify(problem_with_harmonics(eccentricity_rad, touch_count),
                  {.stiffness = true, .harmonics = Harmonics::kWhenShown});
}

TEST(Harmonics, AreTakenWhereTheTouchesShowThem) {
  const IdentificationResult result = identified(3.0 * kStdHarmonicRad, 100);
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.nongeometric.size(), 1U + 2U * kJointCount);
  EXPECT_THAT(result.model_reason, testing::HasSubstr("taken"));
  EXPECT_NEAR(result.calibrated.harmonics_rad[2].cos, 3.0 * kStdHarmonicRad, 2.0 * kStdHarmonicRad);
}

TEST(Harmonics, AreLeftOutOfEvenGearsAndTheResultSaysSo) {
  const IdentificationResult result = identified(0.0, 100);
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.nongeometric, std::vector<int>{compliance_position(1)});
  EXPECT_THAT(result.model_reason, testing::HasSubstr("left out"));
}

TEST(Harmonics, AreNotTriedWithFewTouches) {
  const IdentificationResult result = identified(3.0 * kStdHarmonicRad, kHarmonicTouchesMin - 1);
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.nongeometric, std::vector<int>{compliance_position(1)});
  EXPECT_EQ(result.model_reason, "");
}

TEST(Harmonics, AreNotTriedWithoutTheComplianceWhoseDroopTheyWouldTakeUp) {
  const IdentificationProblem problem = problem_with_harmonics(3.0 * kStdHarmonicRad, 100);
  EXPECT_TRUE(identify(problem, {.harmonics = Harmonics::kWhenShown}).nongeometric.empty());
}

TEST(Droop, OfMassesWithoutAComplianceIsWarnedOf) {
  const auto warning = testing::Contains(testing::HasSubstr("std_compliance_rad_per_nm"));
  IdentificationProblem problem = problem_with_harmonics(0.0, 60);
  EXPECT_THAT(identify(problem, {}).warnings, testing::Not(warning));
  problem.nongeometric_std = {};
  EXPECT_THAT(identify(problem, {}).warnings, warning);
}

}  // namespace
}  // namespace calib
