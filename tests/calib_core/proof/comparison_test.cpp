#include "calib_core/proof/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/calib_core/proof/proved_cell.hpp"

namespace calib {
namespace {

using ::testing::HasSubstr;

class CompareCalibrations : public ::testing::Test {
 protected:
  /// The same cell calibrated once more, with its arm as it is then; at other postures unless `again`.
  CalibrationRecord calibrated_later(const KinematicModel& arm, bool again = false) {
    IdentificationProblem problem = cell_.problem();
    problem.touches = again ? cell_.again(cell_.problem().touches, arm, proved::kNoiseMetres)
                            : cell_.touches_at(Eigen::Isometry3d::Identity(), arm,
                                               static_cast<int>(problem.touches.size()));
    return {problem, cell_.options(), identify(problem, cell_.options())};
  }
  Comparison compared(const CalibrationRecord& later) {
    return std::get<Comparison>(compare(cell_.record(), later));
  }

  proved::Cell cell_;
};

TEST_F(CompareCalibrations, OfAnArmThatIsAsItWasAlarmAsSeldomAsTheyPromise) {
  constexpr int kTimes = 60, kAlarmsMax = 4;  // of 0.6 expected; more by chance once in 2000 times
  int alarms = 0, beyond = 0, combinations = 0;
  double chi_square_per_degree = 0.0;
  for (int k = 0; k < kTimes; ++k) {
    const Comparison made = compared(calibrated_later(cell_.true_arm(), k % 2 == 0));
    alarms += made.arm.has_changed() || made.tool.has_changed() ? 1 : 0;
    combinations += static_cast<int>(made.arm.combinations.size());
    beyond += static_cast<int>(std::ranges::count_if(
        made.arm.combinations, [](const Combination& one) { return std::abs(one.e_n) > 1.0; }));
    chi_square_per_degree += made.arm.chi_square / made.arm.degrees_of_freedom / kTimes;
  }
  EXPECT_LE(alarms, kAlarmsMax);
  EXPECT_GT(chi_square_per_degree, 0.3) << "a covariance that is too large hides every change";
  EXPECT_LT(chi_square_per_degree, 1.5);
  EXPECT_LT(beyond, 0.10 * combinations) << "chance: 0.05";
}

TEST_F(CompareCalibrations, AJointThatSlippedIsSeenAndNamed) {
  const Comparison made = compared(calibrated_later(proved::slipped(cell_.true_arm(), 3, 0.3e-3)));
  EXPECT_TRUE(made.arm.has_changed());
  EXPECT_FALSE(made.tool.has_changed());
  ASSERT_FALSE(made.arm.combinations.empty());
  EXPECT_GT(std::abs(made.arm.combinations.front().e_n), 1.0);
}

TEST_F(CompareCalibrations, GrowthIsMeasuredAndNoChange) {
  constexpr double kGrowth = 150e-6;
  const Comparison made =
      compared(calibrated_later(apply(cell_.true_arm(), errors_by_growth(cell_.true_arm(), kGrowth))));
  EXPECT_NEAR(made.growth, kGrowth, 4.0 * made.std_growth);
  EXPECT_LT(made.std_growth, 0.3 * kGrowth);
  EXPECT_FALSE(made.arm.has_changed() || made.tool.has_changed());
}

TEST_F(CompareCalibrations, ABentStylusIsOfTheToolAndAMovedBlockOfNeither) {
  ErrorVector bent = ErrorVector::Zero();
  bent[error_parameter_index("d7").value()] = 0.3e-3;
  const Comparison stylus = compared(calibrated_later(apply(cell_.true_arm(), bent)));
  EXPECT_TRUE(stylus.tool.has_changed());
  EXPECT_FALSE(stylus.arm.has_changed());
  const Eigen::Isometry3d moved =
      Eigen::Translation3d(0.4e-3, -0.2e-3, 0.3e-3) * Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitZ());
  const Comparison block = compared(calibrated_later(arm_at(cell_.true_arm(), moved)));
  EXPECT_FALSE(block.arm.has_changed() || block.tool.has_changed());
}

TEST_F(CompareCalibrations, ACombinationNamesItsLargestSharesFirst) {
  const Comparison made = compared(calibrated_later(cell_.true_arm()));
  for (const Combination& one : made.arm.combinations) {
    ASSERT_FALSE(one.shares.empty());
    for (std::size_t k = 1; k < one.shares.size(); ++k)
      EXPECT_GE(std::abs(one.shares[k - 1].share), std::abs(one.shares[k].share));
    for (const Combination::Share& part : one.shares) EXPECT_FALSE(is_place_error(part.parameter));
  }
}

TEST_F(CompareCalibrations, OfAnotherBlockAreRefused) {
  IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(4), proved::kNoiseMetres);
  UniformChance chance(3);
  const drawn::Truth truth = drawn::draw_truth(problem, chance);
  problem.touches = drawn::touches(truth, {.count = 100, .noise_m = proved::kNoiseMetres}, chance);
  const CalibrationRecord other(problem, cell_.options(), identify(problem, cell_.options()));
  EXPECT_THAT(std::get<ComparisonRefusal>(compare(cell_.record(), other)).message,
              HasSubstr("not of the same block"));
}

}  // namespace
}  // namespace calib
