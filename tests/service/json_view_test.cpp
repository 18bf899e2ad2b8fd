#include "service/http/json_view.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "calib_core/units.hpp"
#include "service/acquisition/touch_command.hpp"
#include "service/run.hpp"
#include "tests/service/shipped_cell.hpp"
#include "config/identification_problem.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

/// Field names and JSON types of an object: "string", "boolean", "array", "object", "null"; "number" is
/// finite.
using Shape = std::map<std::string, std::string>;

Shape shape_of(const json& object) {
  Shape shape;
  for (const auto& [key, value] : object.items()) shape[key] = value.type_name();
  return shape;
}

json result_with(const std::string& recipe_name) {
  const Recipe& recipe = edf().recipes.at(recipe_name);
  calib::IdentificationProblem problem = identification_problem(edf(), recipe);
  problem.touches = table3_touches();
  const calib::IdentificationResult result = calib::identify(problem, recipe.identification);
  return json::parse(result_document(edf(), recipe, result, {}));
}

/// Of the paper's touches with the cell's default recipe.
const json& result() {
  static const json document = result_with("edf-25");
  return document;
}

const json& parameter(const std::string& name) {
  for (const json& found : result().at("parameters")) {
    if (found.at("name") == name) return found;
  }
  throw std::out_of_range("no parameter " + name);
}

TEST(ResultDocument, HasTheContractsFieldsWithTheirTypes) {
  EXPECT_EQ(shape_of(result()), (Shape{{"schema", "string"},
                                       {"arm", "string"},
                                       {"recipe", "string"},
                                       {"touch_count", "number"},
                                       {"complete", "boolean"},
                                       {"warnings", "array"},
                                       {"rejected_touches", "array"},
                                       {"converged", "boolean"},
                                       {"iterations", "array"},
                                       {"identifiable_count", "number"},
                                       {"condition_number", "number"},
                                       {"scaled_condition_number", "number"},
                                       {"singular_values", "array"},
                                       {"parameters", "array"},
                                       {"artefact_parameters", "array"},
                                       {"planes", "array"},
                                       {"planes_held_out", "array"},
                                       {"planes_proof", "array"},
                                       {"scale", "object"},
                                       {"tip_uncertainty", "object"},
                                       {"fit", "object"},
                                       {"verdict", "object"}}));
  for (const json& iteration : result().at("iterations")) {
    EXPECT_EQ(shape_of(iteration), (Shape{{"condition_number", "number"},
                                          {"scaled_condition_number", "number"},
                                          {"residual_rms_mm", "number"},
                                          {"step_norm", "number"}}));
  }
  for (const json& found : result().at("parameters")) {
    const bool identified = found.at("status") == "identified";
    EXPECT_EQ(shape_of(found), (Shape{{"name", "string"},
                                      {"frame", "number"},
                                      {"kind", "string"},
                                      {"group", "string"},
                                      {"unit", "string"},
                                      {"nominal", "number"},
                                      {"status", "string"},
                                      {"error", identified ? "number" : "null"},
                                      {"std_uncertainty", "null"},
                                      {"grouped_with", "array"}}))
        << found;
  }
  for (const json& plane : result().at("planes")) {
    EXPECT_EQ(shape_of(plane), (Shape{{"plane", "number"},
                                      {"touch_count", "number"},
                                      {"reference_mm", "number"},
                                      {"nominal_mean_mm", "number"},
                                      {"calibrated_mean_mm", "number"},
                                      {"error_removed_percent", "number"},
                                      {"nominal_agreement_percent", "number"},
                                      {"nominal_rms_mm", "number"},
                                      {"calibrated_rms_mm", "number"}}));
  }
}

TEST(ResultDocument, WhatIsNotComputedYetIsNull) {
  EXPECT_EQ(result().at("scale"),
            (json{{"source", "block"}, {"std_uncertainty_ppm", nullptr}, {"warning", nullptr}}));
  EXPECT_EQ(result().at("tip_uncertainty"), (json{{"at_block_rms_mm", nullptr},
                                                  {"workspace_box_rms_mm", nullptr},
                                                  {"joint_ranges_rms_mm", nullptr}}));
  EXPECT_EQ(
      shape_of(result().at("fit")),
      (Shape{{"noise_declared_um", "number"}, {"noise_estimated_um", "number"}, {"lack_of_fit_p", "null"}}));
}

