#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// A ring with a bore beside the block as a fifth face.
namespace calib {
namespace {

using ::testing::HasSubstr;

constexpr double kBoreNoiseMetres = 1e-6;  // the touches themselves are exact
constexpr std::size_t kBore = 4;           // index of its face
constexpr double kBoreTiltStdRadians = 5e-3;

ArtefactKnowledge block_and_bore(double wall_half_angle_deg = 180.0) {
  ArtefactKnowledge knowledge = drawn::certain_artefact(4);
  knowledge.faces.push_back(drawn::bore(wall_half_angle_deg));
  knowledge.face_uncertainties.push_back({.std_tilt_rad = kBoreTiltStdRadians, .estimated = true});
  return knowledge;
}

std::vector<Touch> touches_with_bore(const ArtefactKnowledge& knowledge, const drawn::Truth& truth, int count,
                                     UniformChance& chance, double noise_m = 0.0) {
  return drawn::touches(truth, {.count = count, .noise_m = noise_m, .block = knowledge.faces}, chance);
}

/// The ring lies a millimetre or two from where its drawing has it, and leans.
Eigen::VectorXd moved_ring(const Artefact& artefact) {
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(std::ssize(artefact.parameters));
  errors.head<4>() << 1.2e-3, -0.7e-3, 3e-3, -4e-3;
  return errors;
}

TEST(Bore, HasRowsThatAreTheDerivativesOfItsDistances) {
  ArtefactKnowledge knowledge = block_and_bore();
  knowledge.face_uncertainties[kBore].std_offset_m = 1e-5;
  knowledge.std_radius_m = 5e-6;
  knowledge.std_pretravel_m = 2e-6;
  knowledge.thermal_expansion_per_k = 2.36e-5;
  knowledge.std_temperature_k = 1.0;
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(41);
  const auto truth = drawn::truth_of(problem, paper::table3(), moved_ring(problem.artefact));
  problem.touches = touches_with_bore(knowledge, truth, 40, chance);
  std::vector<int> columns(kErrorParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  std::vector<std::size_t> all(problem.touches.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  LeastSquares fit(problem, {.prior = true}, columns, all);
  Estimate here{.artefact = Eigen::VectorXd::Zero(std::ssize(problem.artefact.parameters))};
  fit.linearise(here);
  const Eigen::MatrixXd rows = fit.noise_unit_m() * fit.rows();
  ASSERT_EQ(rows.cols(), kErrorParameterCount + 8);  // axis, tilts, radius, ball, pre-travel, temperature
  const auto residuals_at = [&](Eigen::Index unknown, double step) {
    Estimate beside = here;
    (unknown < kErrorParameterCount ? beside.arm[unknown]
                                    : beside.artefact[unknown - kErrorParameterCount]) += step;
    fit.linearise(beside);
    return fit.residuals_m();
  };
  for (Eigen::Index unknown = 0; unknown < rows.cols(); ++unknown) {
    constexpr double kStep = 1e-6;
    const Eigen::VectorXd slope =
        (residuals_at(unknown, kStep) - residuals_at(unknown, -kStep)) / (2.0 * kStep);
    EXPECT_LT((rows.col(unknown) - slope).lpNorm<Eigen::Infinity>(), 1e-8) << unknown;
    if (unknown < kErrorParameterCount) continue;
    EXPECT_GT(rows.col(unknown).lpNorm<Eigen::Infinity>(), 1e-7) << unknown;
  }
}

TEST(Bore, AtAnUnknownPlaceGivesTheArmsErrorsAndItsOwnAxis) {
  const ArtefactKnowledge knowledge = block_and_bore();
  IdentificationProblem problem = drawn::problem(knowledge, kBoreNoiseMetres);
  ASSERT_EQ(problem.artefact.parameters.size(), 4u);
  EXPECT_EQ(problem.artefact.parameters[0].name, "plane5_axis_u");
  EXPECT_EQ(problem.artefact.parameters[3].name, "plane5_tilt_v");
  UniformChance chance(42);
  const auto columns = attainable_set(problem.nominal, problem.artefact, {}).columns;
  const auto truth =
      drawn::truth_of(problem, drawn::errors_on(columns, chance), moved_ring(problem.artefact));
  problem.touches = touches_with_bore(knowledge, truth, 150, chance);
  const IdentificationResult result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), 25u);
  EXPECT_TRUE(result.rejected.empty());
  // Exact but for the prior of the tilts, which is weak against touches this good.
  EXPECT_LT((result.errors.head<kErrorParameterCount>() - truth.errors).norm(), 1e-6);
  EXPECT_LT((result.artefact_errors - truth.artefact_errors).norm(), 5e-6);
  for (const FaceDistances& distances : result.distances) EXPECT_LT(distances.calibrated_rms_m, 1e-7);
}

TEST(Bore, IsAsFarOffAsItsUncertaintySays) {
  const ArtefactKnowledge knowledge = block_and_bore();
  const IdentificationProblem cell = drawn::problem(knowledge);
  UniformChance chance(43);
  const auto columns = attainable_set(cell.nominal, cell.artefact, {}).columns;
  constexpr int kDraws = 40;
  double chi_square = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    IdentificationProblem problem = cell;
    Eigen::VectorXd ring = moved_ring(problem.artefact);
    for (const Eigen::Index tilt : {2, 3}) ring[tilt] = kBoreTiltStdRadians * study::normal(chance);
    const auto truth = drawn::truth_of(problem, drawn::errors_on(columns, chance), ring);
    problem.touches = touches_with_bore(knowledge, truth, 125, chance, study::kTouchNoiseMetres);
    for (auto& tolerance : problem.tolerances) tolerance = 1e-9;  // what is not identified is exact
    const IdentificationResult result = identify(problem, {.robust = false, .hold_weak = false});
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    chi_square += (result.artefact_errors - truth.artefact_errors)
                      .cwiseQuotient(result.uncertainty->artefact_std)
                      .squaredNorm();
  }
  EXPECT_NEAR(chi_square / (4.0 * kDraws), 1.0, 0.35);  // three standard deviations of its mean
}

TEST(Bore, ThatIsTouchedOnOneSideOnlyIsRefusedByName) {
  ArtefactKnowledge knowledge = block_and_bore(30.0);  // 13 degrees within the position error
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(44);
  const auto truth = drawn::truth_of(problem, paper::table3(), moved_ring(problem.artefact));
  problem.touches = touches_with_bore(knowledge, truth, 125, chance);
  const IdentificationResult refused = identify(problem, {});
  EXPECT_EQ(refused.status, IdentificationStatus::kUnobservable);
  EXPECT_THAT(refused.message, HasSubstr("the 25 touches on plane 5, a bore, are on one side of it only"));
  EXPECT_THAT(refused.message, HasSubstr("/faces/4/place \"known\" with std_axis_mm"));
  EXPECT_FALSE(refused.uncertainty);

  knowledge.face_uncertainties[kBore] = {.std_tilt_rad = kBoreTiltStdRadians, .std_center_m = 1e-3};
  problem.artefact = make_artefact(knowledge);  // as the sentence says
  const IdentificationResult found = identify(problem, {});
  EXPECT_EQ(found.status, IdentificationStatus::kConverged) << found.message;
}

TEST(Bore, ThatNobodyTouchedIsNamed) {
  IdentificationProblem problem = drawn::problem(block_and_bore());
  UniformChance chance(46);
  const auto truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd::Zero(4));
  problem.touches = drawn::touches(truth, {.count = 100, .faces = {0, 1, 2, 3}}, chance);
  const IdentificationResult result = identify(problem, {});
  EXPECT_EQ(result.status, IdentificationStatus::kUnobservable);
  EXPECT_THAT(result.message, HasSubstr("plane5_axis_u, plane5_axis_v"));
}

