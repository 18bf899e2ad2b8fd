#include "calib_core/identification/model_trial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/identification/model_selection.hpp"
#include "calib_core/identification/validate.hpp"
#include "calib_core/observability/observation_matrix.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr double kStdHarmonicRad = 50e-6;

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
  EXPECT_EQ(result.model_reason,
            "first harmonics of the joints not tried: 59 touches to fit are too few, it takes 60");
}

TEST(Harmonics, AreNotTriedWithoutTheComplianceWhoseDroopTheyWouldTakeUp) {
  const IdentificationProblem problem = problem_with_harmonics(3.0 * kStdHarmonicRad, 100);
  const IdentificationResult result = identify(problem, {.harmonics = Harmonics::kWhenShown});
  EXPECT_TRUE(result.nongeometric.empty());
  EXPECT_THAT(result.model_reason, testing::HasSubstr("no compliance is estimated"));
  EXPECT_EQ(identify(problem, {.harmonics = Harmonics::kLeaveOut}).model_reason, "");
}

/// Every joint but 1 and 6 within a few degrees of one posture.
std::vector<Touch> touches_about_one_posture(const IdentificationProblem& problem,
                                             const drawn::Truth& truth) {
  UniformChance chance(8);
  const Touch start = drawn::touches(truth, {.count = 1}, chance).front();
  std::vector<Touch> touches;
  while (touches.size() < 80) {
    Touch touch = start;
    for (int joint = 0; joint < kJointCount; ++joint) {
      const double half_rad = radians_from_degrees(joint == 0 || joint == 5 ? 40.0 : 7.0);
      touch.joints[joint] += half_rad * (2.0 * chance() - 1.0);
    }
    touch.face = static_cast<int>(touches.size() % problem.artefact.contact_planes.size());
    touch = moved_onto_plane(truth.arm, truth.planes[static_cast<std::size_t>(touch.face)], touch);
    touches.push_back(touch);
  }
  return touches;
}

TEST(Harmonics, OfJointsThatHardlyTurnAreHeldWithASentenceAndStayUncertain) {
  IdentificationProblem problem = problem_with_harmonics(0.0, 1);
  UniformChance chance(5);
  drawn::Truth truth = drawn::draw_truth(problem, chance);
  for (CosSin& harmonic : truth.arm.harmonics_rad) harmonic = {5e-4, -5e-4};
  const IdentificationOptions options{
      .robust = false, .prior = true, .stiffness = true, .harmonics = Harmonics::kWhenShown};
  problem.touches = drawn::touches(truth, {.count = 80}, chance);
  EXPECT_THAT(identify(problem, options).warnings,
              testing::Not(testing::Contains(testing::HasSubstr("std_harmonic_rad"))));
  problem.touches = touches_about_one_posture(problem, truth);
  const IdentificationResult result = identify(problem, options);
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_THAT(result.warnings,
              testing::Contains(testing::AllOf(
                  testing::ContainsRegex("joint 2 \\([0-9]+ degrees\\), joint 3 .*joint 4 .*joint 5 "),
                  testing::HasSubstr("/gears/std_harmonic_rad in the arm's file"),
                  testing::HasSubstr("spread the touches"))));
  EXPECT_THAT(result.model_reason, testing::HasSubstr("not tried: joint 2"));
  for (int joint = 1; joint < 5; ++joint) {
    EXPECT_EQ(result.calibrated.harmonics_rad[static_cast<std::size_t>(joint)].cos, 0.0);
    const int cosine = nongeometric_index(harmonic_position(joint));
    EXPECT_GT(result.uncertainty->std_error(cosine), 0.3 * kStdHarmonicRad);
  }
}

/// An arm of which joint 2 is off by this amplitude twice a turn, where the maker gives a figure for that.
IdentificationResult identified_oval(double amplitude_rad) {
  IdentificationProblem problem = problem_with_harmonics(0.0, 1);
  for (int i = second_harmonic_position(0); is_second_harmonic(i); ++i)
    problem.nongeometric_std[static_cast<std::size_t>(i)] = kStdHarmonicRad;
  UniformChance chance(5);
  drawn::Truth truth = drawn::draw_truth(problem, chance);
  truth.arm.second_harmonics_rad[1] = {amplitude_rad, -amplitude_rad};
  problem.touches = drawn::touches(truth, {.count = 100}, chance);
  return identify(problem, {.stiffness = true, .harmonics = Harmonics::kWhenShown});
}

TEST(SecondHarmonics, AreNotEstimatedAndWidenTheUncertaintyByWhatTheResidualsLeaveOfThem) {
  const IdentificationResult even = identified_oval(0.0), oval = identified_oval(3.0 * kStdHarmonicRad);
  ASSERT_EQ(even.status, IdentificationStatus::kConverged) << even.message;
  ASSERT_EQ(oval.status, IdentificationStatus::kConverged) << oval.message;
  const int cosine = nongeometric_index(second_harmonic_position(1));
  EXPECT_EQ(oval.errors[cosine], 0.0);
  EXPECT_LT(even.uncertainty->harmonic_shares.second, 0.1);
  EXPECT_GT(oval.uncertainty->harmonic_shares.second, 5.0 * even.uncertainty->harmonic_shares.second);
  EXPECT_NEAR(oval.uncertainty->std_error(cosine),
              std::sqrt(oval.uncertainty->harmonic_shares.second) * kStdHarmonicRad, 1e-9);
}

