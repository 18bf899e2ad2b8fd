#include "calib_core/identification/identify.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/units.hpp"
#include "tests/calib_core/paper.hpp"

namespace calib {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json read_json(const std::string& name) {
  std::ifstream file(TOUCHCAL_SOURCE_DIR "/tests/data/" + name);
  return json::parse(file);
}

/// 100 exact touches of a robot with the errors of Table III, from an independent program.
std::vector<Touch> exact_touches() {
  std::vector<Touch> touches;
  const json document = read_json("table3-exact.touches.json");
  for (const json& entry : document.at("touches")) {
    Touch touch{.face = entry.at("plane").get<int>() - 1};
    for (int i = 0; i < kJointCount; ++i) {
      touch.joints[i] =
          radians_from_degrees(entry.at("joints_deg").at(static_cast<std::size_t>(i)).get<double>());
    }
    touches.push_back(touch);
  }
  return touches;
}

IdentificationProblem paper_problem(std::vector<Touch> touches) {
  return {paper::nominal(), exact_artefact(paper::planes()), std::move(touches)};
}

IdentificationOptions paper_options(Formulation formulation = Formulation::kSignedDistance) {
  IdentificationOptions options{.formulation = formulation};
  options.identifiability.tried_last = paper::tried_last();
  return options;
}

std::vector<std::string> names(const std::vector<int>& columns) {
  std::vector<std::string> result;
  for (const int column : columns)
    result.push_back(error_parameters()[static_cast<std::size_t>(column)].name());
  return result;
}

const CandidateStatus& candidate(const IdentificationResult& result, const char* name) {
  return result.identifiable.candidates[static_cast<std::size_t>(error_parameter_index(name).value())];
}

void expect_relative(double value, double expected, double tolerance) {
  EXPECT_NEAR(value / expected, 1.0, tolerance) << value << " against " << expected;
}

class ReferenceSolution : public ::testing::TestWithParam<std::pair<Formulation, const char*>> {};

TEST_P(ReferenceSolution, IsReproduced) {
  const auto [formulation, key] = GetParam();
  const json document = read_json("table3-exact.expected.json");
  const json& expected = document.at(key);
  const IdentificationResult result = identify(paper_problem(exact_touches()), paper_options(formulation));

  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(names(result.identifiable.columns), expected.at("identifiable").get<std::vector<std::string>>());
  EXPECT_GT(result.identifiable.smallest_kept,
            1e9 * result.identifiable.largest_dropped);  // a gap, not a threshold
  const auto sigma = expected.at("singular_values_of_W_at_nominal").get<std::vector<double>>();
  ASSERT_EQ(result.singular_values.size(), sigma.size());
  for (std::size_t i = 0; i < sigma.size(); ++i) expect_relative(result.singular_values[i], sigma[i], 1e-9);
  expect_relative(result.iterations.front().condition_number, expected.at("condition_number_at_nominal"),
                  1e-6);
  expect_relative(result.iterations.front().scaled_condition_number,
                  expected.at("scaled_condition_number_at_nominal"), 1e-6);
  expect_relative(result.iterations.back().condition_number, expected.at("condition_number_at_solution"),
                  1e-6);
  for (const auto& [name, error] : document.at("identified_errors").items()) {
    EXPECT_NEAR(result.errors[error_parameter_index(name).value()], error.get<double>(), 1e-9) << name;
  }
  EXPECT_LE(result.iterations.size(), 5u);
}

INSTANTIATE_TEST_SUITE_P(BothFormulations, ReferenceSolution,
                         ::testing::Values(std::pair{Formulation::kSignedDistance, "signed_distance"},
                                           std::pair{Formulation::kPlaneCoefficients,
                                                     "plane_coefficients (eq. 6)"}),
                         [](const auto& info) {
                           return info.param.first == Formulation::kSignedDistance ? "SignedDistance"
                                                                                   : "PlaneCoefficients";
                         });

TEST(Identify, GroupsR2WithR3AndCallsThetaSevenWithoutEffect) {
  const IdentificationResult result = identify(paper_problem(exact_touches()), paper_options());
  const CandidateStatus& r2 = candidate(result, "r2");
  ASSERT_EQ(r2.status, ParameterStatus::kGrouped);
  ASSERT_EQ(r2.grouped_with.size(), 1u);
  EXPECT_EQ(r2.grouped_with.front().first, error_parameter_index("r3").value());
  EXPECT_NEAR(r2.grouped_with.front().second, 1.0, 1e-9);
  EXPECT_EQ(candidate(result, "theta7").status, ParameterStatus::kNoEffect);
}

TEST(Identify, GivesTableThreesTwentyThreeWhenAlpha4AndAlpha5AreLeftOut) {
  IdentificationOptions options = paper_options();
  options.identifiability.excluded = {*error_parameter_index("alpha4"), *error_parameter_index("alpha5")};
  const IdentificationResult result = identify(paper_problem(exact_touches()), options);
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  std::array<int, 5> counts{};
  for (const auto& c : result.identifiable.candidates) ++counts[static_cast<std::size_t>(c.status)];
  // service/doc/surfaces.md, section 5: 23 identified, 9 grouped, 3 without effect, 2 excluded, none weak.
  EXPECT_EQ(counts, (std::array{23, 9, 3, 2, 0}));
  EXPECT_LT((result.errors.head<kErrorParameterCount>() - paper::table3()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Identify, LeavesNothingToFindOnTheSameTouchesAgain) {  // validation B.1
  const IdentificationResult first = identify(paper_problem(exact_touches()), paper_options());
  IdentificationProblem again = paper_problem(exact_touches());
  again.nominal = first.calibrated;
  // The updated arm is not nominal: the set stays the one that was chosen there.
  IdentificationOptions options = paper_options();
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const auto status = first.identifiable.candidates[static_cast<std::size_t>(i)].status;
    if (status != ParameterStatus::kIdentified) options.identifiability.excluded.push_back(i);
  }
  const IdentificationResult second = identify(again, options);
  ASSERT_EQ(second.status, IdentificationStatus::kConverged) << second.message;
  EXPECT_LT(second.errors.norm(), 1e-9);
}

TEST(ContactPlane, StandsTheBallsCentreOutsideTheMaterialByItsRadiusLessThePretravel) {
  // The examples of the method notes: outside face, inside face of a slot, plate with y pointing down.
  const Face face{
      .plane = {{0, 0, 1}, 0.075}, .center_m = {}, .edge_u = {1, 0, 0}, .half_extent_m = {0.06, 0.06}};
  EXPECT_DOUBLE_EQ(contact_plane(face, {.radius_m = 0.003}).offset_m, 0.078);
  const Face looking_up_in_a_slot{
      .plane = {{0, 0, 1}, -0.025}, .center_m = {}, .edge_u = {1, 0, 0}, .half_extent_m = {}};
  EXPECT_DOUBLE_EQ(contact_plane(looking_up_in_a_slot, {.radius_m = 0.003}).offset_m, -0.022);
  const Face plate{.plane = {{0, -1, 0}, 0.0}, .center_m = {}, .edge_u = {1, 0, 0}, .half_extent_m = {}};
  EXPECT_DOUBLE_EQ(contact_plane(plate, {.radius_m = 0.003, .pretravel_m = 0.00001}).offset_m, 0.00299);
}

TEST(Identify, SaysHowManyTouchesAreMissingAndWhere) {
  std::vector<Touch> few;
  for (const Touch& touch : exact_touches()) {
    if (touch.face == 0 && few.size() < 6) few.push_back(touch);
    if (touch.face == 3 && few.size() < 10) few.push_back(touch);
  }
  const IdentificationResult result = identify(paper_problem(few), paper_options());
  EXPECT_EQ(result.status, IdentificationStatus::kTooFewTouches);
  EXPECT_EQ(static_cast<int>(result.identifiable.columns.size()), 10);
  EXPECT_EQ(result.attainable.count, 25);
  EXPECT_THAT(result.message, HasSubstr("15 more are missing"));
  EXPECT_THAT(result.message, HasSubstr("(1 on plane 1, 6 on plane 2, 6 on plane 3, 2 on plane 4)"));
  EXPECT_TRUE(result.iterations.empty());
}

TEST(Identify, RefusesTouchesThatLeaveAPlaneOut) {
  // Planes 1 to 3 alone hold no length: the recorded postures would fake rank 25.
  std::vector<Touch> touches = exact_touches();
  std::erase_if(touches, [](const Touch& touch) { return touch.face == 3; });
  const IdentificationResult result = identify(paper_problem(touches), paper_options());
  EXPECT_EQ(result.status, IdentificationStatus::kUnobservable);
  EXPECT_LT(result.identifiable.columns.size(), 25u);
  EXPECT_THAT(result.message, HasSubstr("no touch on plane 4"));
}

TEST(Identify, RefusesOnePostureRepeated) {
  const std::vector<Touch> touches(60, exact_touches().front());
  const IdentificationResult result = identify(paper_problem(touches), paper_options());
  EXPECT_EQ(result.status, IdentificationStatus::kOnePosture);
  EXPECT_THAT(result.message, HasSubstr("60 touches are one posture"));
  EXPECT_EQ(result.identifiable.columns.size(), 1u);
}

TEST(Identify, RefusesNonFiniteJointsAndUnknownFacesByTouch) {
  std::vector<Touch> touches = exact_touches();
  touches[4].joints[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(identify(paper_problem(touches), paper_options()).message, HasSubstr("touch 5"));
  touches = exact_touches();
  touches[7].face = 4;
  const IdentificationResult result = identify(paper_problem(touches), paper_options());
  EXPECT_EQ(result.status, IdentificationStatus::kBadInput);
  EXPECT_THAT(result.message, HasSubstr("touch 8"));
}

TEST(Identify, RefusesEquationSixOnAFaceThroughTheOrigin) {
  IdentificationProblem problem = paper_problem(exact_touches());
  problem.artefact.contact_planes[2].offset_m = 0.0;
  const IdentificationResult result = identify(problem, paper_options(Formulation::kPlaneCoefficients));
  EXPECT_EQ(result.status, IdentificationStatus::kBadInput);
  EXPECT_THAT(result.message, HasSubstr("signed_distance"));
}

TEST(Identify, EstimatesTheNoiseAndKeepsHeldOutTouchesOutOfTheFit) {
  constexpr double kNoise = 20e-6;
  std::vector<Touch> touches = exact_touches();
  std::mt19937_64 chance(7);
  std::normal_distribution<double> noise(0.0, kNoise);
  const KinematicModel truth = apply(paper::nominal(), paper::table3());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    ContactSurface plane = paper::planes()[static_cast<std::size_t>(touches[i].face)];
    plane.offset_m += noise(chance);
    touches[i] = moved_onto_plane(truth, plane, touches[i]);
    if (i % 4 == 3) touches[i].role = TouchRole::kHeldOut;
  }
  const IdentificationResult result = identify(paper_problem(touches), paper_options());
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.fitted_touch_count, 75);
  ASSERT_TRUE(result.noise_estimated_m);
  EXPECT_NEAR(*result.noise_estimated_m, kNoise, 0.3 * kNoise);  // 50 degrees of freedom: 3 sigma are 0.3
  int held_out = 0;
  for (const FaceDistances& distances : result.distances) {
    if (distances.role != TouchRole::kHeldOut) continue;
    held_out += distances.touch_count;
    EXPECT_GT(distances.nominal_rms_m, 1e-3);
    EXPECT_LT(distances.calibrated_rms_m, 4 * kNoise);
  }
  EXPECT_EQ(held_out, 25);
}

TEST(Identify, HoldsForTouchesInAnyOrder) {
  std::vector<Touch> touches = exact_touches();
  const IdentificationResult forward = identify(paper_problem(touches), paper_options());
  std::ranges::reverse(touches);
  const IdentificationResult backward = identify(paper_problem(touches), paper_options());
  EXPECT_LT((forward.errors - backward.errors).cwiseAbs().maxCoeff(), 1e-11);
}

}  // namespace
}  // namespace calib
