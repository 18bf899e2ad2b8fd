#include "service/documents/result_view.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "tests/service/document_shape.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {
namespace {

TEST(ResultDocument, HasTheContractsFieldsWithTheirTypes) {
  EXPECT_EQ(shape_of(result()), (Shape{{"schema", "string"},
                                       {"arm", "string"},
                                       {"recipe", "string"},
                                       {"touch_count", "number"},
                                       {"complete", "boolean"},
                                       {"cell_frames", "array"},
                                       {"warnings", "array"},
                                       {"rejected_touches", "array"},
                                       {"converged", "boolean"},
                                       {"iterations", "array"},
                                       {"identifiable_count", "number"},
                                       {"condition_number", "number"},
                                       {"scaled_condition_number", "number"},
                                       {"singular_values", "array"},
                                       {"rank", "object"},
                                       {"parameters", "array"},
                                       {"correlations", "array"},
                                       {"artefact_parameters", "array"},
                                       {"model", "array"},
                                       {"model_reason", "null"},
                                       {"nongeometric_parameters", "array"},
                                       {"stiffness", "array"},
                                       {"planes", "array"},
                                       {"planes_held_out", "array"},
                                       {"planes_proof", "array"},
                                       {"touches", "array"},
                                       {"validation", "object"},
                                       {"scale", "object"},
                                       {"tip_uncertainty", "object"},
                                       {"monte_carlo", "null"},
                                       {"fit", "object"},
                                       {"verdict", "object"},
                                       {"conditions", "object"}}));
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
                                      {"std_uncertainty", identified ? "number" : "null"},
                                      {"interval95", identified ? "array" : "null"},
                                      {"grouped_with", "array"},
                                      {"stands_for", "array"}}))
        << found;
  }
  for (const json& plane : result().at("planes")) {
    EXPECT_EQ(shape_of(plane), (Shape{{"plane", "number"},
                                      {"touch_count", "number"},
                                      {"reference_mm", "number"},
                                      {"estimated_offset_mm", "null"},
                                      {"nominal_mean_mm", "number"},
                                      {"calibrated_mean_mm", "number"},
                                      {"error_removed_percent", "number"},
                                      {"nominal_agreement_percent", "number"},
                                      {"nominal_rms_mm", "number"},
                                      {"calibrated_rms_mm", "number"}}));
  }
}

TEST(ResultDocument, ItsPartsHaveTheirFieldsWithTheirTypes) {
  EXPECT_EQ(shape_of(result().at("rank")), (Shape{{"attainable", "number"},
                                                  {"off_axis", "number"},
                                                  {"explanation", "string"},
                                                  {"smallest_kept", "number"},
                                                  {"largest_dropped", "number"},
                                                  {"singular_values", "array"},
                                                  {"singular_value_gap", "number"}}));
  EXPECT_EQ(shape_of(result().at("scale")), (Shape{{"source", "string"},
                                                   {"std_uncertainty_ppm", "number"},
                                                   {"stretch_ppm", "number"},
                                                   {"significance", "number"},
                                                   {"warning", "string"}}));
  EXPECT_EQ(shape_of(result().at("fit")), (Shape{{"noise_declared_um", "number"},
                                                 {"noise_estimated_um", "number"},
                                                 {"noise_used_um", "number"},
                                                 {"noise_repeats_um", "null"},
                                                 {"repeats_degrees_of_freedom", "null"},
                                                 {"repeats_sources", "array"},
                                                 {"gear_share", "number"},
                                                 {"lack_of_fit_test", "string"},
                                                 {"lack_of_fit_noise_um", "number"},
                                                 {"lack_of_fit_repeats_um", "null"},
                                                 {"lack_of_fit_gears_um", "null"},
                                                 {"droop_p", "number"},
                                                 {"droop_power", "number"},
                                                 {"lack_of_fit_p", "number"},
                                                 {"degrees_of_freedom", "number"},
                                                 {"planes", "array"}}));
  for (const json& plane : result().at("fit").at("planes"))
    EXPECT_EQ(shape_of(plane), (Shape{{"plane", "number"}, {"p", "number"}}));
  const json& tip = result().at("tip_uncertainty");
  EXPECT_EQ(shape_of(tip), (Shape{{"at_block_rms_mm", "number"},
                                  {"workspace_box_rms_mm", "number"},
                                  {"joint_ranges_rms_mm", "number"},
                                  {"expanded", "object"},
                                  {"arm_frame", "object"},
                                  {"warmer", "object"},
                                  {"sources", "array"},
                                  {"tools", "array"},
                                  {"map", "object"}}));
  const Shape expanded{
      {"k", "number"}, {"box_rms_mm", "number"}, {"box_p95_mm", "number"}, {"box_max_mm", "number"}};
  EXPECT_EQ(shape_of(tip.at("expanded")), expanded);
  EXPECT_EQ(shape_of(tip.at("arm_frame")), (Shape{{"at_block_rms_mm", "number"},
                                                  {"workspace_box_rms_mm", "number"},
                                                  {"joint_ranges_rms_mm", "number"},
                                                  {"expanded", "object"}}));
  EXPECT_EQ(shape_of(tip.at("arm_frame").at("expanded")), expanded);
  EXPECT_FALSE(tip.at("sources").empty());
  for (const json& source : tip.at("sources"))
    EXPECT_EQ(shape_of(source), (Shape{{"name", "string"}, {"workspace_box_rms_mm", "number"}}));
  EXPECT_FALSE(result().at("correlations").empty());
  for (const json& correlation : result().at("correlations")) {
    EXPECT_EQ(shape_of(correlation),
              (Shape{{"first", "string"}, {"second", "string"}, {"coefficient", "number"}}));
  }
}

