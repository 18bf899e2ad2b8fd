// A probe whose pre-travel depends on the direction of the push: what is known of it is taken off the
// touches, what is not known is in the uncertainty.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/identification/monte_carlo.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "calib_core/uncertainty/touch_patterns.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr SidewaysPretravel kProbe{.tilt_m = 25e-6, .lobes_m = 15e-6, .lobe_direction_rad = 0.4};
constexpr double kQuietMetres = 1e-6;
const IdentificationOptions kPlain{.robust = false, .hold_weak = false, .measure_noise = false};

struct Calibration {
  IdentificationProblem problem;
  drawn::Truth truth;
  IdentificationResult result;
};

/// A cell whose probe is like this, of which that is known; 100 touches are fitted, 50 held out.
Calibration calibrated_with(const SidewaysPretravel& true_probe, const ArtefactKnowledge& knowledge,
                            double noise_m = kQuietMetres, const IdentificationOptions& options = kPlain) {
  Calibration made{.problem = drawn::problem(knowledge, noise_m), .truth = {}, .result = {}};
  UniformChance chance(7);
  // Errors that are identified, so that nothing is regrouped and exact touches leave nothing over.
  const std::vector<int> columns =
      attainable_set(made.problem.nominal, made.problem.artefact, options.identifiability).columns;
  made.truth = drawn::truth_of(made.problem, drawn::errors_on(columns, chance),
                               Eigen::VectorXd::Zero(std::ssize(made.problem.artefact.parameters)));
  for (ContactSurface& plane : made.truth.planes) plane.sideways = true_probe;
  made.problem.touches = drawn::touches(made.truth, {.count = 150, .noise_m = noise_m}, chance);
  for (std::size_t i = 100; i < made.problem.touches.size(); ++i)
    made.problem.touches[i].role = TouchRole::kHeldOut;
  made.result = identify(made.problem, options);
  EXPECT_EQ(made.result.status, IdentificationStatus::kConverged) << made.result.message;
  return made;
}

ArtefactKnowledge knowing(const SidewaysPretravel& probe) {
  ArtefactKnowledge knowledge = drawn::certain_artefact(5);
  knowledge.stylus.sideways = probe;
  return knowledge;
}

double left_over_m(const IdentificationResult& result) { return result.iterations.back().residual_rms_m; }

TEST(KnownPretravel, TakesThePatternOutOfTheResiduals) {
  const Calibration unknown = calibrated_with(kProbe, knowing({}));
  const Calibration known = calibrated_with(kProbe, knowing(kProbe));
  EXPECT_GT(left_over_m(unknown.result), 3.0 * kQuietMetres);
  EXPECT_LT(left_over_m(known.result), 1.1 * kQuietMetres);
  const auto tip_off_m = [](const Calibration& made) {
    return std::sqrt(drawn::tip_mean_square_over_ranges(made.result.calibrated, made.truth.arm));
  };
  EXPECT_GT(tip_off_m(unknown), 3.0 * tip_off_m(known));
}

// The residuals have the known pre-travel at the arm of each iteration: with exact touches nothing is left,
// although the rows leave out how it turns with the arm.
TEST(KnownPretravel, IsTakenAtTheCalibratedArm) {
  const Calibration made = calibrated_with(kProbe, knowing(kProbe), 1e-9);
  EXPECT_LT(left_over_m(made.result), 2e-9);
  EXPECT_LT(made.result.iterations.size(), 10U);
}

// Against differences: the row of a touch by an error of the arm, with the pre-travel at the turned arm. What
// the row leaves out is bounded by the turning that the header of SidewaysPretravel tells.
TEST(KnownPretravel, IsLeftOutOfTheDerivativesWithinItsBound) {
  const Calibration made = calibrated_with(kProbe, knowing(kProbe));
  const std::vector<Touch>& touches = made.problem.touches;
  const auto& planes = made.problem.artefact.contact_planes;
  const Observation observed = observe(made.result.calibrated, planes, touches, Formulation::kSignedDistance);
  const double bound = std::abs(kProbe.tilt_m) + 3.0 * std::abs(kProbe.lobes_m);
  constexpr double kStep = 1e-5;
  for (int column = 0; column < kErrorParameterCount; ++column) {
    const ErrorVector step = kStep * ErrorVector::Unit(column);
    const Eigen::VectorXd slope =
        (signed_distances_m(apply(made.result.calibrated, step), planes, touches) -
         signed_distances_m(apply(made.result.calibrated, ErrorVector(-step)), planes, touches)) /
        (2.0 * kStep);
    const double left_out = (slope - observed.matrix.col(column)).cwiseAbs().maxCoeff();
    const bool is_length = error_parameters()[static_cast<std::size_t>(column)].is_length();
    EXPECT_LT(left_out, is_length ? 1e-8 : 1.01 * bound) << column;
  }
}

