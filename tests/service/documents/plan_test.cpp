#include "service/documents/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "calib_core/geometry/units.hpp"
#include "config/joint_units.hpp"
#include "config/read_config.hpp"
#include "service/documents/internal/document_fields.hpp"
#include "service/documents/plan_document.hpp"
#include "service/documents/result_view.hpp"
#include "service/run/tip_prediction.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kRecipe = "edf-25";

/// A plan of the paper's cell, made once.
const Plan& shipped_plan() {
  static const TipRegions regions(edf());
  static const Plan plan = std::get<Plan>(make_plan(regions, edf().recipes.at(kRecipe)));
  return plan;
}

const json& document() {
  static const json parsed = json::parse(shipped_plan().document);
  return parsed;
}

calib::JointVector joints_of(const json& joints_deg) {
  const auto six = joints_deg.get<std::array<double, calib::kJointCount>>();
  return calib::JointVector(six.data()).cwiseProduct(joint_units(edf().arm.model));
}

double height_over_face_m(const json& touch, const char* joints) {
  const auto& face = edf().block.faces.at(touch.at("plane").get<std::size_t>() - 1);
  const auto pose = calib::forward_kinematics(edf().arm.model, joints_of(touch.at(joints)));
  return calib::signed_distance_m(face.plane, pose.translation()) - edf().probe.stylus.radius_m;
}

TEST(Plan, ItsDocumentHasAllThatTheContractNames) {
  const json plan = document();
  EXPECT_EQ(plan.at("schema"), "touchcal/plan/1");
  EXPECT_EQ(plan.at("plan_id"), shipped_plan().id);
  EXPECT_EQ(plan.at("recipe"), kRecipe);
  for (const char* key : {"condition_number", "scaled_condition_number", "duration_s"})
    EXPECT_GT(plan.at(key).get<double>(), 0.0) << key;
  EXPECT_EQ(plan.at("touches").size(), shipped_plan().touches.touches.size());
  for (const json& touch : plan.at("touches")) {
    for (const char* key : {"joints_deg", "approach_joints_deg", "clear_joints_deg", "search_end_joints_deg"})
      EXPECT_EQ(touch.at(key).size(), static_cast<std::size_t>(calib::kJointCount)) << key;
    EXPECT_EQ(touch.at("search_direction").size(), 3u);
    for (const char* key : {"search_length_mm", "tilt_deg", "predicted_miss_mm", "travel_s", "touch_s"})
      EXPECT_TRUE(touch.at(key).is_number()) << key;
    EXPECT_TRUE(touch.at("via_joints_deg").is_array());
  }
}

TEST(Plan, IsWrittenAsItWasRead) {
  EXPECT_EQ(document_text(read_plan(shipped_plan().document)), shipped_plan().document);
}

TEST(Plan, ItPredictsTheTipInTheShapeOfAResult) {
  const json tip = document().at("tip_uncertainty");
  const TipPrediction nothing;
  const json of_result = json::parse(written(tip_of(edf(), nothing)));
  for (const auto& [key, unused] : of_result.items()) EXPECT_TRUE(tip.contains(key)) << key;
  EXPECT_EQ(tip.size(), of_result.size());
  EXPECT_GT(tip.at("workspace_box_rms_mm").get<double>(), 0.0);
}

