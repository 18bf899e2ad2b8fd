#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// Faces that are found in place along with the arm: offset and both tilts free.
namespace calib {
namespace {

using ::testing::HasSubstr;

constexpr double kExactNoiseMetres = 1e-6;  // declared; the touches themselves are exact

ArtefactKnowledge with_estimated(std::size_t face_count, const std::vector<std::size_t>& estimated) {
  ArtefactKnowledge knowledge = drawn::certain_artefact(face_count);
  for (const std::size_t face : estimated) knowledge.face_uncertainties[face].estimated = true;
  return knowledge;
}

struct Found {
  IdentificationProblem problem;
  drawn::Truth truth;
  IdentificationResult result;
};

/// Exact touches of a drawn truth. Certified lengths are those of the truth.
Found found_in_place(const ArtefactKnowledge& knowledge, int touch_count) {
  Found found{drawn::problem(knowledge, kExactNoiseMetres), {}, {}};
  UniformChance chance(21);
  const auto columns = attainable_set(found.problem.nominal, found.problem.artefact, {}).columns;
  const Eigen::VectorXd faces = drawn::draw_artefact_errors(found.problem.artefact, chance);
  found.truth = drawn::truth_of(found.problem, drawn::errors_on(columns, chance), faces);
  for (ArtefactEquation& equation : found.problem.artefact.equations) {
    equation.value_m = 0.0;
    for (const auto& [index, weight] : equation.weights) equation.value_m += weight * faces[index];
  }
  found.problem.touches = drawn::touches(found.truth, {.count = touch_count, .noise_m = 0.0}, chance);
  found.result = identify(found.problem, {});
  return found;
}

TEST(EstimatedFaces, FourInPlaceLeaveEighteenOfTheArmsErrors) {
  const Found found = found_in_place(with_estimated(4, {0, 1, 2, 3}), 120);
  ASSERT_EQ(found.result.status, IdentificationStatus::kConverged) << found.result.message;
  EXPECT_EQ(found.problem.artefact.parameters.size(), 12u);
  EXPECT_EQ(found.result.identifiable.columns.size(), 18u);  // the kinematic ones only
  EXPECT_EQ(found.result.attainable.count, 18);
  EXPECT_LT((found.result.errors.head<kErrorParameterCount>() - found.truth.errors).norm(), 1e-8);
  EXPECT_LT((found.result.artefact_errors - found.truth.artefact_errors).norm(), 1e-8);
}

TEST(EstimatedFaces, OfThePlateAreFoundBesideTheKnownBlock) {
  const Found found = found_in_place(with_estimated(5, {4}), 150);
  ASSERT_EQ(found.result.status, IdentificationStatus::kConverged) << found.result.message;
  ASSERT_EQ(found.problem.artefact.parameters.size(), 3u);
  EXPECT_EQ(found.problem.artefact.parameters[0].name, "plane5_offset");
  EXPECT_EQ(found.result.identifiable.columns.size(), 25u);
  EXPECT_LT((found.result.errors.head<kErrorParameterCount>() - found.truth.errors).norm(), 1e-8);
  EXPECT_LT((found.result.artefact_errors - found.truth.artefact_errors).norm(), 1e-8);
  for (const FaceDistances& distances : found.result.distances) {
    EXPECT_LT(distances.calibrated_rms_m, 1e-9) << distances.face;  // from the plane as estimated
    EXPECT_EQ(distances.found_offset_m.has_value(), distances.face == 4);
    if (distances.face != 4) continue;
    EXPECT_NEAR(distances.found_offset_m.value(), found.truth.artefact_errors[0], 1e-8);
  }
}

TEST(EstimatedFaces, AreBoundByACertifiedLength) {
  // The ball is badly known: without the length the plate says nothing of it, with it the step of two faces
  // that look the same way does.
  const auto std_radius_m = [](bool certified) {
    ArtefactKnowledge knowledge = with_estimated(5, {4});
    knowledge.std_radius_m = 0.1e-3;
    if (certified) knowledge.lengths = {{{2, 4}, 0.150, 5e-6}};
    const Found found = found_in_place(knowledge, 150);
    EXPECT_EQ(found.result.status, IdentificationStatus::kConverged) << found.result.message;
    EXPECT_LT((found.result.artefact_errors - found.truth.artefact_errors).cwiseAbs().maxCoeff(),
              certified ? 5e-6 : 0.5e-3);
    EXPECT_EQ(found.problem.artefact.parameters[3].name, "stylus_radius");
    return found.result.uncertainty->artefact_std[3];
  };
  EXPECT_GT(std_radius_m(false), 0.09e-3);
  EXPECT_LT(std_radius_m(true), 0.01e-3);
}

TEST(EstimatedFaces, HoldTheLengthBetweenThem) {
  ArtefactKnowledge knowledge = with_estimated(4, {0, 3});
  knowledge.lengths = {{{0, 3}, 0.150, 5e-6}};
  const Found found = found_in_place(knowledge, 150);
  ASSERT_EQ(found.result.status, IdentificationStatus::kConverged) << found.result.message;
  const auto& equation = found.problem.artefact.equations.at(0);
  double length = 0.0;
  for (const auto& [index, weight] : equation.weights) length += weight * found.result.artefact_errors[index];
  EXPECT_NEAR(length, equation.value_m, 1e-8);
  EXPECT_LT((found.result.errors.head<kErrorParameterCount>() - found.truth.errors).norm(), 1e-7);
}

TEST(EstimatedFaces, ThatNobodyTouchedAreNamed) {
  IdentificationProblem problem = drawn::problem(with_estimated(5, {4}));
  UniformChance chance(22);
  const auto truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd::Zero(3));
  problem.touches = drawn::touches(truth, {.count = 100, .faces = {0, 1, 2, 3}}, chance);
  for (const bool prior : {false, true}) {
    IdentificationOptions options;
    options.prior = prior;
    const auto result = identify(problem, options);
    EXPECT_EQ(result.status,
              prior ? IdentificationStatus::kSingularPrior : IdentificationStatus::kUnobservable);
    EXPECT_THAT(result.message, HasSubstr("plane5_offset, plane5_tilt_u, plane5_tilt_v"));
    EXPECT_FALSE(result.uncertainty || result.scale || result.lack_of_fit);
  }
}

/// The only face across x is found in place: no touch tells it from the block's place along x.
IdentificationProblem without_a_length_along_x() { return drawn::problem(with_estimated(4, {1})); }

TEST(EstimatedFaces, AreAsUncertainAsWhatTheyAreConfoundedWith) {
  const IdentificationProblem cell = without_a_length_along_x();
  ASSERT_EQ(cell.artefact.parameters[0].name, "plane2_offset");
  constexpr int kDraws = 30;
  UniformChance chance(24);
  double squares = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    IdentificationProblem problem = cell;
    const drawn::Truth truth = drawn::draw_truth(problem, chance);
    problem.touches = drawn::touches(truth, {.count = 120}, chance);
    const IdentificationResult result = identify(problem, {});
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    const double std_m = result.uncertainty->artefact_std[0];
    EXPECT_GT(std_m, drawn::kPlaceMetres);
    squares += std::pow((result.artefact_errors[0] - truth.artefact_errors[0]) / std_m, 2);
  }
  EXPECT_NEAR(squares / kDraws, 1.0, 0.75);  // three standard deviations of a variance of 30 figures
}

