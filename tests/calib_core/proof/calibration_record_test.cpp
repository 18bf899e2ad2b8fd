#include "calib_core/proof/calibration_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

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

TEST(CalibrationRecord, CountsTheStopsOfTheArmOnceWhereRepeatsShowThem) {
  constexpr double kRepeatsMetres = 4e-6, kDegrees = 20.0;
  proved::Cell cell;
  IdentificationProblem problem = cell.problem();
  problem.stop_std_rad.setConstant(10e-6);
  problem.gear_std_rad = problem.stop_std_rad;  // even gears without play
  IdentificationResult result = cell.result();
  const double tested_m = 2.0 * kRepeatsMetres;
  result.lack_of_fit = LackOfFit{.noise_degrees = kDegrees,
                                 .noise_m = tested_m,
                                 .repeats_m = kRepeatsMetres,
                                 .gears_m = std::sqrt(tested_m * tested_m - kRepeatsMetres * kRepeatsMetres)};
  const CalibrationRecord record(problem, cell.options(), result);
  EXPECT_DOUBLE_EQ(record.noise().std_m, kRepeatsMetres);
  const double share = kRepeatsMetres * kRepeatsMetres / (tested_m * tested_m);
  EXPECT_DOUBLE_EQ(record.noise().degrees_of_freedom, kDegrees * share * share);
}

/// Of the noise, what does not grow with the levers.
double alike_share(const CalibrationRecord& record) {
  return record.noise_variance_m2(JointVector::Zero(), 1.0) / std::pow(record.noise().std_m, 2);
}

TEST(CalibrationRecord, NoiseIsTheMeasuredOneInTheMeanOfTheTouches) {
  const proved::Cell cell;
  IdentificationProblem problem = cell.problem();
  for (const double gears_rad : {0.0, 1e-6, 50e-6}) {
    problem.gear_std_rad.setConstant(gears_rad);
    const CalibrationRecord record(problem, cell.options(), cell.result());
    const TouchRows rows = touch_rows(record, record.calibrated(), problem.touches);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < rows.of_joints.rows(); ++i)
      sum += record.noise_variance_m2(rows.of_joints.row(i), 1.0);
    const double mean = sum / static_cast<double>(problem.touches.size());
    EXPECT_NEAR(mean / std::pow(proved::kNoiseMetres, 2), 1.0, 1e-3) << gears_rad;
  }
}

TEST(CalibrationRecord, NoiseGrowsWithTheLeversAsFarAsTheGearsExplainItAndTheResidualsShowIt) {
  constexpr double kGearsRad = 150e-6;
  constexpr int kUneven = 4;  // joint 5, whose lever differs most from touch to touch
  proved::Cell cell;
  EXPECT_DOUBLE_EQ(alike_share(cell.record()), 1.0);  // no gears are known
  IdentificationProblem problem = cell.problem();
  problem.gear_std_rad.setConstant(1e-6);
  EXPECT_GT(alike_share(CalibrationRecord(problem, cell.options(), cell.result())), 0.95);
  problem.gear_std_rad = kGearsRad * JointVector::Unit(kUneven);
  const CalibrationRecord of_probe(problem, cell.options(), cell.result());
  problem.touches = cell.again(problem.touches, cell.true_arm(), 0.0);
  UniformChance chance(proved::kSeed);
  for (Touch& touch : problem.touches) touch.joints[kUneven] += kGearsRad * study::normal(chance);
  const CalibrationRecord of_joints(problem, cell.options(), identify(problem, cell.options()));
  EXPECT_LT(alike_share(of_joints), 0.5);
  EXPECT_GT(alike_share(of_probe), alike_share(of_joints) + 0.2);
  const JointVector lever = JointVector::Unit(kUneven);
  const double alike = of_joints.noise_variance_m2(JointVector::Zero(), 1.0);
  EXPECT_DOUBLE_EQ(of_joints.noise_variance_m2(2.0 * lever, 1.0) - alike,
                   4.0 * (of_joints.noise_variance_m2(lever, 1.0) - alike));
  EXPECT_DOUBLE_EQ(of_joints.noise_variance_m2(lever, 2.0), 4.0 * of_joints.noise_variance_m2(lever, 1.0));
}

TEST(CalibrationRecord, CarriesTheNoiseOfEachTouchThroughTheFit) {
  proved::Cell cell;
  IdentificationProblem problem = cell.problem();
  problem.gear_std_rad.setConstant(50e-6);
  const CalibrationRecord even = cell.record();
  const CalibrationRecord uneven(problem, cell.options(), cell.result());
  const TouchRows rows = touch_rows(even, even.calibrated(), problem.touches);
  // The estimate moves with each touch alone.
  ArmMatrix expected = ArmMatrix::Zero();
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    IdentificationProblem moved = cell.problem();
    moved.touches[i] = cell.again({moved.touches[i]}, cell.true_arm(), proved::kNoiseMetres).front();
    const auto row = static_cast<Eigen::Index>(i);
    const double by_m =
        touch_rows(even, even.calibrated(), std::span(moved.touches).subspan(i, 1)).distances_m[0] -
        rows.distances_m[row];
    const ArmVector per_metre = (identify(moved, cell.options()).errors - cell.result().errors) / by_m;
    const JointVector per_rad = rows.of_joints.row(row);
    expected += (uneven.noise_variance_m2(per_rad, 1.0) - even.noise_variance_m2(per_rad, 1.0)) * per_metre *
                per_metre.transpose();
  }
  const Eigen::MatrixXd more = uneven.covariance() - even.covariance();
  for (const int column : cell.result().identifiable.columns)
    EXPECT_NEAR(more(column, column), expected(column, column), 0.02 * even.covariance()(column, column))
        << arm_parameter_name(column);
  EXPECT_GT(expected.diagonal().cwiseAbs().maxCoeff(), 0.0);
}

TEST(CalibrationRecord, SaysHowAnArmThatGrowsWhileItIsTouchedBendsTheEstimate) {
  constexpr double kGrowth = 20e-6;
  proved::Cell cell;
  IdentificationProblem problem = cell.problem();
  problem.touches = cell.again(problem.touches, cell.true_arm(), 0.0);
  const IdentificationResult steady = identify(problem, cell.options());
  const CalibrationRecord record(problem, cell.options(), steady);
  const double last = static_cast<double>(problem.touches.size() - 1);
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const double share = kGrowth * (static_cast<double>(i) / last - 0.5);
    const KinematicModel grown = apply(cell.true_arm(), errors_by_growth(cell.true_arm(), share));
    problem.touches[i] = cell.again({problem.touches[i]}, grown, 0.0).front();
  }
  const IdentificationResult bent = identify(problem, cell.options());
  ASSERT_EQ(bent.status, IdentificationStatus::kConverged);
  const Eigen::VectorXd predicted = kGrowth * record.displacement_by_growth();
  const Eigen::VectorXd of_candidates = predicted.head<kErrorParameterCount>();
  const ArmVector moved = steady.errors - bent.errors;  // true minus estimated
  EXPECT_GT(of_candidates.norm(), 0.0);
  EXPECT_LT((moved.head<kErrorParameterCount>() - of_candidates).norm(), 0.02 * of_candidates.norm());
}

TEST(CalibrationRecord, IsRefusedACalibrationWithoutAResult) {
  const proved::Cell cell;
  EXPECT_THROW(CalibrationRecord(cell.problem(), cell.options(), IdentificationResult{}), std::logic_error);
}

}  // namespace
}  // namespace calib
