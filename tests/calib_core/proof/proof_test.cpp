#include "calib_core/proof/proof.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/calib_core/proof/proved_cell.hpp"

namespace calib {
namespace {

using ::testing::HasSubstr;

constexpr int kTouchesOfProof = 16;

class Proof : public ::testing::Test {
 protected:
  std::variant<ProofVerdict, ProofRefusal> proved(std::span<const Touch> touches) {
    return prove(cell_.record(), place_, touches);
  }
  ProofVerdict verdict_of(std::span<const Touch> touches) {
    const auto outcome = proved(touches);
    if (const auto* refusal = std::get_if<ProofRefusal>(&outcome)) {
      ADD_FAILURE() << refusal->message;
      return {};
    }
    return std::get<ProofVerdict>(outcome);
  }
  std::string refusal_of(std::span<const Touch> touches) {
    const auto outcome = proved(touches);
    const auto* refusal = std::get_if<ProofRefusal>(&outcome);
    return refusal ? refusal->message : "";
  }

  proved::Cell cell_;
  ProofPlace place_{.calibrated_from_block = proved::lifted()};
};

TEST_F(Proof, OfTheArmThatWasCalibratedPassesAndTellsWhereTheBlockStands) {
  const ProofVerdict verdict =
      verdict_of(cell_.touches_at(proved::lifted(), cell_.true_arm(), kTouchesOfProof));
  EXPECT_TRUE(verdict.passed) << verdict.p << ' ' << verdict.rms_m;
  EXPECT_EQ(verdict.degrees_of_freedom, kTouchesOfProof - 6);
  EXPECT_NEAR(verdict.rms_m, proved::kNoiseMetres, proved::kNoiseMetres);
  const Eigen::Vector3d off_m = verdict.calibrated_from_block.translation() - proved::lifted().translation();
  EXPECT_LT(off_m.norm(), 0.5e-3);
}

TEST_F(Proof, NeedNotBeToldExactlyWhereTheBlockStands) {
  const auto touches = cell_.touches_at(proved::lifted(), cell_.true_arm(), kTouchesOfProof);
  const ProofVerdict told = verdict_of(touches);
  place_.calibrated_from_block = Eigen::Translation3d(0.004, 0.003, -0.002) * place_.calibrated_from_block *
                                 Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX());
  const ProofVerdict about = verdict_of(touches);
  EXPECT_NEAR(about.chi_square, told.chi_square, 1e-3 * told.chi_square);
  EXPECT_NEAR(about.rms_m, told.rms_m, 1e-3 * told.rms_m);
}

TEST_F(Proof, OfAnArmThatSlippedFailsAndSaysWhy) {
  constexpr double kSlipRad = 1e-3;
  const auto slipped = proved::slipped(cell_.true_arm(), 3, kSlipRad);
  const ProofVerdict verdict = verdict_of(cell_.touches_at(proved::lifted(), slipped, kTouchesOfProof));
  EXPECT_FALSE(verdict.passed);
  ASSERT_FALSE(verdict.reasons.empty());
  EXPECT_LT(verdict.p, ProofLimits{}.p_min);
}

TEST_F(Proof, TakesAGrowthWithinTheArmsWarmthForNoFault) {
  constexpr double kGrowth = 100e-6;
  const KinematicModel grown = apply(cell_.true_arm(), errors_by_growth(cell_.true_arm(), kGrowth));
  const auto touches = cell_.touches_at(proved::lifted(), grown, kTouchesOfProof);
  const double cold_rms_m = verdict_of(touches).rms_m;
  place_.std_growth = kGrowth;
  const ProofVerdict warm = verdict_of(touches);
  EXPECT_TRUE(warm.passed) << warm.p << ' ' << warm.rms_m;
  EXPECT_LT(warm.rms_m, cold_rms_m);
}

/// Variance of one touch in a covariance beside what the calibration left open and what is alike for all.
double joint_noise_of(const CalibrationRecord& record, const TouchRows& rows,
                      const Eigen::MatrixXd& covariance, Eigen::Index touch) {
  const Eigen::VectorXd row = rows.of_unknowns.row(touch);
  return covariance(touch, touch) - row.dot(record.covariance() * row) -
         record.noise_variance_m2(JointVector::Zero(), 1.0);
}

TEST_F(Proof, ExpectsATouchToScatterByItsLeversAboutTheJointsThatErr) {
  IdentificationProblem problem = cell_.problem();
  problem.gear_std_rad.setConstant(50e-6);
  const CalibrationRecord record(problem, cell_.options(), cell_.result());
  const auto touches = cell_.touches_at(proved::lifted(), cell_.true_arm(), kTouchesOfProof);
  const TouchRows rows = touch_rows(record, arm_at(record.calibrated(), proved::lifted()), touches);
  const Eigen::MatrixXd covariance = proof_covariance(record, place_, rows, touches);
  const auto levers_squared = [&rows](Eigen::Index touch) {
    double sum = 0.0;
    for (int joint = 0; joint < kJointCount; ++joint)
      sum += std::pow(rows.of_arm(touch, theta_index(joint)), 2);
    return sum;
  };
  const double noise = joint_noise_of(record, rows, covariance, 0);
  EXPECT_GT(noise, 0.0);
  for (Eigen::Index i = 1; i < std::ssize(touches); ++i) {
    const double expected = levers_squared(i) / levers_squared(0);
    EXPECT_NEAR(joint_noise_of(record, rows, covariance, i) / noise, expected, 1e-3 * expected);
  }
}

TEST_F(Proof, TakesItForPossibleThatTheArmGrewWhileItWasCalibrated) {
  const auto touches = cell_.touches_at(proved::lifted(), cell_.true_arm(), kTouchesOfProof);
  const CalibrationRecord& record = cell_.record();
  const TouchRows rows = touch_rows(record, arm_at(record.calibrated(), proved::lifted()), touches);
  const Eigen::MatrixXd as_warm = proof_covariance(record, place_, rows, touches);
  place_.std_growth = 100e-6;
  const Eigen::MatrixXd warmer = proof_covariance(record, place_, rows, touches);
  // The mean of what it grew by the last touch of the calibration, from none of it to all of it.
  const Eigen::VectorXd since = growth_effect(record, rows.of_arm);
  const Eigen::VectorXd in_run = rows.of_unknowns * record.displacement_by_growth();
  constexpr int kParts = 1000;
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(kTouchesOfProof, kTouchesOfProof);
  for (int k = 0; k < kParts; ++k) {
    const Eigen::VectorXd grown = place_.std_growth * (since + 2.0 * (k + 0.5) / kParts * in_run);
    mean += grown * grown.transpose() / kParts;
  }
  EXPECT_LT((warmer - as_warm - mean).norm(), 1e-5 * mean.norm());
}

TEST_F(Proof, PowerGrowsWithTheFaultFromTheLevelOfTheTest) {
  const auto touches = cell_.touches_at(proved::lifted(), cell_.true_arm(), kTouchesOfProof);
  ProofAlternative slip{"slip", Eigen::MatrixXd::Zero(cell_.record().unknown_count(), 1)};
  std::vector<ProofAlternative> alternatives;
  for (const double size_rad : {0.0, 0.1e-3, 1e-3}) {
    slip.displacements(theta_index(2), 0) = size_rad;
    alternatives.push_back(slip);
  }
  const auto power = proof_power(cell_.record(), alternatives, place_, touches);
  EXPECT_NEAR(power[0].power, ProofLimits{}.p_min, 1e-9);
  EXPECT_GT(power[1].power, power[0].power);
  EXPECT_GT(power[2].power, 0.999);
}

TEST_F(Proof, IsRefusedWithAWordOnWhatToDo) {
  const auto touches = cell_.touches_at(proved::lifted(), cell_.true_arm(), kTouchesOfProof);
  EXPECT_THAT(refusal_of(std::span(touches).first(8)), HasSubstr("at least 9"));
  auto wrong = touches;
  wrong[4].face = 5;
  EXPECT_THAT(refusal_of(wrong), HasSubstr("touch 5 is on a plane that the block does not have"));
  wrong = touches;
  wrong[2].joints[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal_of(wrong), HasSubstr("touch 3 has a joint that is not a number"));
  wrong = touches;
  for (Touch& touch : wrong) touch = touches[0];
  EXPECT_THAT(refusal_of(wrong), HasSubstr("do not determine where the block stands"));
  wrong = touches;
  wrong[7].joints[1] += 0.05;
  EXPECT_THAT(refusal_of(wrong), HasSubstr("off its plane"));
}

TEST_F(Proof, AtThePlaceOfTheCalibrationIsNone) {
  place_.calibrated_from_block.setIdentity();
  const auto touches = cell_.touches_at(Eigen::Isometry3d::Identity(), cell_.true_arm(), kTouchesOfProof);
  EXPECT_THAT(refusal_of(touches), HasSubstr("proves nothing: lift it"));
}

}  // namespace
}  // namespace calib