constexpr double kRippleRad = 40e-6;

/// An arm with eccentric gears or even ones, of which the maker's file has the periods; with their ripple.
IdentificationProblem problem_with_ripple(double amplitude_rad, int touch_count) {
  IdentificationProblem problem = problem_with_harmonics(0.0, 1);
  problem.nominal.ripple_periods_per_turn = {118.0, 118.0, 96.0, 72.0, 60.0, 48.0};
  problem.gear_std_rad.setConstant(kRippleRad / std::sqrt(2.0));
  for (int i = ripple_position(0); i < kNongeometricCount; ++i)
    problem.nongeometric_std[static_cast<std::size_t>(i)] = kRippleRad / std::sqrt(2.0);
  UniformChance chance(5);
  drawn::Truth truth = drawn::draw_truth(problem, chance);
  truth.arm.ripple_periods_per_turn = problem.nominal.ripple_periods_per_turn;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const double phase = static_cast<double>(joint);
    truth.arm.ripples_rad[joint] = {amplitude_rad * std::cos(phase), amplitude_rad * std::sin(phase)};
  }
  problem.touches = drawn::touches(truth, {.count = touch_count, .noise_m = 10e-6}, chance);
  return problem;
}

constexpr IdentificationOptions with_ripple() {
  return {.stiffness = true, .harmonics = Harmonics::kWhenShown, .ripple = Ripple::kWhenShown};
}

TEST(Ripple, AtKnownPeriodsIsTakenWhereTheTouchesShowItAndLeavesTheGearsToThat) {
  const IdentificationResult result = identify(problem_with_ripple(kRippleRad, 150), with_ripple());
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_THAT(result.model_reason, testing::HasSubstr("ripples of the gears taken"));
  EXPECT_THAT(result.nongeometric, testing::Contains(ripple_position(2)));
  for (const int joint : {1, 2, 3, 4}) {
    const auto index = static_cast<std::size_t>(joint);
    const int cosine = nongeometric_index(ripple_position(joint));
    const double std = result.uncertainty->std_error(cosine);
    EXPECT_LT(std, 0.5 * kRippleRad) << joint;
    EXPECT_NEAR(result.calibrated.ripples_rad[index].cos, kRippleRad * std::cos(joint), 4.0 * std) << joint;
    EXPECT_NEAR(result.errors[cosine], result.calibrated.ripples_rad[index].cos, 1e-18) << joint;
  }
  EXPECT_TRUE(result.uncertainty->of_posture.isZero(1e-20)) << "nothing else was said of the gears";
  EXPECT_NEAR(result.gear_variance_m2, 0.0, 1e-20);
}

TEST(Ripple, OfEvenGearsIsLeftOutAndCountedWithTheGears) {
  const IdentificationResult result = identify(problem_with_ripple(0.0, 150), with_ripple());
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_THAT(result.model_reason, testing::HasSubstr("ripples of the gears left out"));
  EXPECT_EQ(result.nongeometric, std::vector<int>{compliance_position(1)});
  EXPECT_GT(result.uncertainty->of_posture(theta_index(1), theta_index(1)), 0.0);
  EXPECT_EQ(result.uncertainty->held(nongeometric_index(ripple_position(1)),
                                     nongeometric_index(ripple_position(1))),
            0.0)
      << "it would count twice";
}

TEST(Ripple, IsNotTriedWithFewTouchesNorWithoutPeriodsNorWhereTheOptionsLeaveItOut) {
  IdentificationProblem problem = problem_with_ripple(kRippleRad, kRippleTouchesMin - 1);
  EXPECT_THAT(identify(problem, with_ripple()).model_reason,
              testing::HasSubstr("ripples of the gears not tried: 99 touches to fit are too few"));
  problem = problem_with_ripple(kRippleRad, kRippleTouchesMin);
  EXPECT_THAT(identify(problem, with_ripple()).model_reason, testing::HasSubstr("ripples"));
  problem.touches[40].joints[1] += 0.05;
  const IdentificationResult with_a_bad_one = identify(problem, with_ripple());
  EXPECT_THAT(with_a_bad_one.rejected, testing::SizeIs(1));
  EXPECT_THAT(with_a_bad_one.model_reason, testing::HasSubstr("ripples")) << "the plan has as many as before";
  problem.touches[40].joints[1] -= 0.05;
  EXPECT_THAT(identify(problem, {.stiffness = true}).nongeometric, testing::SizeIs(1));
  problem.nominal.ripple_periods_per_turn = {};
  EXPECT_THAT(identify(problem, with_ripple()).nongeometric,
              testing::Not(testing::Contains(testing::Truly(is_ripple))));
}

TEST(Validation, OfAModelThatTheHeldOutTouchesChoseFindsTheSameArmAgain) {
  IdentificationProblem problem = problem_with_ripple(kRippleRad, 150);
  for (std::size_t i = 0; i < problem.touches.size(); i += 3) problem.touches[i].role = TouchRole::kHeldOut;
  const Validation validation = validate(problem, with_ripple());
  EXPECT_TRUE(validation.passed()) << validation.same_touches.message;
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