// What the budget says one deviation does is what another probe of that size does to the estimate.
TEST(UnknownPretravel, IsASourceOfTheErrorsAndOfTheMeansOfHeldOutTouches) {
  const Calibration made = calibrated_with({}, knowing({}));
  constexpr double kStdMetres = 4e-6;
  IdentificationProblem problem = made.problem;
  problem.artefact.std_sideways_m.setConstant(kStdMetres);
  const IdentificationResult with = identify(problem, kPlain);
  ArmMatrix tilt = ArmMatrix::Zero(), lobes = ArmMatrix::Zero();
  std::vector<double> moved(with.distances.size(), 0.0);
  for (int k = 0; k < 3; ++k) {
    SidewaysPretravel other;
    if (k == 0) other.tilt_m = kStdMetres;
    if (k > 0) other.lobes_m = kStdMetres;
    if (k == 2) other.lobe_direction_rad = radians_from_degrees(30.0);  // the sine
    IdentificationProblem changed = made.problem;
    for (ContactSurface& plane : changed.artefact.contact_planes) plane.sideways = other;
    const IdentificationResult moved_result = identify(changed, kPlain);
    const ArmVector by = moved_result.errors - made.result.errors;
    (k == 0 ? tilt : lobes) += by * by.transpose();
    for (std::size_t i = 0; i < moved.size(); ++i)
      moved[i] += std::pow(
          moved_result.distances[i].calibrated_mean_m - made.result.distances[i].calibrated_mean_m, 2);
  }
  const auto source = [&](const std::string& name) {
    return std::ranges::find(with.uncertainty->sources, name, &UncertaintySource::name)->covariance;
  };
  EXPECT_LT((source("pretravel_tilt") - tilt).norm(), 0.02 * tilt.norm());
  EXPECT_LT((source("lobes") - lobes).norm(), 0.02 * lobes.norm());
  EXPECT_LT((with.uncertainty->held - made.result.uncertainty->held - tilt - lobes).norm(),
            0.02 * (tilt + lobes).norm());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (with.distances[i].role == TouchRole::kFit) continue;
    const double added = std::pow(with.distances[i].calibrated_mean_std_m.value(), 2) -
                         std::pow(made.result.distances[i].calibrated_mean_std_m.value(), 2);
    EXPECT_NEAR(std::sqrt(added), std::sqrt(moved[i]), 0.05 * std::sqrt(moved[i]) + 1e-8) << i;
  }
  EXPECT_EQ(with.errors, made.result.errors) << "it is never estimated";
}

TEST(UnknownPretravel, WithoutADeviationIsNoSource) {
  const Calibration made = calibrated_with({}, knowing({}));
  EXPECT_TRUE(touch_patterns(made.problem).empty());
  for (const UncertaintySource& source : made.result.uncertainty->sources) {
    EXPECT_NE(source.name, "pretravel_tilt");
    EXPECT_NE(source.name, "lobes");
  }
}

// A ball of 5 um and a probe of which 40 um are unknown: what looks like a wrong ball is the probe's doing.
TEST(UnknownPretravel, IsNotTakenForAWrongBall) {
  ArtefactKnowledge knowledge = knowing({});
  knowledge.std_radius_m = 5e-6;
  const Calibration silent = calibrated_with({.tilt_m = 120e-6}, knowledge, 5e-6);
  ASSERT_TRUE(silent.result.scale->contradicted);
  knowledge.std_pretravel_tilt_m = 120e-6;
  const Calibration aware = calibrated_with({.tilt_m = 120e-6}, knowledge, 5e-6);
  EXPECT_LT(*aware.result.scale->contradicted, 0.7 * *silent.result.scale->contradicted);
}

TEST(UnknownPretravel, IsDrawnByTheMonteCarloAsTheBudgetCountsIt) {
  ArtefactKnowledge knowledge = knowing({});
  knowledge.std_pretravel_tilt_m = 60e-6;
  knowledge.std_lobes_m = 30e-6;
  Calibration made = calibrated_with({}, knowledge);
  std::erase_if(made.problem.touches, [](const Touch& touch) { return touch.role != TouchRole::kFit; });
  made.problem.tolerances.fill(std::nullopt);
  made.result = identify(made.problem, kPlain);
  std::vector<std::size_t> fitted(made.problem.touches.size());
  std::iota(fitted.begin(), fitted.end(), std::size_t{0});
  const Box box{"in front of the arm", {-0.3, -0.5, -0.25}, {0.3, 0.0, 0.55}};
  const MonteCarlo simulation(made.problem, kPlain, made.result, fitted,
                              {postures_in_box(made.problem.nominal, tx90::joint_ranges(), box, {}, 40), {}});
  std::vector<MonteCarloDraw> draws;
  for (std::uint64_t i = 0; i < 1500; ++i) draws.push_back(simulation.draw(i));
  const MonteCarloFigures figures = figures_of(draws, simulation.linear_box_rms_m());
  EXPECT_EQ(figures.converged, 1500);
  EXPECT_NEAR(figures.linear_over_monte_carlo.value(), 1.0, 0.06);
}

}  // namespace
}  // namespace calib