TEST(Plan, ItPromisesOfTheTipWhatRunsWithTheDeclaredNoisePromise) {
  constexpr int kRunCount = 20;
  const Cell demo = read_cell(std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/demo/cell.json");
  const Recipe& recipe = demo.recipes.at("quick");
  const TipRegions regions(demo);
  const Plan plan = std::get<Plan>(make_plan(regions, recipe));
  const PlannedIdentification planned = identify_planned(demo, recipe, plan.touches);
  const auto promised_m = [&](const calib::IdentificationResult& result) {
    return predicted_rms_m(regions.tip().workspace_box, result.uncertainty.value()).value();
  };
  std::mt19937_64 chance(1);
  std::normal_distribution<double> noise_m(0.0, demo.touch_noise_m);
  double sum = 0.0;
  for (int run = 0; run < kRunCount; ++run) {
    calib::IdentificationProblem problem = planned.problem;
    for (calib::Touch& touch : problem.touches) {
      calib::ContactSurface plane = problem.artefact.contact_planes.at(static_cast<std::size_t>(touch.face));
      plane.offset_m += noise_m(chance);
      touch = calib::moved_onto_plane(problem.nominal, plane, touch);
    }
    sum += promised_m(calib::identify(problem, recipe.identification));
  }
  EXPECT_NEAR(promised_m(planned.result) / (sum / kRunCount), 1.0, 0.1) << promised_m(planned.result);
}

TEST(Plan, EachIdentifiedParameterHasAPredictedUncertaintyAndNoError) {
  int identified = 0;
  for (const json& parameter : document().at("parameters")) {
    EXPECT_FALSE(parameter.contains("error")) << "nothing was measured";
    const bool has_figure = parameter.at("std_uncertainty").is_number();
    EXPECT_EQ(has_figure, parameter.at("status") == "identified") << parameter;
    identified += has_figure ? 1 : 0;
  }
  EXPECT_EQ(document().at("identifiable_count"), identified);
}

TEST(Plan, InItsJointsTheBallTouchesTheFaceAndTheSearchLeadsThroughIt) {
  for (const json& touch : document().at("touches")) {
    EXPECT_NEAR(height_over_face_m(touch, "joints_deg"), 0.0, 1e-9);
    const double before_m = height_over_face_m(touch, "approach_joints_deg");
    const double behind_m = -height_over_face_m(touch, "search_end_joints_deg");
    EXPECT_GT(before_m, 0.0);
    EXPECT_GT(behind_m, 0.0);
    EXPECT_NEAR(calib::metres_from_mm(touch.at("search_length_mm").get<double>()), before_m + behind_m, 1e-9);
  }
}

TEST(Plan, ItNamesWhatTheErrorIsMadeOfAndTheSharesAddUp) {
  double sum = 0.0, last = 100.0;
  for (const json& source : document().at("limits").at("accuracy")) {
    const double share = source.at("share_percent");
    EXPECT_LE(share, last) << "largest first";
    last = share;
    sum += share;
  }
  EXPECT_NEAR(sum, 100.0, 1e-6);
  EXPECT_THAT(document().at("limits").at("words").dump(),
              HasSubstr("compliance"));  // edf-25 does not estimate it
}

TEST(Plan, TheSameProblemHasTheSameIdAndAnotherPlanAnother) {
  const TipRegions regions(edf());
  EXPECT_EQ(std::get<Plan>(make_plan(regions, edf().recipes.at(kRecipe))).id, shipped_plan().id);
  Cell noisier = edf();
  noisier.touch_noise_m *= 2.0;
  const TipRegions other_regions(noisier);
  const auto other = make_plan(other_regions, noisier.recipes.at(kRecipe));
  EXPECT_NE(std::get<Plan>(other).id, shipped_plan().id);
}

class RefusedPlan : public ::testing::Test {
 protected:
  PlanRefusal refusal() {
    const TipRegions regions(cell_);
    return std::get<PlanRefusal>(make_plan(regions, cell_.recipes.at(kRecipe)));
  }

  Cell cell_ = edf();
};

TEST_F(RefusedPlan, ABoxWhereTheArmDoesNotComeSaysHowFarOffItIs) {
  const Eigen::Vector3d away_m(0.0, 0.0, 10.0);
  cell_.workspace_box.min_m += away_m;
  cell_.workspace_box.max_m += away_m;
  const PlanRefusal refused = refusal();
  EXPECT_EQ(refused.kind, PlanRefusal::Kind::kWorkspaceBox);
  EXPECT_THAT(refused.message, HasSubstr(cell_.workspace_box.name));
  EXPECT_THAT(refused.message, HasSubstr("mm off"));
}

TEST_F(RefusedPlan, ABlockOutOfReachSaysSoAndHowNearTheTipComes) {
  cell_.arm.model.links[1].d_m -= 3.0;
  // The box stays where the arm is: it is the block that is too far away.
  cell_.workspace_box.min_m.x() -= 3.0;
  cell_.workspace_box.max_m.x() -= 3.0;
  const PlanRefusal refused = refusal();
  EXPECT_EQ(refused.kind, PlanRefusal::Kind::kFace);
  EXPECT_THAT(refused.message, HasSubstr("out of reach"));
  EXPECT_THAT(refused.message, HasSubstr("mm to the plane's centre"));
}

TEST_F(RefusedPlan, AStandOutOfReachIsNamedWithItsPlane) {
  BlockPlace roof{.name = "roof", .std = calib::PlaceDeviation{1e-5, 3e-5}};
  roof.first_from_place.translation() = Eigen::Vector3d(3.0, 0.0, 0.0);
  cell_.block.places = {roof};
  cell_.recipes.at(kRecipe).places = {0};
  const PlanRefusal refused = refusal();
  EXPECT_EQ(refused.kind, PlanRefusal::Kind::kFace);
  EXPECT_THAT(refused.message, HasSubstr("at \"roof\": 0 of"));
  EXPECT_THAT(refused.message, HasSubstr("out of reach"));
}

TEST_F(RefusedPlan, AFaceWithSomethingBeforeItNamesTheFaceAndTheThing) {
  cell_.keep_out_boxes.push_back({"fence", {-0.10, -0.30, -0.10}, {-0.08, 0.02, 0.10}});
  const PlanRefusal refused = refusal();
  EXPECT_EQ(refused.kind, PlanRefusal::Kind::kFace);
  EXPECT_THAT(refused.message, HasSubstr("plane 2: 0 of"));
  EXPECT_THAT(refused.message, HasSubstr("fence"));
}

TEST_F(RefusedPlan, AParkPostureThatIsNotClearIsNamed) {
  cell_.keep_out_boxes.push_back({"everything", {-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}});
  const PlanRefusal refused = refusal();
  EXPECT_EQ(refused.kind, PlanRefusal::Kind::kPark);
  EXPECT_THAT(refused.message, HasSubstr("everything"));
}

TEST_F(RefusedPlan, TouchesThatAreTooFewAreRefusedWithTheNumberThatIsMissing) {
  Recipe few = cell_.recipes.at(kRecipe);
  few.fit_per_face = 3;
  const TipRegions regions(cell_);
  const auto refused = std::get<PlanRefusal>(make_plan(regions, few));
  EXPECT_EQ(refused.kind, PlanRefusal::Kind::kTouches);
  EXPECT_THAT(refused.message, HasSubstr(std::to_string(25 - 3 * 4)));
}

/// The centre of each further ball is three parameters more than those of the arm.
TEST_F(RefusedPlan, TouchesThatDoNotFindTheBallsOfAStarAreTooFew) {
  cell_ = read_cell(std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/star/cell.json");
  Recipe few = cell_.recipes.at("star");
  few.goal.fit_count = 27;
  const TipRegions regions(cell_);
  const auto refused = std::get<PlanRefusal>(make_plan(regions, few));
  EXPECT_EQ(refused.kind, PlanRefusal::Kind::kTouches);
  EXPECT_THAT(refused.message, HasSubstr("33 parameters need at least 33: 6 more are missing"));
}

TEST_F(RefusedPlan, PlanesThatCannotShowAllAreRefusedHoweverManyTouchesThereAre) {
  Recipe two_planes = cell_.recipes.at("quick");
  two_planes.faces = {0, 1};
  const TipRegions regions(cell_);
  const auto refused = std::get<PlanRefusal>(make_plan(regions, two_planes));
  EXPECT_EQ(refused.kind, PlanRefusal::Kind::kTouches);
  EXPECT_THAT(refused.message, HasSubstr("more planes"));
}

}  // namespace
}  // namespace cell
