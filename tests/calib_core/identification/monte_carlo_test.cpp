#include "calib_core/identification/monte_carlo.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

using ::testing::HasSubstr;

const Box kBox{"in front of the arm", {-0.3, -0.5, -0.25}, {0.3, 0.0, 0.55}};

/// A converged identification of a drawn arm, and what the simulation needs of it.
struct Case {
  IdentificationProblem problem;
  IdentificationOptions options;
  IdentificationResult result;

  [[nodiscard]] MonteCarlo simulation() const {
    std::vector<std::size_t> fitted(problem.touches.size());
    std::iota(fitted.begin(), fitted.end(), std::size_t{0});
    constexpr int kPostures = 40;
    return {problem,
            options,
            result,
            fitted,
            {postures_in_box(problem.nominal, tx90::joint_ranges(), kBox, {}, kPostures),
             postures_over_joint_ranges(tx90::joint_ranges(), kPostures)}};
  }
  [[nodiscard]] double linear_ranges_rms_m() const {
    return region_over_joint_ranges(problem.nominal, tx90::joint_ranges(), {}, 40)
        .rms_m(result.uncertainty->covariance())
        .value();
  }
};

/// The arm's frames 2 to 7 are off as Table III says and so is the place.
Case calibrated(const ArtefactKnowledge& knowledge, const IdentificationOptions& options,
                double tolerance_share = 1.0) {
  Case made{.problem = drawn::problem(knowledge), .options = options, .result = {}};
  for (auto& tolerance : made.problem.tolerances) {
    if (tolerance) *tolerance *= tolerance_share;
  }
  made.problem.attainable = attainable_parameters(made.problem, options.identifiability);
  made.options.robust = false;
  made.options.measure_noise = false;
  UniformChance chance(4);
  const drawn::Truth truth = drawn::truth_of(
      made.problem, paper::table3(), Eigen::VectorXd::Zero(std::ssize(made.problem.artefact.parameters)));
  made.problem.touches = drawn::touches(truth, {.block = knowledge.faces}, chance);
  made.result = identify(made.problem, made.options);
  EXPECT_EQ(made.result.status, IdentificationStatus::kConverged) << made.result.message;
  return made;
}

std::vector<MonteCarloDraw> draw(const MonteCarlo& simulation, int count) {
  std::vector<MonteCarloDraw> draws;
  for (int i = 0; i < count; ++i) draws.push_back(simulation.draw(static_cast<std::uint64_t>(i)));
  return draws;
}

/// What 1500 draws can tell of a root mean square that a few directions make.
constexpr int kDraws = 1500;
constexpr double kDrawnShare = 0.06;

void expect_linear_and_drawn_to_agree(const Case& made) {
  const MonteCarlo simulation = made.simulation();
  const MonteCarloFigures figures = figures_of(draw(simulation, kDraws), simulation.linear_box_rms_m());
  EXPECT_EQ(figures.count, kDraws);
  EXPECT_EQ(figures.converged, kDraws);
  EXPECT_NEAR(figures.linear_over_monte_carlo.value(), 1.0, kDrawnShare);
  EXPECT_NEAR(made.linear_ranges_rms_m() / figures.joint_ranges_rms_m.value(), 1.0, kDrawnShare);
  EXPECT_GT(figures.box_p95_m.value(), figures.box_rms_m.value());
  EXPECT_LT(figures.box_p95_m.value(), 2.5 * figures.box_rms_m.value());
  EXPECT_EQ(figures.warning, "");
}

TEST(MonteCarlo, AgreesWithTheLinearUncertaintyBesideABallAtAnUnknownPlace) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(4);
  knowledge.faces.push_back(drawn::ball());
  knowledge.face_uncertainties.push_back({.std_offset_m = 1e-6, .estimated = true});
  expect_linear_and_drawn_to_agree(calibrated(knowledge, {}));
}

TEST(MonteCarlo, AgreesWithTheLinearUncertaintyOfTheTouchNoise) {
  Case made = calibrated(drawn::certain_artefact(5), {});
  made.problem.tolerances.fill(std::nullopt);  // only the noise
  made.result = identify(made.problem, made.options);
  ASSERT_TRUE(made.result.uncertainty);
  expect_linear_and_drawn_to_agree(made);
}

