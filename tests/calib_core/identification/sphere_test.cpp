#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// A ball beside the block as a fifth face.
namespace calib {
namespace {

using ::testing::HasSubstr;

constexpr double kDeclaredNoiseMetres = 1e-6;  // the touches themselves are exact
constexpr std::size_t kSphere = 4;             // index of its face

ArtefactKnowledge block_and_ball(double cap_half_angle_deg = 100.0) {
  ArtefactKnowledge knowledge = drawn::certain_artefact(4);
  knowledge.faces.push_back(drawn::ball(cap_half_angle_deg));
  knowledge.face_uncertainties.push_back({.estimated = true});
  return knowledge;
}

std::vector<Touch> touches_on(const ArtefactKnowledge& knowledge, const drawn::Truth& truth, int count,
                              UniformChance& chance, double noise_m = 0.0) {
  return drawn::touches(truth, {.count = count, .noise_m = noise_m, .block = knowledge.faces}, chance);
}

/// The ball stands a millimetre or two from where its drawing has it.
Eigen::VectorXd moved_ball(const Artefact& artefact) {
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(std::ssize(artefact.parameters));
  errors.head<3>() << 1.2e-3, -0.7e-3, 2.1e-3;
  return errors;
}

TEST(Sphere, HasRowsThatAreTheDerivativesOfItsDistances) {
  ArtefactKnowledge knowledge = block_and_ball();
  knowledge.face_uncertainties[kSphere] = {.std_offset_m = 1e-5, .std_center_m = 1e-3};
  knowledge.std_radius_m = 5e-6;
  knowledge.thermal_expansion_per_k = 2.36e-5;
  knowledge.std_temperature_k = 1.0;
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(31);
  const auto truth = drawn::truth_of(problem, paper::table3(), moved_ball(problem.artefact));
  problem.touches = touches_on(knowledge, truth, 40, chance);
  std::vector<int> columns(kErrorParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  std::vector<std::size_t> all(problem.touches.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  LeastSquares fit(problem, {.prior = true}, columns, all);
  Estimate here{.artefact = Eigen::VectorXd::Zero(std::ssize(problem.artefact.parameters))};
  fit.linearise(here);
  const Eigen::MatrixXd rows = fit.noise_unit_m() * fit.rows();
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
  }
}

TEST(Sphere, AtAnUnknownPlaceGivesTheArmsErrorsAndItsOwnCentre) {
  const ArtefactKnowledge knowledge = block_and_ball();
  IdentificationProblem problem = drawn::problem(knowledge, kDeclaredNoiseMetres);
  ASSERT_EQ(problem.artefact.parameters.size(), 3u);
  EXPECT_EQ(problem.artefact.parameters[0].name, "plane5_center_x");
  UniformChance chance(32);
  const auto columns = attainable_set(problem.nominal, problem.artefact, {}).columns;
  const auto truth =
      drawn::truth_of(problem, drawn::errors_on(columns, chance), moved_ball(problem.artefact));
  problem.touches = touches_on(knowledge, truth, 125, chance);
  const IdentificationResult result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), 25u);
  EXPECT_TRUE(result.rejected.empty());
  EXPECT_LT((result.errors.head<kErrorParameterCount>() - truth.errors).norm(), 1e-8);
  EXPECT_LT((result.artefact_errors - truth.artefact_errors).norm(), 1e-8);
  for (const FaceDistances& distances : result.distances) EXPECT_LT(distances.calibrated_rms_m, 1e-9);
}

TEST(Sphere, IsAsFarOffAsItsUncertaintySays) {
  const ArtefactKnowledge knowledge = block_and_ball();
  const IdentificationProblem cell = drawn::problem(knowledge);
  UniformChance chance(33);
  const auto columns = attainable_set(cell.nominal, cell.artefact, {}).columns;
  constexpr int kDraws = 40;
  double chi_square = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    IdentificationProblem problem = cell;
    const auto truth =
        drawn::truth_of(problem, drawn::errors_on(columns, chance), moved_ball(problem.artefact));
    problem.touches = touches_on(knowledge, truth, 125, chance, study::kTouchNoiseMetres);
    for (auto& tolerance : problem.tolerances) tolerance = 1e-9;  // what is not identified is exact
    const IdentificationResult result = identify(problem, {.robust = false, .hold_weak = false});
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    chi_square += (result.artefact_errors - truth.artefact_errors)
                      .cwiseQuotient(result.uncertainty->artefact_std)
                      .squaredNorm();
  }
  EXPECT_NEAR(chi_square / (3.0 * kDraws), 1.0, 0.4);  // three standard deviations of its mean
}