TEST(ResultDocument, SaysWhatThePapersTouchesShow) {
  const json expected = json_of(kSourceDir / "tests/data/table3-exact.expected.json");
  EXPECT_EQ(result().at("schema"), "touchcal/result/1");
  EXPECT_EQ(result().at("arm"), "tx90");
  EXPECT_EQ(result().at("touch_count"), table3_touches().size());
  EXPECT_EQ(result().at("complete"), true);
  EXPECT_EQ(result().at("converged"), true);
  EXPECT_EQ(result().at("identifiable_count"), expected.at("signed_distance").at("rank"));
  EXPECT_EQ(result().at("condition_number"), result().at("iterations").back().at("condition_number"));
  EXPECT_EQ(result().at("fit").at("noise_declared_um"), 20.0);
  EXPECT_EQ(result().at("verdict").at("accepted"), true) << result().at("verdict");
  EXPECT_EQ(result().at("verdict").at("reasons"), json::array());
  ASSERT_EQ(result().at("planes").size(), edf().block.faces.size());
  for (const json& plane : result().at("planes")) {
    EXPECT_NEAR(plane.at("calibrated_mean_mm").get<double>(), plane.at("reference_mm").get<double>(), 1e-6);
    EXPECT_NEAR(plane.at("error_removed_percent").get<double>(), 100.0, 1e-3);
  }
}

TEST(ResultDocument, ShowsLengthsInMillimetresAndAnglesInRadians) {
  const json errors = json_of(kSourceDir / "tests/data/table3-exact.expected.json").at("identified_errors");
  for (const auto& [name, error] : errors.items()) {
    const json& found = parameter(name);
    const bool length = found.at("unit") == "mm";
    EXPECT_EQ(length, name[0] == 'd' || name[0] == 'r') << name;
    EXPECT_EQ(found.at("status"), "identified") << name;
    EXPECT_NEAR(found.at("error").get<double>(), error.get<double>() * (length ? 1e3 : 1.0),
                length ? 1e-6 : 1e-9)
        << name;
  }
  EXPECT_NEAR(parameter("r0").at("nominal").get<double>(), 149.6, 1e-9);
  EXPECT_NEAR(parameter("theta7").at("nominal").get<double>(), -0.256, 1e-12);
}

TEST(ResultDocument, ListsAllParametersInTheContractsOrderWithTheirGroups) {
  const json& parameters = result().at("parameters");
  ASSERT_EQ(parameters.size(), static_cast<std::size_t>(calib::kErrorParameterCount));
  const std::set<std::string> place{"theta0", "r0", "alpha1", "d1", "theta1", "r1"};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string name = calib::error_parameters()[i].name();
    EXPECT_EQ(parameters[i].at("name"), name);
    EXPECT_EQ(name, parameters[i].at("kind").get<std::string>() +
                        std::to_string(parameters[i].at("frame").get<int>()));
    EXPECT_EQ(parameters[i].at("group"), place.contains(name) ? "place"
                                         : name.back() == '7' ? "tool"
                                                              : "arm")
        << name;
  }
}

TEST(ResultDocument, WithTheRecipeOfThePaper23AreIdentifiedAndTheRestIsNamed) {
  const json document = result_with("edf-23");
  std::map<std::string, int> count;
  for (const json& found : document.at("parameters")) ++count[found.at("status")];
  EXPECT_EQ(count, (std::map<std::string, int>{
                       {"identified", 23}, {"excluded", 2}, {"no_effect", 3}, {"grouped", 9}}));
  EXPECT_EQ(document.at("identifiable_count"), 23);
}

/// One mm or rad of a grouped error moves the tip as its named others do, each by its factor in mm or rad.
TEST(ResultDocument, AGroupedErrorIsTheSumOfTheOthersInTheUnitsShown) {
  const calib::KinematicModel& model = edf().arm.model;
  const auto planes = calib::describe(artefact_knowledge(edf())).contact_planes;
  std::vector<calib::Touch> on_face;
  for (const calib::Touch& touch : table3_touches())
    on_face.push_back(moved_onto_plane(model, planes[static_cast<std::size_t>(touch.face)], touch));
  const auto matrix = observe(model, planes, on_face, calib::Formulation::kSignedDistance).matrix;
  const auto column_a_shown_unit = [&](const std::string& name) -> Eigen::VectorXd {
    const int index = calib::error_parameter_index(name).value();
    return matrix.col(index) * (parameter(name).at("unit") == "mm" ? 1e-3 : 1.0);
  };
  int mixed_units = 0;
  for (const json& found : result().at("parameters")) {
    EXPECT_EQ(found.at("status") == "grouped", !found.at("grouped_with").empty()) << found;
    if (found.at("status") != "grouped") continue;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(matrix.rows());
    for (const json& other : found.at("grouped_with")) {
      EXPECT_EQ(shape_of(other), (Shape{{"name", "string"}, {"factor", "number"}}));
      sum += other.at("factor").get<double>() * column_a_shown_unit(other.at("name"));
      if (parameter(other.at("name")).at("unit") != found.at("unit")) ++mixed_units;
    }
    const Eigen::VectorXd own = column_a_shown_unit(found.at("name"));
    EXPECT_LT((own - sum).norm(), 1e-9 * own.norm()) << found;
  }
  EXPECT_GT(mixed_units, 0) << "no group mixes lengths and angles: the test shows nothing";
}