TEST(MonteCarlo, AgreesWithTheLinearUncertaintyOfTouchesOfUnlikeNoise) {
  for (const Formulation formulation : {Formulation::kSignedDistance, Formulation::kPlaneCoefficients}) {
    Case made = calibrated(drawn::certain_artefact(4), {.formulation = formulation});
    made.problem.tolerances.fill(std::nullopt);  // only the noise
    const double alike_m = made.simulation().linear_box_rms_m().value();
    for (std::size_t i = 0; i < made.problem.touches.size(); i += 3)
      made.problem.touches[i].deviation_m = 10.0 * made.problem.touch_noise_m;
    made.result = identify(made.problem, made.options);
    ASSERT_TRUE(made.result.uncertainty);
    EXPECT_GT(made.simulation().linear_box_rms_m().value(), 1.1 * alike_m);
    expect_linear_and_drawn_to_agree(made);
  }
}

TEST(MonteCarlo, AgreesWithTheLinearUncertaintyOfBlockBallAndTemperature) {
  expect_linear_and_drawn_to_agree(calibrated(drawn::uncertain_artefact(5), {}, 0.1));
}

TEST(MonteCarlo, AgreesWithTheLinearUncertaintyOfAPriorAndOfACertifiedLength) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  for (FaceUncertainty& face : knowledge.face_uncertainties) face = {0.0, 5.8e-5, true};
  knowledge.face_uncertainties[0] = knowledge.face_uncertainties[1] = {5e-6, 5.8e-5, false};
  knowledge.lengths = {{.faces = {1, 3}, .value_m = 0.150, .std_m = 20e-6}};
  IdentificationOptions options;
  options.prior = true;
  expect_linear_and_drawn_to_agree(calibrated(knowledge, options));
}

TEST(MonteCarlo, CountsWhatTheTouchesLeaveOfSecondHarmonics) {
  Case made = calibrated(drawn::certain_artefact(5), {}, 0.1);
  const double before_m = made.simulation().linear_box_rms_m().value();
  for (int i = second_harmonic_position(0); is_second_harmonic(i); ++i)
    made.problem.nongeometric_std[static_cast<std::size_t>(i)] = 2e-4;
  made.result = identify(made.problem, made.options);
  EXPECT_GT(made.simulation().linear_box_rms_m().value(), 1.1 * before_m);
  expect_linear_and_drawn_to_agree(made);
}

TEST(MonteCarlo, CountsAComplianceThatWasNotEstimatedAndTheMasses) {
  Case made = calibrated(drawn::certain_artefact(5), {}, 0.1);
  made.problem.nominal.masses[3] = {30.0, {0.2, 0.0, 0.1}};
  made.problem.nominal.masses[6] = {10.0, {0.0, 0.0, 0.1}};
  const double before_m = made.simulation().linear_box_rms_m().value();
  made.problem.nongeometric_std[compliance_position(1)] = 2e-6;
  made.problem.nongeometric_std[compliance_position(2)] = 3e-6;
  made.result = identify(made.problem, made.options);
  EXPECT_GT(made.simulation().linear_box_rms_m().value(), 1.2 * before_m);
  expect_linear_and_drawn_to_agree(made);
}

TEST(MonteCarlo, EstimatesTheComplianceWhereItWasEstimated) {
  Case made = calibrated(drawn::certain_artefact(5), {}, 0.1);
  made.problem.nominal.masses[3] = {30.0, {0.2, 0.0, 0.1}};
  made.problem.nominal.masses[6] = {10.0, {0.0, 0.0, 0.1}};
  made.problem.nongeometric_std[compliance_position(1)] = 2e-6;
  made.problem.nongeometric_std[compliance_position(2)] = 3e-6;
  made.options.stiffness = true;
  made.result = identify(made.problem, made.options);
  ASSERT_EQ(made.result.nongeometric.size(), 2U);
  expect_linear_and_drawn_to_agree(made);
}

TEST(MonteCarlo, CountsTheGearsOnceMoreAtTheTip) {
  Case made = calibrated(drawn::certain_artefact(5), {}, 0.1);
  made.problem.gear_std_rad.setConstant(1e-4);
  made.result = identify(made.problem, made.options);
  expect_linear_and_drawn_to_agree(made);
}

