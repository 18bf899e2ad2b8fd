#include "calib_core/identification/model_selection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

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

/// Residuals of which the squares decrease by 1 and by `other` in turn.
std::optional<HeldOutTest> held_out_of(int count, double other) {
  Eigen::VectorXd smaller(count), larger(count);
  for (int i = 0; i < count; ++i) {
    larger[i] = i % 2 == 0 ? 1.0 : -2.0;
    smaller[i] = std::sqrt(larger[i] * larger[i] + (i % 2 == 0 ? 4.0 + other : 4.0 - other));
  }
  return test_held_out(smaller, larger);
}

TEST(HeldOutTest, IsStudentsTOfTheDecreaseOfTheSquares) {
  // Decreases of 5 and 3 in turn, twenty: t = 4 sqrt(19); p by numerical integration of Student's density.
  const auto clear = held_out_of(20, 1.0);
  ASSERT_TRUE(clear);
  EXPECT_EQ(clear->touch_count, 20);
  EXPECT_NEAR(clear->t, 4.0 * std::sqrt(19.0), 1e-12);
  EXPECT_NEAR(clear->larger_rms_m, std::sqrt(2.5), 1e-12);
  EXPECT_NEAR(clear->smaller_rms_m, std::sqrt(6.5), 1e-12);
  // Of 12 and -4: t = sqrt(19) / 2.
  const auto doubtful = held_out_of(20, 8.0);
  EXPECT_NEAR(doubtful->t, 0.5 * std::sqrt(19.0), 1e-12);
  EXPECT_NEAR(doubtful->p, 0.021043143355, 1e-9);
}

TEST(HeldOutTest, IsOneSided) {
  const Eigen::VectorXd one = Eigen::VectorXd::LinSpaced(30, -1.0, 1.0), half = 0.5 * one;
  EXPECT_LT(test_held_out(one, half)->p, 0.01);
  EXPECT_GT(test_held_out(half, one)->p, 0.99);
}

TEST(HeldOutTest, AsksNotTooFewTouchesAndNoneThatTellNothing) {
  EXPECT_FALSE(held_out_of(kHeldOutTouchesMin - 1, 1.0));
  const Eigen::VectorXd same = Eigen::VectorXd::LinSpaced(30, -1.0, 1.0);
  EXPECT_FALSE(test_held_out(same, same));
}

/// A choice between the nominal arm and an eccentric one by touches of the eccentric one or of the nominal
/// one, where the fitted touches say this.
ModelChoice choice_of(bool fitted_ask, bool held_out_ask, int held_out_count) {
  IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(5));
  IdentificationResult smaller, larger;
  smaller.status = larger.status = IdentificationStatus::kConverged;
  smaller.artefact_errors = larger.artefact_errors =
      Eigen::VectorXd::Zero(std::ssize(problem.artefact.parameters));
  smaller.calibrated = larger.calibrated = problem.nominal;
  for (CosSin& harmonic : larger.calibrated.harmonics_rad) harmonic = {1e-4, -1e-4};
  smaller.residual_sum = {100, fitted_ask ? 200.0 : 71.0, 30.0, 30.0};
  larger.residual_sum = {100, 60.0, 40.0, 40.0};
  const drawn::Truth truth{ErrorVector::Zero(), smaller.artefact_errors,
                           held_out_ask ? larger.calibrated : smaller.calibrated,
                           problem.artefact.contact_planes};
  UniformChance chance(3);
  problem.touches = drawn::touches(truth, {.count = held_out_count, .noise_m = 10e-6}, chance);
  for (Touch& touch : problem.touches) touch.role = TouchRole::kHeldOut;
  return choose_model("harmonics", problem, smaller, larger);
}

TEST(ModelChoice, IsMadeByEitherVoiceAndSaysWhichOne) {
  struct Case {
    bool fitted, held_out;
    const char* said;
  };
  for (const auto& [fitted, held_out, said] :
       {Case{true, true, "harmonics taken: the fitted touches ask for them .*, so do the held-out ones .*"},
        Case{true, false, "harmonics taken: the fitted touches ask .*, the held-out ones do not .*"},
        Case{false, true, "harmonics taken: the held-out touches ask .*, the fitted ones do not .*"},
        Case{false, false, "harmonics left out: the fitted touches do not ask .*, nor do the held-out .*"}}) {
    const ModelChoice choice = choice_of(fitted, held_out, 60);
    EXPECT_EQ(choice.take_larger, fitted || held_out);
    EXPECT_THAT(choice.reason, testing::MatchesRegex(said));
  }
}

TEST(ModelChoice, AsksTheFittedTouchesAloneWhereFewAreHeldOut) {
  EXPECT_EQ(choice_of(false, true, kHeldOutTouchesMin - 1).reason,
            "harmonics left out: the fitted touches do not ask for them (F 1.1, p 0.38)");
  EXPECT_TRUE(choice_of(true, true, kHeldOutTouchesMin - 1).take_larger);
}

}  // namespace
}  // namespace calib