TEST(Sphere, ThatIsTouchedFromOneSideOnlyIsRefusedByName) {
  for (const bool prior : {false, true}) {
    ArtefactKnowledge knowledge = block_and_ball(30.0);  // 5 degrees within the position error
    IdentificationProblem problem = drawn::problem(knowledge);
    UniformChance chance(34);
    const auto truth = drawn::truth_of(problem, paper::table3(), moved_ball(problem.artefact));
    problem.touches = touches_on(knowledge, truth, 125, chance);
    IdentificationOptions options;
    options.prior = prior;
    const IdentificationResult refused = identify(problem, options);
    EXPECT_EQ(refused.status, IdentificationStatus::kUnobservable);
    EXPECT_THAT(refused.message, HasSubstr("the 25 touches on plane 5, a sphere, are from one side only"));
    EXPECT_THAT(refused.message, HasSubstr("/faces/4/place \"known\" with std_center_mm"));
    EXPECT_FALSE(refused.uncertainty);

    knowledge.face_uncertainties[kSphere] = {.std_center_m = 1e-3};  // as the sentence says
    problem.artefact = make_artefact(knowledge);
    const IdentificationResult found = identify(problem, options);
    EXPECT_EQ(found.status, IdentificationStatus::kConverged) << found.message;
  }
}

TEST(Sphere, ThatIsTouchedInOnePlaneOnlyIsRefusedToo) {
  const ArtefactKnowledge knowledge = block_and_ball();
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(35);
  const auto truth = drawn::truth_of(problem, ErrorVector::Zero(), Eigen::VectorXd::Zero(3));
  problem.touches = touches_on(knowledge, truth, 1'000, chance);
  std::erase_if(problem.touches, [&](const Touch& touch) {
    const Eigen::Vector3d tip_m = forward_kinematics(problem.nominal, touch.joints).translation();
    return static_cast<std::size_t>(touch.face) == kSphere &&
           std::abs(normal_at(problem.artefact.contact_planes[kSphere], tip_m).x()) > 0.1;
  });
  const IdentificationResult result = identify(problem, {});
  EXPECT_EQ(result.status, IdentificationStatus::kUnobservable);
  EXPECT_THAT(result.message, HasSubstr("a sphere, are from one side only"));
}

TEST(Sphere, ThatNobodyTouchedIsNamed) {
  IdentificationProblem problem = drawn::problem(block_and_ball());
  UniformChance chance(36);
  const auto truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd::Zero(3));
  problem.touches = drawn::touches(truth, {.count = 100, .faces = {0, 1, 2, 3}}, chance);
  const IdentificationResult result = identify(problem, {});
  EXPECT_EQ(result.status, IdentificationStatus::kUnobservable);
  EXPECT_THAT(result.message, HasSubstr("plane5_center_x, plane5_center_y, plane5_center_z"));
}

TEST(Sphere, HasNoPlaneCoefficients) {
  const ArtefactKnowledge knowledge = block_and_ball();
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(37);
  const auto truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd::Zero(3));
  problem.touches = touches_on(knowledge, truth, 125, chance);
  const IdentificationResult result = identify(problem, {.formulation = Formulation::kPlaneCoefficients});
  EXPECT_EQ(result.status, IdentificationStatus::kBadInput);
  EXPECT_THAT(result.message, HasSubstr("plane 5 is a sphere, which has no plane coefficients"));
}

TEST(Sphere, GivesTheScaleThatPlanesThroughOnePointDoNot) {
  ArtefactKnowledge knowledge = block_and_ball();
  knowledge.faces.erase(knowledge.faces.begin() + 3);  // planes 1, 2 and 3 meet in a corner
  knowledge.face_uncertainties.erase(knowledge.face_uncertainties.begin() + 3);
  const auto scale_of = [&](std::vector<int> faces) {
    ArtefactKnowledge touched = knowledge;
    if (faces.size() == 3) touched.faces.pop_back(), touched.face_uncertainties.pop_back();
    IdentificationProblem problem = drawn::problem(touched);
    UniformChance chance(38);
    const auto truth = drawn::truth_of(problem, ErrorVector::Zero(),
                                       Eigen::VectorXd::Zero(std::ssize(problem.artefact.parameters)));
    problem.touches =
        drawn::touches(truth, {.count = 160, .faces = std::move(faces), .block = touched.faces}, chance);
    const IdentificationResult result = identify(problem, {.robust = false});
    EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    return result.scale.value();
  };
  EXPECT_THAT(scale_of({0, 1, 2}).warning, HasSubstr("no length was touched"));
  const ScaleCheck with_ball = scale_of({0, 1, 2, 3});
  EXPECT_EQ(with_ball.source, ScaleSource::kBlock);
  EXPECT_EQ(with_ball.warning, "");
}

}  // namespace
}  // namespace calib
