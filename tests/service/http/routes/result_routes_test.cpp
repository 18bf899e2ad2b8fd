#include "service/http/routes/internal/result_routes.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "config/arm_file.hpp"
#include "service/documents/verification_document.hpp"
#include "service/run/calibrated_arm.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/quiet_cell.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

class ResultRoutesTest : public ::testing::Test {
 protected:
  ResultRoutesTest() {
    int number = 0;
    for (const calib::Touch& touch : table3_touches()) {
      cell_.store().append_touch(
          run_, {.number = ++number, .plane = touch.face + 1, .joints = to_wire(touch.joints)});
    }
  }

  Folder folder_;
  QuietCell cell_;
  std::int64_t run_ = cell_.store().begin_run(
      {.recipe = "edf-25", .started_at = "start", .config_digest = cell_.operation().config_digest()});
};

TEST_F(ResultRoutesTest, TheArmReadsBackToTheKinematicsThatWereIdentified) {
  const Recipe& recipe = edf().recipes.at("edf-25");
  calib::IdentificationProblem problem = identification_problem(edf(), recipe);
  for (const calib::Touch& touch : table3_touches())
    problem.touches.push_back({touch.face, from_wire(to_wire(touch.joints)), touch.role});
  const auto identified = calib::identify(problem, recipe.identification);
  cell_.store().finish_run(
      run_, {.outcome = RunOutcome::kComplete, .arm_json = calibrated_arm_document(edf(), identified)});
  const HttpResponse response = get_arm(cell_.operation(), run_);
  ASSERT_EQ(response.status, 200u) << response.body;
  folder_.write("arm.json", response.body);
  const Arm arm = read_arm(folder_.path() / "arm.json");
  for (const calib::Touch& touch : table3_touches()) {
    const auto tip_of = [&touch](const calib::KinematicModel& model) {
      return calib::forward_kinematics(model, touch.joints).matrix();
    };
    EXPECT_LT((tip_of(arm.model) - tip_of(identified.calibrated)).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_GT((tip_of(arm.model) - tip_of(edf().arm.model)).cwiseAbs().maxCoeff(), 1e-4);
  }
  EXPECT_EQ(arm.std_errors, edf().arm.std_errors) << "the maker's tolerances stay";
}

TEST_F(ResultRoutesTest, ARunThatWasCutOffHasAResultThatSaysSo) {
  const HttpResponse response = get_result(cell_.operation(), run_);
  ASSERT_EQ(response.status, 200u) << response.body;
  const json document = json::parse(response.body);
  EXPECT_EQ(document.at("complete"), false);
  EXPECT_EQ(document.at("identifiable_count"), 25);
}

TEST_F(ResultRoutesTest, TheReportSetsSimulatedCalibrationsBesideTheLinearUncertainty) {
  const StoredRun open = cell_.store().run(run_).value();
  EXPECT_EQ(get_simulated_report(cell_.operation(), open, {.format = "json"}, 100).status, 409u)
      << "it is not over";
  cell_.store().finish_run(
      run_, {.outcome = RunOutcome::kComplete, .result_json = get_result(cell_.operation(), run_).body});
  const StoredRun stored = cell_.store().run(run_).value();
  const auto report = [&] {
    return json::parse(get_simulated_report(cell_.operation(), stored, {.format = "json"}, 100).body)
        .at("result");
  };
  const json result = report();
  EXPECT_EQ(result.at("monte_carlo").at("count"), 100);
  EXPECT_NEAR(result.at("monte_carlo").at("linear_over_monte_carlo").get<double>(), 1.0, 0.3);
  EXPECT_EQ(report(), result) << "it can be repeated";
  const std::string page = get_simulated_report(cell_.operation(), stored, {.format = "html"}, 100).body;
  EXPECT_THAT(page, HasSubstr("100 drawn, 100 converged"));
  const ReportForm german{.format = "html", .language = "de"};
  EXPECT_THAT(get_simulated_report(cell_.operation(), stored, german, 100).body,
              HasSubstr("100 gezogen, 100 konvergiert"));
  json without = result;
  without["monte_carlo"] = nullptr;
  EXPECT_EQ(without,
            json::parse(get_report(cell_.operation(), stored, {.format = "json"}).body).at("result"));
}

TEST_F(ResultRoutesTest, ACheckHasAReportOfItsOwnAndNoSimulation) {
  CheckDocument check{.arm = "tx90", .of_run = std::to_string(run_), .touch_count = 1, .complete = true};
  check.verdict.accepted = true;
  check.touches = {{.touch = 1, .plane = 1, .change_mm = 0.25}};
  const std::int64_t id = cell_.store().begin_run(
      {.kind = RunKind::kCheck, .of_run = run_, .recipe = "edf-25", .started_at = "start"});
  cell_.store().append_touch(id, {.number = 1, .plane = 1});
  cell_.store().finish_run(id, {.outcome = RunOutcome::kComplete, .result_json = document_text(check)});
  const StoredRun stored = cell_.store().run(id).value();
  const auto report = [&](const char* format) {
    return get_report(cell_.operation(), stored, {.format = format});
  };

  const json document = json::parse(report("json").body);
  EXPECT_EQ(document.at("kind"), "check");
  EXPECT_EQ(document.at("cell"), edf().name);
  EXPECT_EQ(document.at("calibration").at("id"), std::to_string(run_));
  EXPECT_FALSE(document.at("calibration").at("raw_data_sha256").is_null());
  EXPECT_EQ(document.at("touches").at(0).at("deviation_mm"), 0.25);
  EXPECT_THAT(report("html").body, HasSubstr("Verdict: unchanged"));
  EXPECT_THAT(report("csv").body, HasSubstr(",0.250000,"));
  EXPECT_EQ(report("pdf").status, 400u);
  const auto in = [&](const char* format, const char* language) {
    return get_report(cell_.operation(), stored, {.format = format, .language = language});
  };
  EXPECT_THAT(in("html", "fr").body, HasSubstr("<strong>Verdict : inchangé</strong>"));
  EXPECT_EQ(in("csv", "fr").body, report("csv").body);
  EXPECT_EQ(in("json", "de").body, report("json").body);
  EXPECT_EQ(in("html", "it").status, 400u);
  EXPECT_THAT(in("html", "it").body, HasSubstr("language is en, fr or de"));
  const HttpResponse refused = get_simulated_report(cell_.operation(), stored, {.format = "html"}, 100);
  EXPECT_EQ(refused.status, 409u);
  EXPECT_THAT(refused.body, HasSubstr("is a check, which calibrates nothing"));
}

TEST_F(ResultRoutesTest, AProofThatWasCutOffHasAReportThatSaysSo) {
  const std::int64_t id = cell_.store().begin_run(
      {.kind = RunKind::kProof, .of_run = run_, .recipe = "edf-25", .started_at = "start"});
  cell_.store().finish_run(id, {.outcome = RunOutcome::kInterrupted});
  const StoredRun stored = cell_.store().run(id).value();
  EXPECT_TRUE(
      json::parse(get_report(cell_.operation(), stored, {.format = "json"}).body).at("result").is_null());
  EXPECT_THAT(get_report(cell_.operation(), stored, {.format = "html"}).body,
              HasSubstr("the run ended before it had a result"));
}

TEST_F(ResultRoutesTest, AResultThatIsNotThatOfTheTouchesIsNotSimulated) {
  const json same = json::parse(get_result(cell_.operation(), run_).body);
  std::size_t estimated = 0;
  while (same.at("parameters").at(estimated).at("error").is_null()) ++estimated;
  const std::vector<json::json_pointer> figures{
      json::json_pointer("/tip_uncertainty/workspace_box_rms_mm"),
      json::json_pointer("/parameters/" + std::to_string(estimated) + "/error")};
  for (const auto& figure : figures) {
    json other = same;
    other[figure] = 1.001 * other[figure].get<double>();
    cell_.store().finish_run(run_, {.outcome = RunOutcome::kComplete, .result_json = other.dump()});
    const HttpResponse response =
        get_simulated_report(cell_.operation(), cell_.store().run(run_).value(), {.format = "json"}, 100);
    EXPECT_EQ(response.status, 409u) << figure.to_string();
    EXPECT_THAT(response.body, HasSubstr("this version of touchcal"));
  }
}

TEST_F(ResultRoutesTest, ADaemonThatEndsDoesNotWaitForASimulation) {
  cell_.store().finish_run(
      run_, {.outcome = RunOutcome::kComplete, .result_json = get_result(cell_.operation(), run_).body});
  std::stop_source ending;
  Reads reads(cell_.operation());
  reads.end_with(ending.get_token());
  ending.request_stop();
  EXPECT_THROW(get_simulated_report(reads, cell_.store().run(run_).value(), {.format = "json"}, 10'000),
               std::runtime_error);
}

TEST_F(ResultRoutesTest, ARunIsIdentifiedAtItsOwnTemperature) {
  const std::int64_t warm = cell_.store().begin_run(
      {.recipe = "edf-25",
       .started_at = "start",
       .block_temperature = StoredTemperature{.celsius = 40.0, .std_k = 0.5, .source = "run"},
       .config_digest = cell_.operation().config_digest()});
  for (const StoredTouch& touch : cell_.store().touches(run_)) cell_.store().append_touch(warm, touch);
  const auto lengths = [&](std::int64_t run) {
    const json document = json::parse(get_result(cell_.operation(), run).body);
    for (const json& parameter : document.at("parameters"))
      if (parameter.at("name") == "d3")
        return parameter.at("nominal").get<double>() + parameter.at("error").get<double>();
    return 0.0;
  };
  // A block that is 20 K warmer makes every length of the arm 20 K x 23.6 ppm/K longer.
  EXPECT_NEAR(lengths(warm) / lengths(run_) - 1.0, 20.0 * 2.36e-5, 5e-5);
}

TEST_F(ResultRoutesTest, ARunIsIdentifiedWithItsOwnChoiceOfStiffness) {
  const std::int64_t elastic = cell_.store().begin_run({.recipe = "edf-25",
                                                        .started_at = "start",
                                                        .stiffness = "on",
                                                        .config_digest = cell_.operation().config_digest()});
  for (const StoredTouch& touch : cell_.store().touches(run_)) cell_.store().append_touch(elastic, touch);
  const auto model = [&](std::int64_t run) {
    return json::parse(get_result(cell_.operation(), run).body).at("model");
  };
  EXPECT_EQ(model(run_), json::array());
  EXPECT_EQ(model(elastic), json::array({"compliance2", "compliance3"}));
}

TEST_F(ResultRoutesTest, WithoutATouchThereIsNoResult) {
  const std::int64_t empty = cell_.store().begin_run(
      {.recipe = "edf-25", .started_at = "start", .config_digest = cell_.operation().config_digest()});
  const HttpResponse response = get_result(cell_.operation(), empty);
  EXPECT_EQ(response.status, 409u);
  EXPECT_THAT(response.body, HasSubstr("no touch"));
}

/// An arm is written to a controller: never that of a run which is not over, whatever its touches say so far.
TEST_F(ResultRoutesTest, NoArmIsMadeWhereNoneWasStored) {
  const HttpResponse open = get_arm(cell_.operation(), run_);
  EXPECT_EQ(open.status, 409u);
  EXPECT_THAT(open.body, HasSubstr("stored when the run ends"));
  cell_.store().finish_run(run_, {.outcome = RunOutcome::kAborted});
  const HttpResponse ended = get_arm(cell_.operation(), run_);
  EXPECT_EQ(ended.status, 409u);
  EXPECT_THAT(ended.body, HasSubstr("no calibrated arm was stored"));
}

TEST_F(ResultRoutesTest, WhatWasStoredAtTheEndIsToldWhateverTheFilesAreNow) {
  const std::string result = R"({"schema":"touchcal/result/1"})", arm = R"({"schema":"touchcal/arm/2"})";
  const std::int64_t old = cell_.store().begin_run(
      {.recipe = "edf-25", .started_at = "start", .config_digest = "of files that are gone"});
  cell_.store().finish_run(old, {.outcome = RunOutcome::kComplete, .result_json = result, .arm_json = arm});
  EXPECT_EQ(get_result(cell_.operation(), old).body, result);
  EXPECT_EQ(get_arm(cell_.operation(), old).body, arm);
}

TEST_F(ResultRoutesTest, ARunOfOtherFilesIsNotComputedAgain) {
  for (const std::optional<std::string>& digest :
       {std::optional<std::string>(), std::optional<std::string>("another")}) {
    const std::int64_t other =
        cell_.store().begin_run({.recipe = "edf-25", .started_at = "start", .config_digest = digest});
    for (const StoredTouch& touch : cell_.store().touches(run_)) cell_.store().append_touch(other, touch);
    const HttpResponse response = get_result(cell_.operation(), other);
    EXPECT_EQ(response.status, 409u);
    EXPECT_THAT(response.body, HasSubstr("files are not those of this run"));
    const StoredRun stored = cell_.store().run(other).value();
    const json report = json::parse(get_report(cell_.operation(), stored, {.format = "json"}).body);
    EXPECT_TRUE(report.at("result").is_null());
  }
}

TEST_F(ResultRoutesTest, ARunWithTheBlockElsewhereIsNotComputedAgain) {
  const std::int64_t moved =
      cell_.store().begin_run({.recipe = "edf-25",
                               .started_at = "start",
                               .config_digest = cell_.operation().config_digest(),
                               .conditions_json = R"({"place":{"shift_mm":[1,2,3]}})"});
  for (const StoredTouch& touch : cell_.store().touches(run_)) cell_.store().append_touch(moved, touch);
  const HttpResponse refused = get_result(cell_.operation(), moved);
  EXPECT_EQ(refused.status, 409u);
  EXPECT_THAT(refused.body, HasSubstr("where it stood in this run"));
}

}  // namespace
}  // namespace cell
