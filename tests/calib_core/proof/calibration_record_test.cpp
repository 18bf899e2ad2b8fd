#include "calib_core/proof/calibration_record.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/calib_core/proof/proved_cell.hpp"

namespace calib {
namespace {

TEST(CalibrationRecord, OfARigidArmHasTheCovarianceOfItsBudget) {
  const proved::Cell cell;
  const UncertaintyBudget& budget = *cell.result().uncertainty;
  const Eigen::MatrixXd expected = budget.identified + budget.held + budget.unseen;
  const Eigen::MatrixXd of_arm =
      cell.record().covariance().topLeftCorner(kArmParameterCount, kArmParameterCount);
  for (const int column : cell.result().identifiable.columns)
    EXPECT_NEAR(of_arm(column, column) / expected(column, column), 1.0, 1e-6) << arm_parameter_name(column);
  EXPECT_DOUBLE_EQ(cell.record().noise().std_m, budget.noise_m);
}

TEST(CalibrationRecord, SaysHowAnEffectThatWasLeftOutBendsTheEstimate) {
  proved::Cell cell;
  // Small: what it bends beyond first order must not show.
  constexpr double kHarmonicRad = 5e-6;
  KinematicModel uneven = cell.true_arm();
  uneven.harmonics_rad[1] = {kHarmonicRad, 0.0};
  IdentificationProblem problem = cell.problem();
  const int column = nongeometric_index(harmonic_position(1));
  problem.nongeometric_std[static_cast<std::size_t>(harmonic_position(1))] = kHarmonicRad;
  problem.touches = cell.again(problem.touches, cell.true_arm(), 0.0);
  const IdentificationResult even = identify(problem, cell.options());
  const CalibrationRecord record(problem, cell.options(), even);
  problem.touches = cell.again(problem.touches, uneven, 0.0);
  const IdentificationResult bent = identify(problem, cell.options());
  ASSERT_EQ(bent.status, IdentificationStatus::kConverged);
  const Eigen::VectorXd predicted = kHarmonicRad * record.displacement_by(column);
  EXPECT_NEAR(predicted[column], kHarmonicRad, 1e-12);
  const ArmVector moved = even.errors - bent.errors;  // true minus estimated
  const Eigen::VectorXd of_candidates = predicted.head<kErrorParameterCount>();
  EXPECT_LT((moved.head<kErrorParameterCount>() - of_candidates).norm(), 0.02 * of_candidates.norm());
}

TEST(CalibrationRecord, TakesNoResidualsForNoiseThatAreLargerThanRepeatsAndGearsExplain) {
  constexpr double kExpectedMetres = 4e-6, kDegrees = 30.0;
  const proved::Cell cell;
  IdentificationResult result = cell.result();
  result.lack_of_fit = LackOfFit{.noise_degrees = kDegrees, .noise_m = kExpectedMetres};
  const CalibrationRecord record(cell.problem(), cell.options(), result);
  EXPECT_EQ(record.noise().std_m, kExpectedMetres);
  EXPECT_EQ(record.noise().degrees_of_freedom, kDegrees);
  result.lack_of_fit->noise_m = 2.0 * proved::kNoiseMetres;
  EXPECT_EQ(CalibrationRecord(cell.problem(), cell.options(), result).noise().std_m,
            result.uncertainty->noise_m);
}

TEST(CalibrationRecord, IsRefusedACalibrationWithoutAResult) {
  const proved::Cell cell;
  EXPECT_THROW(CalibrationRecord(cell.problem(), cell.options(), IdentificationResult{}), std::logic_error);
}

}  // namespace
}  // namespace calib
