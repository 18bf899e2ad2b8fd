#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// What the maker's tolerances add to the touches.
namespace calib {
namespace {

using ::testing::HasSubstr;

IdentificationOptions with_prior() {
  IdentificationOptions options;
  options.prior = true;
  return options;
}

/// Everything the touches show at all, however weakly.
IdentificationOptions plain() {
  IdentificationOptions options;
  options.hold_weak = false;
  options.robust = false;
  return options;
}

IdentificationProblem cell(const ArtefactKnowledge& knowledge) {
  IdentificationProblem problem = drawn::problem(knowledge);
  problem.attainable = attainable_parameters(problem, {});
  return problem;
}

/// A drawn cell that the nominal arm finds at all: its touches are no farther off than is taken for a touch.
drawn::Truth touched_truth(IdentificationProblem& problem, const drawn::Manner& manner,
                           UniformChance& chance) {
  for (;;) {
    drawn::Truth truth = drawn::draw_truth(problem, chance);
    problem.touches = drawn::touches(truth, manner, chance);
    if (drawn::nominal_position_error_m(problem, problem.touches) < kFarOffMetres) return truth;
  }
}

/// Root mean square tip errors over simulated calibrations.
struct TipErrors {
  double over_ranges_m = 0.0;
  double at_block_m = 0.0;
};

/// The same draws for each of the ways to identify; those where any of them does not converge do not count.
std::vector<TipErrors> simulate(const ArtefactKnowledge& knowledge, const drawn::Manner& manner,
                                const std::vector<IdentificationOptions>& ways) {
  constexpr int kDraws = 200;
  IdentificationProblem problem = cell(knowledge);
  std::vector<TipErrors> errors(ways.size());
  UniformChance chance(20111102);
  int counted = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const drawn::Truth truth = touched_truth(problem, manner, chance);
    std::vector<IdentificationResult> results;
    for (const IdentificationOptions& way : ways) results.push_back(identify(problem, way));
    EXPECT_EQ(results.back().status, IdentificationStatus::kConverged) << results.back().message;
    if (!std::ranges::all_of(results, [](const IdentificationResult& result) {
          return result.status == IdentificationStatus::kConverged;
        })) {
      continue;
    }
    ++counted;
    for (std::size_t way = 0; way < ways.size(); ++way) {
      const KinematicModel& found = results[way].calibrated;
      errors[way].over_ranges_m += drawn::tip_mean_square_over_ranges(found, truth.arm);
      errors[way].at_block_m += drawn::tip_mean_square_over_touches(found, truth.arm, problem.touches);
    }
  }
  EXPECT_GT(counted, kDraws / 2);
  for (TipErrors& error : errors) {
    error = {std::sqrt(error.over_ranges_m / counted), std::sqrt(error.at_block_m / counted)};
  }
  return errors;
}

struct Comparison {
  std::string name;
  ArtefactKnowledge knowledge;
  int touch_count = 0;
  double tilt_max_deg = 0.0;
  double times_better = 1.0;
};

class AgainstThePlainSolution : public ::testing::TestWithParam<Comparison> {};

TEST_P(AgainstThePlainSolution, ThePriorIsNeverWorse) {
  const Comparison& comparison = GetParam();
  const auto errors = simulate(
      comparison.knowledge,
      {.count = comparison.touch_count, .tilt_max_rad = radians_from_degrees(comparison.tilt_max_deg)},
      {plain(), with_prior()});
  RecordProperty("plain_um", std::to_string(1e6 * errors[0].over_ranges_m));
  RecordProperty("prior_um", std::to_string(1e6 * errors[1].over_ranges_m));
  EXPECT_LE(errors[1].over_ranges_m * comparison.times_better, errors[0].over_ranges_m);
  EXPECT_LE(errors[1].at_block_m * comparison.times_better, errors[0].at_block_m);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, AgainstThePlainSolution,
    ::testing::Values(Comparison{"FewTouches", drawn::certain_artefact(4), 40, 45.0, 1.0},
                      Comparison{"ManyTouches", drawn::certain_artefact(4), 148, 45.0, 1.0},
                      Comparison{"UncertainArtefactAndPlate", drawn::uncertain_artefact(5), 100, 45.0, 1.0},
                      Comparison{"TiltsUnder3Degrees", drawn::certain_artefact(4), 100, 3.0, 3.0},
                      Comparison{"TiltsUnder3DegreesWithPlate", drawn::uncertain_artefact(5), 100, 3.0, 1.0}),
    [](const auto& info) { return info.param.name; });

void PrintTo(const Comparison& comparison, std::ostream* out) { *out << comparison.name; }

double predicted_over_ranges_m(const IdentificationResult& result) {
  return region_over_joint_ranges(result.calibrated, tx90::joint_ranges(), std::nullopt, 200)
      .rms_m(result.uncertainty.value().covariance())
      .value();
}

class TouchByTouch : public ::testing::TestWithParam<int> {};

TEST_P(TouchByTouch, ThePredictedTipErrorIsTheSimulatedOne) {
  constexpr int kDraws = 200;
  IdentificationProblem problem = cell(drawn::uncertain_artefact(5));
  UniformChance chance(20111103);
  double predicted = 0.0, simulated = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const drawn::Truth truth = touched_truth(problem, {.count = GetParam()}, chance);
    const auto result = identify(problem, with_prior());
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    predicted += std::pow(predicted_over_ranges_m(result), 2);
    simulated += drawn::tip_mean_square_over_ranges(result.calibrated, truth.arm);
  }
  RecordProperty("predicted_um", std::to_string(1e6 * std::sqrt(predicted / kDraws)));
  EXPECT_NEAR(std::sqrt(simulated / predicted), 1.0, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Touches, TouchByTouch, ::testing::Values(5, 15, 30));

TEST(Prior, IsUsableFromTheFirstTouchAndGetsSurerWithEveryOne) {
  IdentificationProblem problem = cell(drawn::uncertain_artefact(5));
  UniformChance chance(3);
  touched_truth(problem, {.count = 40}, chance);
  const std::vector<Touch> all = problem.touches;
  double before = std::numeric_limits<double>::infinity();
  for (std::size_t count = 1; count <= all.size(); ++count) {
    problem.touches.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    const auto result = identify(problem, with_prior());
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << count << ": " << result.message;
    ASSERT_TRUE(result.errors.allFinite() && result.artefact_errors.allFinite());
    ASSERT_TRUE(result.uncertainty->covariance().allFinite() && result.uncertainty->artefact_std.allFinite());
    EXPECT_TRUE(result.rejected.empty()) << count;
    const double predicted = predicted_over_ranges_m(result);
    EXPECT_LT(predicted, 1.25 * before) << count;  // the noise is measured anew each time
    before = predicted;
    for (int i = 0; i < kErrorParameterCount; ++i) {
      const double std = std::sqrt(result.uncertainty->covariance()(i, i));
      EXPECT_LE(std, problem.tolerances[static_cast<std::size_t>(i)].value() * (1.0 + 1e-9));
    }
  }
  EXPECT_LT(before, 1e-3);
}

TEST(Prior, EstimatesWhatIsUncertainOfTheArtefactAlongWithTheArm) {
  // A prior of 0.2 mm on the ball, which the plate under the block shows.
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.std_radius_m = 0.2e-3;
  IdentificationProblem problem = cell(knowledge);
  UniformChance chance(4);
  const drawn::Truth truth = touched_truth(problem, {.count = 200}, chance);
  const auto result = identify(problem, with_prior());
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  const auto& parameters = problem.artefact.parameters;
  ASSERT_EQ(result.artefact_errors.size(), std::ssize(parameters));
  for (Eigen::Index k = 0; k < result.artefact_errors.size(); ++k) {
    const auto& parameter = parameters[static_cast<std::size_t>(k)];
    const double std = result.uncertainty->artefact_std[k];
    EXPECT_LE(std, parameter.std.value() * (1.0 + 1e-9)) << parameter.name;
    EXPECT_LT(std::abs(result.artefact_errors[k] - truth.artefact_errors[k]), 4.0 * std) << parameter.name;
    if (parameter.kind == ArtefactKind::kStylusRadius) {
      EXPECT_LT(std, 0.1 * knowledge.std_radius_m);
    }
  }
}

TEST(Prior, NamesAParameterThatNeitherTouchesNorAToleranceTell) {
  IdentificationProblem problem = cell(drawn::uncertain_artefact(5));
  UniformChance chance(5);
  touched_truth(problem, {.count = 60}, chance);
  problem.tolerances[static_cast<std::size_t>(error_parameter_index("theta6").value())].reset();
  const auto result = identify(problem, with_prior());
  EXPECT_EQ(result.status, IdentificationStatus::kSingularPrior);
  EXPECT_THAT(result.message, HasSubstr("theta6"));
  EXPECT_FALSE(result.uncertainty || result.scale || result.lack_of_fit);
  EXPECT_EQ(result.errors.norm(), 0.0);
}

TEST(Prior, DoesWithoutAToleranceWhereTheTouchesTell) {
  IdentificationProblem problem = cell(drawn::uncertain_artefact(5));
  UniformChance chance(6);
  touched_truth(problem, {.count = 60}, chance);
  problem.tolerances[static_cast<std::size_t>(error_parameter_index("d3").value())].reset();
  EXPECT_EQ(identify(problem, with_prior()).status, IdentificationStatus::kConverged);
}

TEST(Prior, OfAnImpossibleToleranceIsRefusedByName) {
  IdentificationProblem problem = cell(drawn::uncertain_artefact(5));
  UniformChance chance(7);
  touched_truth(problem, {.count = 60}, chance);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const auto& [tolerance, number] : {std::pair(0.0, "0"), std::pair(-1e-3, "-0.001"),
                                          std::pair(kNaN, "nan"), std::pair(kInfinity, "inf")}) {
    IdentificationProblem arm = problem;
    arm.tolerances[static_cast<std::size_t>(error_parameter_index("alpha4").value())] = tolerance;
    IdentificationProblem ball = problem;
    for (auto& parameter : ball.artefact.parameters) {
      if (parameter.name == "stylus_radius") parameter.std = tolerance;
    }
    for (const auto& [singular, name] : {std::pair(&arm, "alpha4"), std::pair(&ball, "stylus_radius")}) {
      const auto result = identify(*singular, with_prior());
      EXPECT_EQ(result.status, IdentificationStatus::kSingularPrior) << name << " " << tolerance;
      EXPECT_THAT(result.message, HasSubstr(std::string(name) + " is " + number));
      EXPECT_FALSE(result.uncertainty || result.scale || result.lack_of_fit);
    }
  }
}

}  // namespace
}  // namespace calib
