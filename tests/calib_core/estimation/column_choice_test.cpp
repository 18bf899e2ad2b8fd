#include "calib_core/estimation/column_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// What the touches show, why not more, and what is held because they hardly show it.
namespace calib {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

IdentificationProblem touched(const drawn::Manner& manner, std::uint64_t seed = 41,
                              std::size_t face_count = 4) {
  IdentificationProblem problem = drawn::problem(drawn::certain_artefact(face_count));
  UniformChance chance(seed);
  const auto truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd());
  problem.touches = drawn::touches(truth, manner, chance);
  return problem;
}

std::vector<int> weak_ones(const IdentificationResult& result) {
  std::vector<int> weak;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const auto status = result.identifiable.candidates[static_cast<std::size_t>(i)].status;
    if (status == ParameterStatus::kWeak) weak.push_back(i);
  }
  return weak;
}

TEST(RankExplanation, OfASpreadSetNamesTheStylus) {
  const auto result = identify(touched({.count = 100}), {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), 25u);
  EXPECT_EQ(result.attainable.off_axis_count, 27);
  EXPECT_THAT(result.rank_explanation, AllOf(HasSubstr("25 is the most"), HasSubstr("27 with a tip off it")));
  EXPECT_TRUE(weak_ones(result).empty());
}

std::vector<std::size_t> all_of(const IdentificationProblem& problem) {
  std::vector<std::size_t> touches(problem.touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) touches[i] = i;
  return touches;
}

TEST(ChoiceSingularValues, HaveAGapBehindTheIdentifiedParameters) {
  for (const bool estimated : {false, true}) {
    IdentificationProblem problem = touched({.count = 100});
    ArtefactKnowledge knowledge = drawn::certain_artefact(4);
    knowledge.face_uncertainties[3].estimated = estimated;
    problem.artefact = make_artefact(knowledge);
    IdentificationOptions options;
    options.hold_weak = false;
    for (const std::vector<int>& excluded : {std::vector<int>{}, std::vector<int>{3, 21}}) {
      options.identifiability.excluded = excluded;
      const std::size_t count = choose_columns(problem, options, all_of(problem)).columns.size();
      EXPECT_TRUE(!excluded.empty() || (count < 25u) == estimated) << count;
      const std::vector<double> sigma = choice_singular_values(problem, options, all_of(problem));
      ASSERT_EQ(sigma.size(), kErrorParameterCount - excluded.size());
      EXPECT_TRUE(std::ranges::is_sorted(sigma, std::ranges::greater{}));
      EXPECT_GT(sigma[count - 1], 1e9 * sigma[count]) << count;
    }
  }
}

TEST(ChoiceSingularValues, AreThoseOfTheTouchesThatTheChoiceWasMadeWith) {
  const IdentificationProblem problem = touched({.count = 100});
  IdentificationProblem half = problem;
  half.touches.resize(50);
  std::vector<std::size_t> first = all_of(half);
  EXPECT_EQ(choice_singular_values(problem, {}, first), choice_singular_values(half, {}, first));
  // Where along its normal a touch was made does not matter: it is moved onto its nominal plane.
  const PreparedModel nominal = prepare(problem.nominal);
  for (Touch& touch : half.touches) {
    touch =
        moved_onto_plane(nominal, half.artefact.contact_planes[static_cast<std::size_t>(touch.face)], touch);
  }
  const auto moved = choice_singular_values(half, {}, first);
  const auto as_made = choice_singular_values(problem, {}, first);
  for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(moved[i] / as_made[i], 1.0, 1e-6) << i;
}

TEST(RankExplanation, OfATipOffTheAxisSaysNothingOfACrankedOne) {
  IdentificationProblem problem = touched({.count = 100});
  problem.nominal.links[7].d_m += 0.05;
  problem.nominal.links[7].alpha_rad += 0.3;
  for (Touch& touch : problem.touches) {
    touch = moved_onto_plane(apply(problem.nominal, paper::table3()),
                             problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)], touch);
  }
  const auto result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), 27u);
  EXPECT_THAT(result.rank_explanation, HasSubstr("27 is the most"));
}