TEST(ResultDocument, PercentagesAreThePapers) {
  struct Row {
    double measured_mm, nominal_mm, calibrated_mm, printed_percent;
  };
  // Table VI, along the outward normals: its signs are those of the axes.
  const std::vector<Row> table6{{75, 71.14, 74.99, 94.85},
                                {75, 79.5, 75.00, 94.00},
                                {150, 152.3, 150.00, 98.46},
                                {75, 78.75, 74.99, 95.00}};
  calib::IdentificationResult identified;
  for (std::size_t i = 0; i < table6.size(); ++i) {
    identified.distances.push_back(
        {.face = static_cast<int>(i),
         .nominal_mean_m = calib::metres_from_mm(table6[i].nominal_mm - table6[i].measured_mm),
         .calibrated_mean_m = calib::metres_from_mm(table6[i].calibrated_mm - table6[i].measured_mm)});
  }
  const json planes =
      json::parse(result_document(edf(), edf().recipes.at("edf-25"), identified, {})).at("planes");
  ASSERT_EQ(planes.size(), table6.size());
  for (std::size_t i = 0; i < table6.size(); ++i) {
    const Row& row = table6[i];
    EXPECT_NEAR(planes[i].at("reference_mm").get<double>(), row.measured_mm, 1e-9);
    EXPECT_NEAR(planes[i].at("nominal_mean_mm").get<double>(), row.nominal_mm, 1e-9);
    EXPECT_NEAR(planes[i].at("calibrated_mean_mm").get<double>(), row.calibrated_mm, 1e-9);
    EXPECT_NEAR(planes[i].at("nominal_agreement_percent").get<double>(), row.printed_percent, 0.01) << i;
    EXPECT_GE(planes[i].at("error_removed_percent").get<double>(), 99.7) << i;
  }
}

TEST(ResultDocument, AFigureThatIsNoNumberIsNull) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  calib::IdentificationResult identified;
  identified.iterations = {{nan, std::numeric_limits<double>::infinity(), nan, nan}};
  identified.noise_estimated_m = nan;
  identified.singular_values = {nan};
  identified.distances = {{.face = 0, .nominal_mean_m = 0.0, .nominal_rms_m = nan, .calibrated_mean_m = nan}};
  const json document =
      json::parse(result_document(edf(), edf().recipes.at("edf-25"), identified, {.complete = false}));
  EXPECT_EQ(document.at("complete"), false);
  for (const auto& [name, value] : document.at("iterations")[0].items()) EXPECT_TRUE(value.is_null()) << name;
  EXPECT_TRUE(document.at("condition_number").is_null());
  EXPECT_TRUE(document.at("scaled_condition_number").is_null());
  EXPECT_TRUE(document.at("singular_values")[0].is_null());
  EXPECT_TRUE(document.at("fit").at("noise_estimated_um").is_null());
  EXPECT_TRUE(document.at("planes")[0].at("calibrated_mean_mm").is_null());
  EXPECT_TRUE(document.at("planes")[0].at("nominal_rms_mm").is_null());
  EXPECT_TRUE(document.at("planes")[0].at("error_removed_percent").is_null()) << "0 of 0 is no share";
}

TEST(ResultDocument, WarningsAndReasonsAreToldAsTheyAre) {
  calib::IdentificationResult identified;
  identified.message = "too few touches on plane 4";
  const json document = json::parse(result_document(edf(), edf().recipes.at("edf-25"), identified,
                                                    {.complete = true, .warnings = {"touch 3: joint 2"}}));
  EXPECT_EQ(document.at("warnings"), json::array({"touch 3: joint 2"}));
  EXPECT_EQ(document.at("converged"), false);
  EXPECT_EQ(document.at("verdict").at("accepted"), false);
  EXPECT_EQ(document.at("verdict").at("reasons"), json::array({"too few touches on plane 4"}));
}

const Shape kQuietStatus{{"state", "string"},
                         {"run_id", "null"},
                         {"recipe", "null"},
                         {"touches_done", "number"},
                         {"touches_total", "null"},
                         {"plane", "null"},
                         {"identifiable_count", "null"},
                         {"condition_number", "null"},
                         {"predicted_tip_rms_mm", "null"},
                         {"eta_s", "null"},
                         {"verdict", "string"},
                         {"controller_connected", "boolean"},
                         {"controller_powered", "null"},
                         {"controller_mode", "null"},
                         {"controller_estop", "null"},
                         {"fault_code", "null"},
                         {"fault_message", "null"},
                         {"fault_robot_action", "null"},
                         {"fault_next_step", "null"},
                         {"last_accepted_run_id", "null"},
                         {"last_accepted_at", "null"},
                         {"data_age_ms", "null"},
                         {"sequence", "number"},
                         {"instance_id", "string"},
                         {"since", "string"}};