TEST(ResultDocument, TheDistancesOfEachTouchAverageToThoseOfItsPlane) {
  for (const auto& [role, planes] :
       {std::pair{"fit", result().at("planes")}, std::pair{"held_out", result().at("planes_held_out")}}) {
    for (const json& plane : planes) {
      double nominal = 0.0, calibrated = 0.0;
      int count = 0;
      for (const json& touch : result().at("touches")) {
        if (touch.at("role") != role || touch.at("plane") != plane.at("plane")) continue;
        EXPECT_EQ(touch.at("use"), "used");
        nominal += touch.at("nominal_mm").get<double>();
        calibrated += touch.at("calibrated_mm").get<double>();
        ++count;
      }
      ASSERT_EQ(count, plane.at("touch_count"));
      EXPECT_NEAR(nominal / count, plane.at("nominal_mean_mm").get<double>(), 1e-9);
      EXPECT_NEAR(calibrated / count, plane.at("calibrated_mean_mm").get<double>(), 1e-9);
    }
  }
}

TEST(ResultDocument, ARejectedTouchKeepsItsDistanceAndSaysSo) {
  const Recipe& recipe = edf().recipes.at("edf-25");
  const calib::IdentificationProblem problem = problem_of(recipe);
  calib::IdentificationResult identified = calib::identify(problem, recipe.identification);
  identified.rejected = {{.touch = 4, .residual_m = 1.21e-3}};
  const json document = document_of(problem, identified);
  EXPECT_EQ(document.at("touches")[4].at("use"), "rejected");
  EXPECT_EQ(document.at("touches")[5].at("use"), "used");
}

TEST(ResultDocument, TheRepetitionsAreToldOnceTheTouchesAreComplete) {
  const json& same = result().at("validation").at("same_touches");
  EXPECT_TRUE(same.at("passed").get<bool>());
  EXPECT_EQ(same.at("parameters").size(), result().at("parameters").size());
  const Recipe& recipe = edf().recipes.at("edf-25");
  const calib::IdentificationProblem problem = problem_of(recipe);
  const auto identified = calib::identify(problem, recipe.identification);
  EXPECT_TRUE(document_of(problem, identified, {.complete = false}).at("validation").is_null());
}