TEST(Bore, HasNoPlaneCoefficientsAndIsWiderThanTheBall) {
  const ArtefactKnowledge knowledge = block_and_bore();
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(47);
  const auto truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd::Zero(4));
  problem.touches = touches_with_bore(knowledge, truth, 125, chance);
  IdentificationResult result = identify(problem, {.formulation = Formulation::kPlaneCoefficients});
  EXPECT_EQ(result.status, IdentificationStatus::kBadInput);
  EXPECT_THAT(result.message, HasSubstr("plane 5 is a bore, which has no plane coefficients"));
  problem.artefact.contact_planes[kBore].offset_m += 0.040;
  result = identify(problem, {});
  EXPECT_EQ(result.status, IdentificationStatus::kBadInput);
  EXPECT_THAT(result.message, HasSubstr("no wider than the stylus ball"));
}

TEST(Bore, GivesTheScaleThatPlanesThroughOnePointDoNot) {
  ArtefactKnowledge knowledge = block_and_bore();
  knowledge.faces.erase(knowledge.faces.begin() + 3);  // planes 1, 2 and 3 meet in a corner
  knowledge.face_uncertainties.erase(knowledge.face_uncertainties.begin() + 3);
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(48);
  const auto truth = drawn::truth_of(problem, ErrorVector::Zero(), Eigen::VectorXd::Zero(4));
  problem.touches = touches_with_bore(knowledge, truth, 160, chance);
  const IdentificationResult result = identify(problem, {.robust = false});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.scale->source, ScaleSource::kBlock);
  EXPECT_EQ(result.scale->warning, "");
}

}  // namespace
}  // namespace calib