TEST(StatusDocument, HasTheContractsFieldsWhenNothingIsKnown) {
  EXPECT_EQ(shape_of(json::parse(status_document({}))), kQuietStatus);
}

TEST(StatusDocument, HasTheSameFieldsWhenAllIsKnown) {
  Status busy;
  busy.state = State::kHeld;
  busy.run_id = 7;
  busy.recipe = "edf-25";
  busy.touches_done = 3;
  busy.touches_total = 140;
  busy.plane = 2;
  busy.identifiable_count = 3;
  busy.condition_number = 12.5;
  busy.eta_s = 30.0;
  busy.controller.connected = true;
  busy.controller.powered = true;
  busy.controller.mode = "remote";
  busy.controller.emergency_stop = false;
  busy.fault = Fault{FaultCode::kNoContact, ""};
  busy.last_accepted_run_id = 6;
  busy.last_accepted_at = "then";
  busy.data_age_ms = 12;
  const json document = json::parse(status_document(busy));
  for (const auto& [name, value] : document.items()) {
    EXPECT_TRUE(kQuietStatus.contains(name)) << name;
    EXPECT_EQ(value.is_null(), name == "predicted_tip_rms_mm") << name;
  }
  EXPECT_EQ(document.size(), kQuietStatus.size());
  EXPECT_EQ(document.at("state"), "HELD");
  EXPECT_EQ(document.at("run_id"), "7") << "ids are text: no client counts with them";
  EXPECT_EQ(document.at("fault_code"), "no_contact");
  EXPECT_EQ(document.at("controller_estop"), false);
}

TEST(StatusDocument, AFigureThatIsNoNumberIsNull) {
  const Status status{.condition_number = std::numeric_limits<double>::infinity(),
                      .eta_s = std::numeric_limits<double>::quiet_NaN()};
  const json document = json::parse(status_document(status));
  EXPECT_TRUE(document.at("condition_number").is_null());
  EXPECT_TRUE(document.at("eta_s").is_null());
}

TEST(StatusDocument, BytesThatAreNoTextAreShownAsFarAsTheyAre) {
  const Status status{.fault = Fault{FaultCode::kProtocolError, "sent \xff\xfe and \x01"}};
  const json document = json::parse(status_document(status));
  EXPECT_THAT(document.at("fault_message").get<std::string>(), ::testing::HasSubstr("sent \xEF\xBF\xBD"));
}

TEST(RunsDocument, HasEachRunsFieldsAndWhereTheNextPageBegins) {
  const StoredRun running{
      .id = 2, .recipe = "edf-25", .started_at = "start", .outcome = "running", .verdict = "none"};
  const json page = json::parse(runs_document({running}, 2));
  EXPECT_EQ(page.at("next_before"), "2");
  ASSERT_EQ(page.at("runs").size(), 1u);
  EXPECT_EQ(page.at("runs")[0], json::parse(run_document(running)));
  EXPECT_EQ(shape_of(page.at("runs")[0]), (Shape{{"id", "string"},
                                                 {"recipe", "string"},
                                                 {"outcome", "string"},
                                                 {"verdict", "string"},
                                                 {"touches_done", "number"},
                                                 {"touches_total", "null"},
                                                 {"started_at", "string"},
                                                 {"ended_at", "null"},
                                                 {"fault_code", "null"},
                                                 {"fault_message", "null"}}));
  const json last = json::parse(runs_document({}, std::nullopt));
  EXPECT_EQ(last, (json{{"runs", json::array()}, {"next_before", nullptr}}));
}

TEST(TouchesDocument, IsWhatIdentifyReadsBackToTheLastStep) {
  const std::vector<StoredTouch> stored{
      {.number = 1, .plane = 1, .joints = {-42469929, 70229417, 43225787, 52719402, 128430178, -91254213}},
      {.number = 2,
       .plane = 4,
       .role = calib::TouchRole::kHeldOut,
       .joints = {1, -1, 7, 123456789, 0, -270000000}},
      {.number = 3, .plane = 2, .role = calib::TouchRole::kProof}};
  const std::string document = touches_document(edf(), stored);
  const TouchesFile read = touches_from_json("document", document, document.size(), edf());
  ASSERT_EQ(read.touches.size(), stored.size());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    EXPECT_EQ(read.touches[i].face + 1, stored[i].plane);
    EXPECT_EQ(read.touches[i].role, stored[i].role);
    EXPECT_EQ(to_wire(read.touches[i].joints), stored[i].joints) << i;
  }
}

}  // namespace
}  // namespace cell
