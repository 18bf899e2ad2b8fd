#include "calib_core/estimation/least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "tests/calib_core/drawn_cell.hpp"

/// The linear problem of an iteration against finite differences of what it is the linearisation of.
namespace calib {
namespace {

constexpr double kNoiseMetres = 20e-6;

/// An arm with masses, uncertain faces, one of them estimated, and a certified length.
IdentificationProblem whole_problem() {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.face_uncertainties[4].estimated = true;
  knowledge.lengths = {{{2, 4}, 0.1501, 10e-6}, {{0, 3}, 0.1499, 10e-6}};
  IdentificationProblem problem = drawn::problem(knowledge, kNoiseMetres);
  problem.nominal.masses[4] = {20.0, {0.0, 0.0, -0.25}};
  for (int position = 0; position < kNongeometricCount; ++position) {
    const NongeometricKind kind = nongeometric_parameters()[static_cast<std::size_t>(position)].kind;
    problem.nongeometric_std[static_cast<std::size_t>(position)] = kind == NongeometricKind::kCompliance
                                                                       ? 1e-6
                                                                   : kind == NongeometricKind::kMass ? 0.1
                                                                                                     : 5e-5;
  }
  UniformChance chance(31);
  problem.touches = drawn::touches(drawn::draw_truth(problem, chance), {.count = 60}, chance);
  return problem;
}

std::vector<int> all_columns() {
  std::vector<int> columns(kArmParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

std::vector<std::size_t> all_touches(const IdentificationProblem& problem) {
  std::vector<std::size_t> touches(problem.touches.size());
  std::iota(touches.begin(), touches.end(), 0u);
  return touches;
}

/// Somewhere off the nominal.
Estimate some_estimate(const IdentificationProblem& problem) {
  Estimate estimate;
  estimate.arm.head<kErrorParameterCount>() = 0.5 * paper::table3();
  estimate.artefact.resize(static_cast<Eigen::Index>(problem.artefact.parameters.size()));
  for (Eigen::Index k = 0; k < estimate.artefact.size(); ++k) {
    estimate.artefact[k] = 0.5 * problem.artefact.parameters[static_cast<std::size_t>(k)].std.value_or(1e-4);
  }
  return estimate;
}

Estimate moved(Estimate estimate, Eigen::Index unknown, double by) {
  if (unknown < kArmParameterCount) {
    estimate.arm[unknown] += by;
  } else {
    estimate.artefact[unknown - kArmParameterCount] += by;
  }
  return estimate;
}

double step_of(Eigen::Index unknown) {
  const bool is_compliance =
      unknown >= kErrorParameterCount && unknown < nongeometric_index(harmonic_position(0));
  return is_compliance ? 1e-8 : 1e-6;
}

class WholeProblem : public ::testing::TestWithParam<Formulation> {
 protected:
  IdentificationProblem problem_ = whole_problem();
  IdentificationOptions options_ = [] {
    IdentificationOptions options{.formulation = GetParam()};
    options.prior = true;
    return options;
  }();
};

TEST_P(WholeProblem, HasRowsThatAreTheSlopesOfTheResiduals) {
  LeastSquares fit(problem_, options_, all_columns(), all_touches(problem_));
  const Estimate at = some_estimate(problem_);
  fit.linearise(at);
  const Eigen::MatrixXd rows = fit.rows();
  for (Eigen::Index unknown = 0; unknown < fit.unknown_count(); ++unknown) {
    const double step = step_of(unknown);
    fit.linearise(moved(at, unknown, step));
    const Eigen::VectorXd above = -fit.weighted_targets();
    fit.linearise(moved(at, unknown, -step));
    const Eigen::VectorXd slopes = (above + fit.weighted_targets()) / (2.0 * step);
    // The moments of gravity are held in the derivatives: a share of the deflection, here 1e-3 at most.
    EXPECT_LT((slopes - rows.col(unknown)).norm(),
              1e-6 * rows.norm() / 60.0 + 2e-3 * rows.col(unknown).norm())
        << unknown;
  }
}

TEST_P(WholeProblem, IsItsPriorsWithoutATouch) {
  problem_.touches.clear();
  LeastSquares fit(problem_, options_, all_columns(), {});
  fit.linearise(some_estimate(problem_));
  EXPECT_TRUE(fit.touch_information().isZero(0.0));
  EXPECT_GT(fit.information().diagonal().head(fit.arm_count()).minCoeff(), 0.0);
}

TEST_P(WholeProblem, WeighsRowsByTheNoiseAndInEquationSixByThePlanesDistance) {
  LeastSquares fit(problem_, options_, all_columns(), all_touches(problem_));
  fit.linearise(some_estimate(problem_));
  double mean_square = 0.0;
  const double own = -fit.weighted_targets()[0] / fit.residuals_m()[0];
  const auto& planes = problem_.artefact.contact_planes;
  for (Eigen::Index row = 0; row < fit.residuals_m().size(); ++row) {
    const double weight = -fit.weighted_targets()[row] / fit.residuals_m()[row];
    mean_square += weight * weight / static_cast<double>(fit.residuals_m().size());
    const auto offset_m = [&](Eigen::Index touch) {
      return planes[static_cast<std::size_t>(problem_.touches[static_cast<std::size_t>(touch)].face)]
          .offset_m;
    };
    const double expected =
        GetParam() == Formulation::kSignedDistance ? 1.0 : std::abs(offset_m(0) / offset_m(row));
    EXPECT_NEAR(weight / own, expected, 1e-9 * expected);
  }
  EXPECT_NEAR(std::sqrt(mean_square) * kNoiseMetres, 1.0, 1e-9);
}

TEST_P(WholeProblem, StepsAlongTheSlopeOfChiSquareOverItsCurvature) {
  LeastSquares fit(problem_, options_, all_columns(), all_touches(problem_));
  const Estimate at = some_estimate(problem_);
  fit.linearise(at);
  ASSERT_TRUE(fit.solve());
  const Eigen::VectorXd downhill = fit.information() * fit.step();
  for (Eigen::Index unknown = 0; unknown < fit.unknown_count(); ++unknown) {
    const double step = step_of(unknown);
    const auto chi_square = [&](double by) {
      const Estimate there = moved(at, unknown, by);
      fit.linearise(there);
      return fit.chi_square(there);
    };
    const double slope = (chi_square(step) - chi_square(-step)) / (2.0 * step);
    EXPECT_NEAR(-0.5 * slope, downhill[unknown],
                3e-3 * std::abs(downhill[unknown]) + 1e-4 * downhill.norm() / 60.0)
        << unknown;
  }
}

INSTANTIATE_TEST_SUITE_P(Formulations, WholeProblem,
                         ::testing::Values(Formulation::kSignedDistance, Formulation::kPlaneCoefficients),
                         [](const auto& info) {
                           return info.param == Formulation::kSignedDistance ? "SignedDistance"
                                                                             : "PlaneCoefficients";
                         });

TEST(LeastSquares, ScalingTheColumnsChangesNoStep) {
  const IdentificationProblem problem = whole_problem();
  IdentificationOptions options;
  options.prior = true;
  LeastSquares scaled(problem, options, all_columns(), all_touches(problem));
  options.weights = ColumnScaling::kUnits;
  LeastSquares in_units(problem, options, all_columns(), all_touches(problem));
  scaled.linearise(some_estimate(problem));
  in_units.linearise(some_estimate(problem));
  ASSERT_TRUE(scaled.solve() && in_units.solve());
  for (Eigen::Index k = 0; k < scaled.step().size(); ++k) {
    EXPECT_NEAR(scaled.step()[k], in_units.step()[k], 1e-4 * std::abs(scaled.step()[k]) + 1e-9) << k;
  }
}

TEST(LeastSquares, TouchesLeftOutHaveResidualsButNoSay) {
  const IdentificationProblem problem = whole_problem();
  IdentificationOptions options;
  options.prior = true;
  LeastSquares some(problem, options, all_columns(), all_touches(problem));
  std::vector<bool> kept(problem.touches.size(), true);
  std::vector<std::size_t> rest = all_touches(problem);
  for (const std::size_t out : {50u, 7u}) {
    kept[out] = false;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(out));
  }
  some.keep(kept);
  LeastSquares without(problem, options, all_columns(), rest);
  some.linearise(some_estimate(problem));
  without.linearise(some_estimate(problem));
  EXPECT_LT((some.information() - without.information()).norm(), 1e-12 * without.information().norm());
  EXPECT_EQ(some.degrees_of_freedom(), without.degrees_of_freedom());
  EXPECT_NEAR(some.chi_square(some_estimate(problem)) / without.chi_square(some_estimate(problem)), 1.0,
              1e-12);
  EXPECT_GT(std::abs(some.residuals_m()[7]), 0.0);
  ASSERT_TRUE(some.solve() && without.solve());
  EXPECT_LT((some.step() - without.step()).norm(), 1e-9);
}

}  // namespace
}  // namespace calib