TEST(ResultDocument, SaysWhatSimulatedCalibrationsTold) {
  const calib::MonteCarloFigures figures{.count = 400,
                                         .converged = 399,
                                         .box_rms_m = 5e-5,
                                         .box_p95_m = 1.25e-4,
                                         .linear_over_monte_carlo = 1.02,
                                         .warning = "one did not"};
  const calib::IdentificationProblem problem = problem_of(edf().recipes.at("edf-25"));
  const json document = json::parse(
      result_document(regions(), edf().recipes.at("edf-25"), problem, {}, {.monte_carlo = figures}));
  EXPECT_EQ(document.at("monte_carlo"), json::parse(R"({"count":400,"converged":399,"box_rms_mm":0.05,
      "box_p95_mm":0.125,"joint_ranges_rms_mm":null,"linear_over_monte_carlo":1.02})"));
  EXPECT_EQ(document.at("warnings").back(), "one did not");
}

TEST(ResultDocument, ThePapersArmIsFlagged) {
  const json& warning = result().at("scale").at("warning");
  EXPECT_EQ(result().at("verdict").at("accepted"), false);
  EXPECT_EQ(result().at("verdict").at("reasons"), json::array({warning}));
  // The touches are exact: beside the scale it warns of the noise that was declared.
  ASSERT_EQ(result().at("warnings").size(), 2U);
  EXPECT_NE(result().at("warnings")[0].get<std::string>().find("the declared noise of a touch"),
            std::string::npos);
  EXPECT_EQ(result().at("warnings")[1], warning);
}

TEST(ResultDocument, NamesTheTouchesThatWereRejectedAndWhatWasEstimatedOfTheBlock) {
  calib::IdentificationProblem problem = problem_of(edf().recipes.at("edf-25"));
  problem.artefact.parameters = {
      {.name = "stylus_radius", .kind = calib::ArtefactKind::kStylusRadius, .nominal = 0.003, .std = 5e-6},
      {.name = "plane5_tilt_u", .kind = calib::ArtefactKind::kFaceTilt},
      {.name = "temperature", .kind = calib::ArtefactKind::kTemperature, .nominal = 21.0, .std = 1.0}};
  calib::IdentificationResult identified;
  identified.rejected = {{.touch = 53, .residual_m = 1.21e-3},
                         {.touch = 60, .residual_m = -0.08, .reason = calib::RejectionReason::kWrongFace}};
  identified.artefact_errors = Eigen::Vector3d(1e-6, 2e-5, 0.5);
  identified.uncertainty.emplace();
  identified.uncertainty->artefact_std = Eigen::Vector3d(4.4e-6, 1e-5, 0.95);
  const json document = document_of(problem, identified);
  EXPECT_EQ(document.at("rejected_touches"),
            json::parse(R"([{"touch":54,"residual_mm":1.21,"reason":"outlier"},
                            {"touch":61,"residual_mm":-80.0,"reason":"wrong_plane"}])"));
  const json& parameters = document.at("artefact_parameters");
  ASSERT_EQ(parameters.size(), 3U);
  const std::vector<std::array<std::string, 2>> expected{
      {"mm", "identified"}, {"rad", "identified"}, {"degC", "prior"}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(parameters[i].at("unit"), expected[i][0]);
    EXPECT_EQ(parameters[i].at("status"), expected[i][1]) << parameters[i];
  }
  EXPECT_NEAR(parameters[0].at("value").get<double>(), 3.001, 1e-12);
  EXPECT_NEAR(parameters[0].at("std_uncertainty").get<double>(), 0.0044, 1e-12);
  EXPECT_NEAR(parameters[2].at("value").get<double>(), 21.5, 1e-12);
}

TEST(ResultDocument, BeforeItHasConvergedNoUncertaintyIsToldOf) {
  const json document = document_of(problem_of(edf().recipes.at("edf-25")), {});
  const json unknown = json::parse(R"({"k":2.0,"box_rms_mm":null,"box_p95_mm":null,"box_max_mm":null})");
  const json& tip = document.at("tip_uncertainty");
  for (const auto& [name, value] : tip.items()) {
    if (name == "expanded" || name == "arm_frame") continue;
    EXPECT_TRUE(value.is_null() || value == json::array()) << name;
  }
  EXPECT_EQ(tip.at("expanded"), unknown);
  for (const auto& [name, value] : tip.at("arm_frame").items())
    EXPECT_TRUE(name == "expanded" ? value == unknown : value.is_null()) << name;
  EXPECT_TRUE(document.at("monte_carlo").is_null());
  EXPECT_TRUE(document.at("scale").at("std_uncertainty_ppm").is_null());
  EXPECT_TRUE(document.at("fit").at("lack_of_fit_p").is_null());
  EXPECT_TRUE(document.at("fit").at("noise_used_um").is_null());
  for (const json& found : document.at("parameters")) EXPECT_TRUE(found.at("error").is_null());
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
  ASSERT_EQ(result().at("planes").size(), edf().block.faces.size());
  for (const json& plane : result().at("planes")) {
    EXPECT_NEAR(plane.at("calibrated_mean_mm").get<double>(), plane.at("reference_mm").get<double>(), 1e-6);
    EXPECT_NEAR(plane.at("error_removed_percent").get<double>(), 100.0, 1e-3);
  }
}