TEST(RankExplanation, NamesEveryPlaneThatWasNotTouched) {
  for (const auto& [faces, says] : {std::pair(std::vector{0, 1, 2}, "no touch on plane 4;"),
                                    std::pair(std::vector{1, 2}, "no touch on plane 1, plane 4;")}) {
    const auto result = identify(touched({.count = 100, .faces = faces}), {});
    EXPECT_EQ(result.status, IdentificationStatus::kUnobservable);
    EXPECT_THAT(result.message, HasSubstr(says));
    EXPECT_LT(result.identifiable.columns.size(), 25u);
    EXPECT_FALSE(result.uncertainty || result.scale || result.lack_of_fit);
  }
}

TEST(RankExplanation, OfWeakTiltsDoesNotHideThatAPlaneWasNotTouched) {
  for (const double tilt_deg : {0.0, 1.0, 3.0, 10.0}) {
    const auto result = identify(
        touched({.count = 100, .tilt_max_rad = radians_from_degrees(tilt_deg), .faces = {0, 1, 2}}), {});
    EXPECT_EQ(result.status, IdentificationStatus::kUnobservable) << tilt_deg;
    EXPECT_THAT(result.message, HasSubstr("no touch on plane 4")) << tilt_deg;
  }
}

TEST(Scale, OfFacesThatMeetInOnePointIsTheNominalArms) {
  // A cell of three faces only: an arm of any size can touch them.
  IdentificationProblem problem = touched({.count = 100, .faces = {0, 1, 2}});
  problem.artefact.contact_planes.resize(3);
  problem.attainable.reset();
  const auto result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  ASSERT_TRUE(result.scale);
  EXPECT_EQ(result.scale->source, ScaleSource::kPrior);
  EXPECT_THAT(result.scale->warning, HasSubstr("no length was touched"));
  EXPECT_EQ(result.scale->stretch_relative, 0.0);
}

TEST(HeldErrors, MakeTheOthersUncertainByWhatTheyMayBe) {
  IdentificationProblem problem = touched({.count = 100});
  IdentificationOptions options;
  const auto free = identify(problem, options);
  const int d3 = error_parameter_index("d3").value(), r4 = error_parameter_index("r4").value();
  options.identifiability.excluded = {d3};
  const auto held = identify(problem, options);
  ASSERT_EQ(held.status, IdentificationStatus::kConverged) << held.message;
  EXPECT_GT(held.uncertainty->held(r4, r4), 0.0);
  EXPECT_GT(held.uncertainty->std_error(r4), std::sqrt(held.uncertainty->identified(r4, r4)));
  EXPECT_TRUE(free.uncertainty->held.isZero(0.0));
}

class Tilts : public ::testing::TestWithParam<double> {};

TEST_P(Tilts, OfWhatTheyHardlyShowNothingIsPrinted) {
  const double tilt_deg = GetParam();
  const IdentificationProblem problem =
      touched({.count = 100, .tilt_max_rad = radians_from_degrees(tilt_deg)});
  const auto result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  const std::vector<int> weak = weak_ones(result);
  // Several parameters may share a weak direction, and all of them are held.
  EXPECT_GE(weak.size() + result.identifiable.columns.size(), 25u);
  EXPECT_EQ(result.identifiable.columns.size() < 25u, tilt_deg <= 10.0);
  EXPECT_EQ(weak.empty(), tilt_deg > 10.0);
  std::string names;
  for (const int column : weak) {
    const std::string name = error_parameters()[static_cast<std::size_t>(column)].name();
    names += name + " ";
    EXPECT_EQ(result.errors[column], 0.0) << name;
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_THAT(result.warnings.front(), HasSubstr(name));
    const double tolerance = problem.tolerances[static_cast<std::size_t>(column)].value();
    EXPECT_NEAR(result.uncertainty->std_error(column), tolerance, 1e-9) << name;
  }
  RecordProperty("held", names);
  if (tilt_deg <= 3.0) {
    EXPECT_THAT(result.rank_explanation, HasSubstr("degrees everywhere"));
  }
  // What is printed is no guess, whatever makes it uncertain.
  for (const int column : result.identifiable.columns) {
    const bool is_length = error_parameters()[static_cast<std::size_t>(column)].is_length();
    const double std = std::sqrt(result.uncertainty->identified(column, column));
    EXPECT_LE(std, is_length ? kWeakLengthMetres : kWeakAngleRadians) << column;
  }
}

