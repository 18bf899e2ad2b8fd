#include "calib_core/uncertainty/uncertainty_budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "calib_core/geometry/face.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/numerics/halton.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/calib_core/drawn_cell.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

// No touch tells in which direction the reference place has drifted: whichever way axis 1 stands, the tip is
// off by half of it in each.
TEST(Budget, ADriftMovesTheTipAsFarInEveryDirection) {
  constexpr double kDriftMetres = 1e-4;
  for (const double alpha_rad : {0.0, 0.4, 1.5707963}) {
    KinematicModel nominal = paper::nominal();
    nominal.links[1].alpha_rad = alpha_rad;
    IdentificationProblem problem{.nominal = nominal,
                                  .artefact = exact_artefact(paper::planes()),
                                  .touch_noise_m = 2e-5,
                                  .tolerances = drawn::tolerances(),
                                  .drift_m = kDriftMetres};
    const JointRanges ranges{JointVector::Constant(-2.0), JointVector::Constant(2.0)};
    for (int i = 1; i <= 120; ++i)
      problem.touches.push_back({.face = i % 4, .joints = halton_posture(i, ranges)});
    problem.touches = moved_onto_planes(nominal, problem.artefact.contact_planes, problem.touches);
    const IdentificationResult result = identify(problem, {.robust = false});
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    const UncertaintySource& drift = result.uncertainty->sources.back();
    ASSERT_EQ(drift.name, "drift");
    for (const int posture : {7, 40}) {
      const Chain chain = forward_chain(prepare(nominal), halton_posture(posture, ranges));
      const auto of_tip = tip_arm_derivatives(nominal, chain);
      const Eigen::Matrix3d covariance = of_tip * drift.covariance * of_tip.transpose();
      const Eigen::Matrix3d expected = std::pow(kDriftMetres / 2.0, 2) * Eigen::Matrix3d::Identity();
      EXPECT_LT((covariance - expected).cwiseAbs().maxCoeff(), 1e-6 * expected(0, 0)) << alpha_rad;
    }
  }
}

/// The named source of a budget, or nothing.
const UncertaintySource* named_source(const IdentificationResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.uncertainty->sources, name, &UncertaintySource::name);
  return found == result.uncertainty->sources.end() ? nullptr : &*found;
}

/// An arm that carries 20 kg before its wrist and 2 behind it, with what else is said of it.
IdentificationResult calibrated_with(const std::function<void(IdentificationProblem&)>& said,
                                     const IdentificationOptions& options) {
  IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(5));
  problem.nominal.masses[4] = {20.0, {0.0, 0.0, -0.25}};
  problem.nominal.masses[6] = {2.0, {0.0, 0.05, 0.06}};
  problem.nongeometric_std[static_cast<std::size_t>(compliance_position(1))] = 1e-6;
  said(problem);
  UniformChance chance(5);
  const drawn::Truth truth = drawn::draw_truth(problem, chance);
  problem.touches = drawn::touches(truth, {.count = 100}, chance);
  return identify(problem, options);
}