/// One mm or rad of a grouped error moves the tip as its named others do, each by its factor in mm or rad.
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
  const json planes = document_of(problem_of(edf().recipes.at("edf-25")), identified).at("planes");
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

TEST(ResultDocument, TheMeanOfAFaceFoundInPlaceIsAgainstTheReferenceWithTheFoundOffsetBesideIt) {
  calib::IdentificationResult identified;
  identified.distances = {
      {.face = 2, .nominal_mean_m = 2.3e-3, .calibrated_mean_m = 3e-6, .found_offset_m = 0.5e-3},
      {.face = 3, .nominal_mean_m = 2.3e-3, .calibrated_mean_m = 3e-6}};
  const json planes = document_of(problem_of(edf().recipes.at("edf-25")), identified).at("planes");
  EXPECT_NEAR(planes[0].at("estimated_offset_mm").get<double>(), 150.5, 1e-9);
  EXPECT_NEAR(planes[0].at("calibrated_mean_mm").get<double>(), 150.503, 1e-9);
  EXPECT_NEAR(planes[0].at("error_removed_percent").get<double>(), 100.0 * (1.0 - 0.503 / 2.3), 1e-9);
  EXPECT_TRUE(planes[1].at("estimated_offset_mm").is_null());
  EXPECT_NEAR(planes[1].at("calibrated_mean_mm").get<double>(), 75.003, 1e-9);
}

TEST(ResultDocument, ShowsTheSingularValuesThatTheChoiceWasMadeOnWithTheirGap) {
  const json& rank = result().at("rank");
  const auto sigma = rank.at("singular_values").get<std::vector<double>>();
  const auto count = result().at("identifiable_count").get<std::size_t>();
  ASSERT_EQ(sigma.size(), 37u);  // edf-25 leaves no candidate out
  EXPECT_DOUBLE_EQ(rank.at("singular_value_gap").get<double>(), sigma[count - 1] / sigma[count]);
  EXPECT_GT(rank.at("singular_value_gap").get<double>(), 1e9);
  calib::IdentificationResult refused;
  refused.message = "no touch";
  const json without = document_of(problem_of(edf().recipes.at("edf-25")), refused).at("rank");
  EXPECT_EQ(without.at("singular_values"), json::array());
  EXPECT_TRUE(without.at("singular_value_gap").is_null());
}

TEST(ResultDocument, AFigureThatIsNoNumberIsNull) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  calib::IdentificationResult identified;
  identified.iterations = {{nan, std::numeric_limits<double>::infinity(), nan, nan}};
  identified.noise_estimated_m = nan;
  identified.singular_values = {nan};
  identified.distances = {{.face = 0, .nominal_mean_m = 0.0, .nominal_rms_m = nan, .calibrated_mean_m = nan}};
  const json document = document_of(problem_of(edf().recipes.at("edf-25")), identified, {.complete = false});
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
  const json document = document_of(problem_of(edf().recipes.at("edf-25")), identified,
                                    {.complete = true, .warnings = {"touch 3: joint 2"}});
  EXPECT_EQ(document.at("warnings"), json::array({"touch 3: joint 2"}));
  EXPECT_EQ(document.at("converged"), false);
  EXPECT_EQ(document.at("verdict").at("accepted"), false);
  EXPECT_EQ(document.at("verdict").at("reasons"), json::array({"too few touches on plane 4"}));
}

}  // namespace
}  // namespace cell