TEST_P(Tilts, ThePredictedTipErrorIsTheSimulatedOneWhateverIsHeld) {
  constexpr int kDraws = 100;
  IdentificationProblem problem = drawn::problem(drawn::certain_artefact(4));
  problem.attainable = attainable_parameters(problem, {});
  UniformChance chance(42);
  IdentificationOptions options;
  options.robust = false;
  double predicted = 0.0, simulated = 0.0;
  for (int draw = 0; draw < kDraws;) {
    const auto truth = drawn::draw_truth(problem, chance);
    problem.touches =
        drawn::touches(truth, {.count = 100, .tilt_max_rad = radians_from_degrees(GetParam())}, chance);
    if (drawn::nominal_position_error_m(problem, problem.touches) > kFarOffMetres) continue;
    ++draw;
    const auto result = identify(problem, options);
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    predicted += std::pow(region_over_joint_ranges(result.calibrated, tx90::joint_ranges(), std::nullopt, 200)
                              .rms_m(result.uncertainty->covariance())
                              .value(),
                          2);
    simulated += drawn::tip_mean_square_over_ranges(result.calibrated, truth.arm);
  }
  RecordProperty("predicted_um", std::to_string(1e6 * std::sqrt(predicted / kDraws)));
  RecordProperty("simulated_um", std::to_string(1e6 * std::sqrt(simulated / kDraws)));
  EXPECT_NEAR(std::sqrt(simulated / predicted), 1.0, 0.25);
}

INSTANTIATE_TEST_SUITE_P(Degrees, Tilts, ::testing::Values(0.0, 1.0, 3.0, 10.0, 45.0));

/// Validation B.1: the same touches again, from the arm that they led to.
class SameTouchesAgain : public ::testing::TestWithParam<std::pair<Formulation, bool>> {};

TEST_P(SameTouchesAgain, LeaveNothingToFind) {
  const auto [formulation, prior] = GetParam();
  IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(5));
  UniformChance chance(43);
  const auto truth =
      drawn::truth_of(problem, paper::table3(), drawn::draw_artefact_errors(problem.artefact, chance));
  problem.touches = drawn::touches(truth, {.count = 100}, chance);
  IdentificationOptions options{.formulation = formulation};
  options.prior = prior;
  const auto first = identify(problem, options);
  ASSERT_EQ(first.status, IdentificationStatus::kConverged) << first.message;
  IdentificationProblem again = problem;
  again.start = first.errors;
  again.columns = first.identifiable.columns;
  const auto second = identify(again, options);
  ASSERT_EQ(second.status, IdentificationStatus::kConverged) << second.message;
  EXPECT_LT((second.errors - first.errors).norm(), 1e-9);
  EXPECT_LT((second.artefact_errors - first.artefact_errors).norm(), 1e-9);
  EXPECT_EQ(second.identifiable.columns, first.identifiable.columns);
}

INSTANTIATE_TEST_SUITE_P(WithNoise, SameTouchesAgain,
                         ::testing::Values(std::pair{Formulation::kSignedDistance, false},
                                           std::pair{Formulation::kPlaneCoefficients, false},
                                           std::pair{Formulation::kSignedDistance, true},
                                           std::pair{Formulation::kPlaneCoefficients, true}));

}  // namespace
}  // namespace calib