// Only blocks of the covariances are written: none may be left out, and none counted twice.
TEST(Budget, ItsSourcesSumToTheWholeCovarianceAndHeldOnesHaveANameOfTheirOwn) {
  const auto said = [](IdentificationProblem& problem) {
    problem.gear_std_rad.setConstant(2e-5);
    problem.drift_m = 3e-5;
    problem.nongeometric_std[static_cast<std::size_t>(harmonic_position(2))] = 4e-5;
    problem.nongeometric_std[static_cast<std::size_t>(second_harmonic_position(1))] = 4e-5;
  };
  IdentificationOptions options;
  options.identifiability.excluded = {error_parameter_index("r3").value()};
  const IdentificationResult result = calibrated_with(said, options);
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  const UncertaintyBudget& budget = *result.uncertainty;
  ArmCovariance sum = no_covariance();
  for (const UncertaintySource& source : budget.sources) sum += source.covariance;
  const ArmCovariance whole = budget.covariance();
  const Eigen::VectorXd std = whole.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = (std.array() > 0.0).select(std.cwiseInverse(), 0.0);
  EXPECT_LT((scale.asDiagonal() * (sum - whole) * scale.asDiagonal()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(named_source(result, "touch_noise")->covariance, budget.of_noise);
  ASSERT_NE(named_source(result, "held"), nullptr);
  EXPECT_GT(named_source(result, "held")->covariance.trace(), 0.0);
}

// Never estimated by any option, and never missing.
TEST(Budget, HasTheComplianceOfTheWristWhetherThatOfTheOtherJointsIsEstimatedOrNot) {
  constexpr double kStd = 5e-6;
  for (const bool stiffness : {true, false}) {
    for (const int joint : {3, 4, 5}) {
      const auto said = [&](IdentificationProblem& problem) {
        problem.nongeometric_std[static_cast<std::size_t>(compliance_position(joint))] = kStd;
      };
      const IdentificationOptions options{.stiffness = stiffness, .harmonics = Harmonics::kEstimate};
      const IdentificationResult with = calibrated_with(said, options);
      ASSERT_EQ(with.status, IdentificationStatus::kConverged) << with.message;
      const UncertaintySource* source = named_source(with, "compliance");
      ASSERT_NE(source, nullptr);
      const int column = nongeometric_index(compliance_position(joint));
      EXPECT_NEAR(source->covariance(column, column), kStd * kStd, 1e-9 * kStd * kStd) << joint;
      EXPECT_EQ(with.uncertainty->identified(column, column), 0.0);
      const IdentificationResult without = calibrated_with([](IdentificationProblem&) {}, options);
      const auto over_ranges = region_over_joint_ranges(paper::nominal(), tx90::joint_ranges(), {}, 40);
      EXPECT_EQ(named_source(without, "compliance")->covariance(column, column), 0.0);
      EXPECT_GT(with.uncertainty->held.trace(), without.uncertainty->held.trace()) << joint;
      EXPECT_TRUE(over_ranges.rms_m(source->covariance)) << "it is a figure of the tip";
    }
  }
}

// The masses are a guess, and every droop by them is one as well.
TEST(Budget, HasTheMassesWhereTheArmYieldsToThem) {
  constexpr double kStdShare = 0.1;
  const auto said = [kStdShare](IdentificationProblem& problem) {
    problem.nominal.compliance_rad_per_nm[1] = 3e-6;
    problem.nongeometric_std[static_cast<std::size_t>(mass_position(4))] = kStdShare;
  };
  const auto rigid = [&](IdentificationProblem& problem) {
    said(problem);
    problem.nominal.compliance_rad_per_nm[1] = 0.0;
  };
  const IdentificationResult result = calibrated_with(said, {.stiffness = true});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  const UncertaintySource* source = named_source(result, "masses");
  ASSERT_NE(source, nullptr);
  const int column = nongeometric_index(mass_position(4));
  EXPECT_NEAR(source->covariance(column, column), kStdShare * kStdShare, 1e-12);
  const auto over_ranges = region_over_joint_ranges(result.calibrated, tx90::joint_ranges(), {}, 40);
  EXPECT_GT(over_ranges.rms_m(source->covariance).value(), 1e-7) << "the compliance takes up a part of it";
  const IdentificationResult without = calibrated_with(rigid, {.stiffness = false});
  const auto of_rigid = region_over_joint_ranges(without.calibrated, tx90::joint_ranges(), {}, 40);
  EXPECT_NEAR(of_rigid.rms_m(named_source(without, "masses")->covariance).value(), 0.0, 1e-9);
}

TEST(Budget, HasThePlayOfTheGearsAsALagAndAsAnErrorOfPosture) {
  const auto said = [](IdentificationProblem& problem) {
    problem.gear_std_rad.setConstant(1e-5);
    problem.gear_lag_std_rad.setConstant(1e-5);
  };
  const IdentificationResult result = calibrated_with(said, {.stiffness = true});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  const auto over_ranges = region_over_joint_ranges(paper::nominal(), tx90::joint_ranges(), {}, 40);
  for (const char* name : {"backlash", "gears"}) {
    const UncertaintySource* source = named_source(result, name);
    ASSERT_NE(source, nullptr) << name;
    EXPECT_GT(over_ranges.rms_m(source->covariance).value(), 1e-6) << name;
  }
}

TEST(Budget, ADriftThatTheScatterHidesIsASourceOfItsOwnDegreesOfFreedom) {
  constexpr double kOpenMetres = 1e-5;
  IdentificationProblem problem{.nominal = paper::nominal(),
                                .artefact = exact_artefact(paper::planes()),
                                .touch_noise_m = 2e-5,
                                .tolerances = drawn::tolerances()};
  const JointRanges ranges{JointVector::Constant(-2.0), JointVector::Constant(2.0)};
  for (int i = 1; i <= 120; ++i)
    problem.touches.push_back({.face = i % 4, .joints = halton_posture(i, ranges)});
  problem.touches = moved_onto_planes(problem.nominal, problem.artefact.contact_planes, problem.touches);
  const IdentificationResult without = identify(problem, {.robust = false});
  problem.drift_uncertainty = {kOpenMetres, 6.0};
  const IdentificationResult with = identify(problem, {.robust = false});
  ASSERT_EQ(with.status, IdentificationStatus::kConverged) << with.message;
  EXPECT_EQ(with.uncertainty->sources.back().name, "drift");
  EXPECT_EQ(with.uncertainty->drift_degrees_of_freedom, 6.0);
  EXPECT_TRUE(without.uncertainty->of_drift.isZero(0.0));
  const auto of_tip = tip_arm_derivatives(problem.nominal,
                                          forward_chain(prepare(problem.nominal), halton_posture(7, ranges)));
  const Eigen::Matrix3d added =
      of_tip * (with.uncertainty->covariance() - without.uncertainty->covariance()) * of_tip.transpose();
  const Eigen::Matrix3d expected = std::pow(kOpenMetres / 2.0, 2) * Eigen::Matrix3d::Identity();
  EXPECT_LT((added - expected).cwiseAbs().maxCoeff(), 1e-5 * expected(0, 0));
  for (const std::string& warning : with.warnings)
    EXPECT_EQ(warning.find("reference place"), std::string::npos) << "nothing is shown";
}

// Student's factors of the GUM, table G.2.
TEST(Coverage, TakesTheEffectiveDegreesOfFreedom) {
  UncertaintyBudget budget;
  budget.degrees_of_freedom = 4.0;
  EXPECT_NEAR(budget.coverage_factor_of(1.0, 1.0), 2.776, 1e-3) << "noise alone: 4";
  EXPECT_NEAR(budget.coverage_factor_of(1.0, 0.5), 2.120, 1e-3) << "half of the variance: 16";
  EXPECT_NEAR(budget.coverage_factor_of(1.0, 0.0), 1.960, 1e-3) << "no noise: infinite";
  EXPECT_NEAR(budget.coverage_factor_of(0.0, 0.0), 2.776, 1e-3) << "nothing known";
  budget.drift_degrees_of_freedom = 4.0;
  EXPECT_NEAR(budget.coverage_factor_of(1.0, 0.0, 1.0), 2.776, 1e-3) << "drift alone: 4";
  EXPECT_NEAR(budget.coverage_factor_of(1.0, 0.5, 0.5), 2.306, 1e-3) << "half each: 8";
}

TEST(ArmFrame, LeavesOutTheBlocksPlaceAndNothingElse) {
  for (int i = 0; i < kArmParameterCount; ++i) {
    UncertaintyBudget budget;
    budget.identified(i, i) = 1.0;
    budget.held(i, i) = 2.0;
    budget.unseen(i, i) = 4.0;
    budget.unknown_directions = ArmVector::Unit(i);
    const UncertaintyBudget of_arm = in_arm_frame(budget);
    const std::string name = arm_parameter_name(i);
    const bool is_place = name == "theta0" || name == "r0" || name == "alpha1" || name == "d1" ||
                          name == "theta1" || name == "r1" || name == "beta1";
    EXPECT_EQ(of_arm.covariance()(i, i), is_place ? 0.0 : 7.0) << name;
    EXPECT_EQ(of_arm.unknown_directions(i, 0), is_place ? 0.0 : 1.0) << name;
  }
}

TEST(ArmFrame, KeepsTheArmsPartOfWhatIsCorrelatedWithThePlace) {
  UncertaintyBudget budget;
  const int place = error_parameter_index("theta1").value();
  const int joint2 = error_parameter_index("theta2").value();
  budget.identified(place, place) = 1.0;
  budget.identified(joint2, joint2) = 4.0;
  budget.identified(place, joint2) = budget.identified(joint2, place) = 1.9;
  ArmMatrix wanted = ArmMatrix::Zero();
  wanted(joint2, joint2) = 4.0;
  EXPECT_EQ(in_arm_frame(budget).covariance(), wanted);
}

TEST(ArmFrame, KeepsWhatTheGearOfJoint1DoesFromPostureToPosture) {
  UncertaintyBudget budget;
  const int joint1 = error_parameter_index("theta1").value();
  budget.of_posture(joint1, joint1) = 1e-10;
  EXPECT_EQ(in_arm_frame(budget).covariance(), budget.covariance());
}

// Errors of the place move the whole arm as one body: from posture to posture the tip is off by the same
// rigid motion, whichever way joint 1's axis stands against the block.
TEST(ArmFrame, ErrorsOfThePlaceMoveTheArmAsARigidBody) {
  for (const double alpha_rad : {0.0, 0.4, 1.5707963}) {
    KinematicModel nominal = paper::nominal();
    nominal.links[1].alpha_rad = alpha_rad;
    for (int i = 0; i < kErrorParameterCount; ++i) {
      const KinematicModel moved = apply(nominal, ErrorVector(1e-3 * ErrorVector::Unit(i)));
      const auto motion = [&](const JointVector& joints) {
        return forward_kinematics(moved, joints) * forward_kinematics(nominal, joints).inverse();
      };
      const Eigen::Matrix4d here = motion(tx90::degrees(10, 20, 30, 40, 50, 60)).matrix();
      const Eigen::Matrix4d there = motion(tx90::degrees(-70, -20, 90, -40, 80, 10)).matrix();
      EXPECT_EQ((here - there).cwiseAbs().maxCoeff() < 1e-12, is_place_error(i)) << arm_parameter_name(i);
    }
  }
}

}  // namespace
}  // namespace calib