TEST(MonteCarlo, CountsTheDriftAsOneDisplacementOfTheWholeRun) {
  Case made = calibrated(drawn::uncertain_artefact(4), {});
  made.problem.drift_m = 1.5e-4;
  made.problem.drift_uncertainty = {1e-4, 6.0};
  made.result = identify(made.problem, made.options);
  expect_linear_and_drawn_to_agree(made);
}

TEST(MonteCarlo, TheSameNumberGivesTheSameDrawWheneverItIsMade) {
  const Case made = calibrated(drawn::uncertain_artefact(5), {});
  const MonteCarlo one = made.simulation(), other = made.simulation();
  const std::vector<MonteCarloDraw> forwards = draw(one, 5);
  for (int i = 4; i >= 0; --i) {
    const MonteCarloDraw again = other.draw(static_cast<std::uint64_t>(i));
    EXPECT_EQ(again.box_mean_square_m2, forwards[static_cast<std::size_t>(i)].box_mean_square_m2);
    EXPECT_EQ(again.joint_ranges_mean_square_m2,
              forwards[static_cast<std::size_t>(i)].joint_ranges_mean_square_m2);
    EXPECT_EQ(again.tip_error_m, forwards[static_cast<std::size_t>(i)].tip_error_m);
  }
  EXPECT_NE(forwards[0].box_mean_square_m2, forwards[1].box_mean_square_m2);
}

TEST(MonteCarlo, ThatEndsElsewhereThanTheLinearFigureIsWarnedOf) {
  const Case made = calibrated(drawn::certain_artefact(5), {});
  const MonteCarlo simulation = made.simulation();
  const std::vector<MonteCarloDraw> draws = draw(simulation, 400);
  const double linear_m = simulation.linear_box_rms_m().value();
  EXPECT_EQ(figures_of(draws, linear_m).warning, "");
  EXPECT_THAT(figures_of(draws, 1.5 * linear_m).warning, HasSubstr("% larger than that of 400"));
  EXPECT_THAT(figures_of(draws, 0.5 * linear_m).warning, HasSubstr("% smaller than that of 400"));
}

MonteCarloDraw drawn_with(double rms_m) {
  return {.converged = true,
          .box_mean_square_m2 = rms_m * rms_m,
          .joint_ranges_mean_square_m2 = 4.0 * rms_m * rms_m,
          .tip_error_m = rms_m};
}

TEST(MonteCarloFigures, AreThoseOfTheDrawsThatConverged) {
  std::vector<MonteCarloDraw> draws(20, drawn_with(3e-5));
  draws[7] = drawn_with(9e-5);
  draws.emplace_back();
  const MonteCarloFigures figures = figures_of(draws, 3e-5);
  EXPECT_EQ(figures.count, 21);
  EXPECT_EQ(figures.converged, 20);
  const double rms_m = std::sqrt((19.0 * 9e-10 + 81e-10) / 20.0);
  EXPECT_NEAR(figures.box_rms_m.value(), rms_m, 1e-12);
  EXPECT_NEAR(figures.joint_ranges_rms_m.value(), 2.0 * rms_m, 1e-12);
  EXPECT_EQ(figures.box_p95_m, 3e-5) << "19 of 20 are 95 %";
  EXPECT_NEAR(figures.linear_over_monte_carlo.value(), 3e-5 / rms_m, 1e-9);
  EXPECT_THAT(figures.warning, HasSubstr("1 of 21 simulated calibrations did not converge"));
  EXPECT_THAT(figures.warning, ::testing::Not(HasSubstr("smaller"))) << "one draw of twenty makes the rest";
}

TEST(MonteCarloFigures, AreAbsentWithoutDrawsOrALinearFigure) {
  EXPECT_FALSE(figures_of({}, 1e-5).box_rms_m);
  const std::vector<MonteCarloDraw> failed(3);
  EXPECT_FALSE(figures_of(failed, 1e-5).joint_ranges_rms_m);
  const std::vector<MonteCarloDraw> draws(10, drawn_with(3e-5));
  const MonteCarloFigures unknown = figures_of(draws, std::nullopt);
  EXPECT_FALSE(unknown.box_rms_m || unknown.box_p95_m || unknown.linear_over_monte_carlo);
  EXPECT_TRUE(unknown.joint_ranges_rms_m);
}

}  // namespace
}  // namespace calib