TEST(EstimatedFaces, AreOfUnknownUncertaintyWhereNoToleranceIsKnown) {
  IdentificationProblem problem = without_a_length_along_x();
  problem.tolerances.fill(std::nullopt);
  UniformChance chance(25);
  const drawn::Truth truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd::Zero(3));
  problem.touches = drawn::touches(truth, {.count = 120}, chance);
  const IdentificationResult result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_FALSE(std::isfinite(result.uncertainty->artefact_std[0]));
  for (const int tilt : {1, 2}) EXPECT_LT(result.uncertainty->artefact_std[tilt], 1e-3);
}

TEST(EstimatedFaces, CostNothingAtTheTipWhenTheRestIsKnown) {
  // The prior knows lengths and place: four faces found in place, noise on the touches.
  const IdentificationProblem cell = drawn::problem(with_estimated(4, {0, 1, 2, 3}));
  constexpr int kDraws = 30;
  UniformChance chance(23);
  IdentificationOptions options;
  options.prior = true;
  double square = 0.0, predicted = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    IdentificationProblem problem = cell;
    for (int i = 0; i < kErrorParameterCount; ++i) {  // the frame is what the arm stands in
      if (error_parameters()[static_cast<std::size_t>(i)].group() == ParameterGroup::kBlockPose) {
        problem.tolerances[static_cast<std::size_t>(i)] = 1e-9;
      }
    }
    const auto truth = drawn::draw_truth(problem, chance);
    problem.touches = drawn::touches(truth, {.count = 120}, chance);
    const auto result = identify(problem, options);
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    square += drawn::tip_mean_square_over_touches(result.calibrated, truth.arm, problem.touches) / kDraws;
    std::vector<JointVector> postures;
    for (const Touch& touch : problem.touches) postures.push_back(touch.joints);
    predicted +=
        std::pow(
            region_over_postures(result.calibrated, postures).rms_m(result.uncertainty->covariance()).value(),
            2) /
        kDraws;
  }
  EXPECT_NEAR(std::sqrt(square / predicted), 1.0, 0.25);
  EXPECT_LT(std::sqrt(square), 1e-3);
}

}  // namespace
}  // namespace calib
