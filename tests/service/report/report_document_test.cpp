#include "service/report/report_document.hpp"

#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "cs8_protocol/messages.hpp"
#include "service/base/digest.hpp"
#include "service/base/json_figures.hpp"
#include "service/report/report_html.hpp"
#include "tests/service/report/calibrated_run.hpp"
#include "tests/service/report/markup.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

RunReport report_of(const RunRecord& of) { return read_report(report_document(of)); }

std::string page_of(const RunRecord& of) { return report_html(report_of(of), "2026-02-01T00:00:00.000Z"); }

Json json_of(const RunRecord& of) { return Json::parse(report_document(of)); }

TEST(Report, TheRawDatasDigestIsThatOfTheTablesFirstNineColumns) {
  const Json report = json_of(calibrated_run());
  std::istringstream lines(report_csv(report_of(calibrated_run())));
  std::string line, columns;
  std::getline(lines, line);
  EXPECT_THAT(line, ::testing::StartsWith("touch,plane,role,joint1_deg,"));
  while (std::getline(lines, line)) {
    std::size_t end = 0;
    for (int i = 0; i < 9; ++i) end = line.find(',', end + 1);
    columns += line.substr(0, end) + "\n";
  }
  EXPECT_EQ(columns, raw_data_text(calibrated_run().touches));
  EXPECT_EQ(report.at("raw_data").at("sha256"), sha256_hex(columns));
}

TEST(Report, ARefusedContactIsShownWithItsReasonAndCountsForNothing) {
  RunRecord made = calibrated_run();
  const std::string digest = json_of(made).at("raw_data").at("sha256");
  made.refused.push_back({.session = 1,
                          .sequence = 4'000'000'000,
                          .joints = {1'500'000, 0, 0, 0, 0, -1},
                          .reason = "its tip is <far> beside the search line",
                          .at = "2026-01-31T08:15:30.250Z"});
  const Json told = json_of(made).at("refused_contacts").at(0);
  EXPECT_EQ(told.at("sequence"), 4'000'000'000);
  EXPECT_EQ(told.at("joints_deg").at(0), "1.500000");
  EXPECT_EQ(told.at("joints_deg").at(5), "-0.000001");
  EXPECT_EQ(json_of(made).at("raw_data").at("sha256"), digest);
  EXPECT_THAT(page_of(made), HasSubstr("its tip is &lt;far&gt; beside the search line"));
}

TEST(Report, AnAngleIsWrittenToTheLastDigitThatCameOverTheWire) {
  const std::vector<StoredTouch> touches{
      {.number = 1, .plane = 2, .joints = {1, -1, 0, 90'000'000, -179'999'999, -500'000}}};
  EXPECT_EQ(raw_data_text(touches), "1,2,fit,0.000001,-0.000001,0.000000,90.000000,-179.999999,-0.500000\n");
}

TEST(Report, OneChangedAngleIsAnotherDigest) {
  RunRecord changed = calibrated_run();
  changed.touches[3].joints[2] += 1;
  EXPECT_NE(json_of(changed).at("raw_data").at("sha256"),
            json_of(calibrated_run()).at("raw_data").at("sha256"));
}

TEST(Report, EachTouchIsShownWithItsDistances) {
  const Json report = json_of(calibrated_run());
  ASSERT_EQ(report.at("touches").size(), result().at("touches").size());
  for (std::size_t i = 0; i < report.at("touches").size(); ++i) {
    EXPECT_EQ(report.at("touches")[i].at("plane"), result().at("touches")[i].at("plane").get<int>());
    EXPECT_EQ(report.at("touches")[i].at("nominal_mm"),
              result().at("touches")[i].at("nominal_mm").get<double>());
  }
}

TEST(Report, ThePageNamesWhatWasEstimatedBesideTheErrors) {
  EXPECT_THAT(page_of(calibrated_run()), Not(HasSubstr("Beside rigid kinematics")));
  json more = result();
  more["nongeometric_parameters"] = {{{"name", "compliance2"},
                                      {"unit", "rad/Nm"},
                                      {"value", 8.5e-7},
                                      {"std_uncertainty", 3e-7},
                                      {"status", "identified"}}};
  RunRecord made = calibrated_run();
  made.result_json = more.dump();
  EXPECT_THAT(page_of(made), HasSubstr("Beside rigid kinematics"));
  EXPECT_THAT(page_of(made), HasSubstr("<td>8.5e-07</td>"));
}

TEST(Report, ThePageGivesTheTipsUncertaintyWithItsFactorInBothFrames) {
  const std::string page = page_of(calibrated_run());
  for (const json& frame : {result().at("tip_uncertainty"), result().at("tip_uncertainty").at("arm_frame")}) {
    for (const char* figure : {"box_rms_mm", "box_p95_mm", "box_max_mm"}) {
      EXPECT_THAT(page, HasSubstr(fmt::format("{:.3f} mm", frame.at("expanded").at(figure).get<double>())));
    }
  }
  EXPECT_THAT(page, HasSubstr("k = 2"));
}

TEST(Report, ThePageShowsSimulatedCalibrationsWhereTheResultHasThem) {
  EXPECT_THAT(page_of(calibrated_run()), Not(HasSubstr("Simulated calibrations")));
  json more = result();
  more["monte_carlo"] = {{"count", 400},
                         {"converged", 399},
                         {"box_rms_mm", 0.0515},
                         {"box_p95_mm", 0.125},
                         {"joint_ranges_rms_mm", nullptr},
                         {"linear_over_monte_carlo", 1.02}};
  RunRecord made = calibrated_run();
  made.result_json = more.dump();
  const std::string page = page_of(made);
  for (const char* text : {"Simulated calibrations", "400 drawn, 399 converged", "<td>0.125</td>", "1.020"})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(Report, ThePageHasThePapersTablesWithTheResultsFigures) {
  const std::string page = page_of(calibrated_run());
  for (const char* table : {"Table III", "Table IV", "Table V", "Table VI", "Table VII"})
    EXPECT_THAT(page, HasSubstr(table));
  int shown = 0;
  for (const json& one : result().at("parameters")) {
    if (!one.at("error").is_number()) continue;
    const std::string figure = fmt::format("{:+.4f}", one.at("error").get<double>());
    if (one.at("unit") != "mm") continue;
    EXPECT_THAT(page, HasSubstr("<td>" + figure + "</td>")) << one.at("name");
    ++shown;
  }
  EXPECT_GT(shown, 10);
  EXPECT_EQ(first_unclosed(page), "");
}

TEST(Report, APlaneThatAFurtherTipTouchesIsNamedWithItAndTheTipsHaveTheirShare) {
  json more = result();
  json& plane = more["planes"][0];
  plane["tip"] = "left";
  more["tip_uncertainty"]["sources"].push_back({{"name", "stylus_tips"}, {"workspace_box_rms_mm", 0.0042}});
  RunRecord made = calibrated_run();
  made.result_json = more.dump();
  const std::string page = page_of(made);
  const std::string named = fmt::format("d{} (tip left)", plane.at("plane").get<int>());
  for (const std::string& text : {"<td>" + named + "</td>", named + " of the",
                                  std::string("<td>stylus tips</td>"), std::string("<td>0.0042</td>")})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(Report, ThePageHasAFigureForTheConditionNumberAndForEachPlaneUsedAndHeldOut) {
  const std::string page = page_of(calibrated_run());
  std::size_t planes = result().at("planes").size() + result().at("planes_held_out").size();
  for (std::size_t number = 4; number < 5 + planes; ++number)
    EXPECT_THAT(page, HasSubstr(fmt::format("<title>Fig. {}.", number)));
  EXPECT_THAT(page, Not(HasSubstr(fmt::format("<title>Fig. {}.", 5 + planes))));
}

TEST(Report, ThePageNeedsNothingFromElsewhereAndRunsNothing) {
  const std::string page = page_of(calibrated_run());
  for (const char* foreign : {"<script", "<img", "<link", "url(", "href", "src="})
    EXPECT_THAT(page, Not(HasSubstr(foreign)));
}

TEST(Report, TheBlocksTemperatureIsToldWithItsSourceAndTime) {
  RunRecord warm = calibrated_run();
  warm.run.block_temperature = StoredTemperature{.celsius = 25.5, .std_k = 0.5, .source = "run"};
  Json document = Json::parse(warm.result_json.value());
  document.at("conditions")
      .update({{"std_temperature_k", 0.5},
               {"block_temperature_source", "run"},
               {"block_temperature_at", "2026-01-31T08:15:30.000Z"}});
  warm.result_json = document.dump();
  EXPECT_THAT(page_of(warm),
              HasSubstr("25.5 °C ± 0.5 K (std), given with the run, measured 2026-01-31T08:15"));
  EXPECT_THAT(page_of(calibrated_run()), HasSubstr(", from the block&#39;s file"));
}

TEST(Report, TheMinutesThatTheArmHadMovedAreTold) {
  RunRecord moving = calibrated_run();
  Json document = Json::parse(moving.result_json.value());
  document.at("conditions")["arm_moving_min"] = 45;
  moving.result_json = document.dump();
  EXPECT_THAT(page_of(moving), HasSubstr("45 min before the run"));
}

TEST(Report, SerialNumbersAreToldAndUnknownWhereNobodyGaveThem) {
  RunRecord known = calibrated_run();
  Json document = Json::parse(known.result_json.value());
  Json& conditions = document.at("conditions");
  conditions.update({{"arm_serial", "F09-1"}, {"controller_serial", "F09-C-2"}});
  conditions.at("block")["serial"] = "B-3";
  conditions.at("probe")["serial"] = "P-4";
  known.result_json = document.dump();
  const std::string page = page_of(known);
  for (const char* told : {"; F09-1<", ">F09-C-2<", "; B-3<", "; P-4<"}) EXPECT_THAT(page, HasSubstr(told));
  conditions["controller_serial"] = nullptr;
  known.result_json = document.dump();
  EXPECT_THAT(page_of(known), HasSubstr("controller&#39;s serial number</td><td>unknown<"));
}

TEST(Report, TheFirstPageHasWhatIsSigned) {
  RunRecord ended = calibrated_run();
  ended.run.ended_at = "2026-01-31T08:25:30.250Z";
  ended.run.verdict = Verdict::kAccepted;
  ended.run.operator_name = "M. Curie";
  const std::string page = page_of(ended);
  const std::string number = "20260131-7-" + report_of(ended).raw_data.sha256.substr(0, 8);
  const std::string front = page.substr(0, page.find("Run and conditions"));
  for (const std::string& told :
       {"<h1>Calibration report " + number + "</h1>", std::string("Verdict: accepted"),
        std::string("<td>date of issue</td><td>2026-02-01T00:00:00.000Z</td>"),
        std::string("<td>M. Curie</td>"), std::string("Expanded uncertainty of the tip, k = 2"),
        std::string("Decision rule"), std::string("Calibrated by"), std::string("Approved by")})
    EXPECT_THAT(front, HasSubstr(told));
  std::size_t signatures = 0;
  for (std::size_t at = front.find("Signature:"); at != std::string::npos;
       at = front.find("Signature:", at + 1))
    ++signatures;
  EXPECT_EQ(signatures, 2U);
  const json expanded = result().at("tip_uncertainty").at("expanded");
  EXPECT_THAT(front, HasSubstr(fmt::format("<td>{:.3f}</td>", expanded.at("box_max_mm").get<double>())));
  EXPECT_THAT(page, HasSubstr("content: \"Calibration report " + number + "\"")) << "the head of each page";
}

TEST(Report, ItsNumberIsTheSameForEveryReportOfTheRunAndAnotherForOtherTouches) {
  RunRecord ended = calibrated_run();
  const auto heading = [](const std::string& page) { return page.substr(page.find("<h1>"), 60); };
  EXPECT_EQ(heading(page_of(ended)), heading(report_html(report_of(ended), "later")));
  RunRecord other = calibrated_run();
  other.touches[0].joints[0] += 1;
  EXPECT_NE(heading(page_of(ended)), heading(page_of(other)));
}

TEST(Report, TheBudgetSharesAddUpAndNothingIsInvented) {
  const json tip = result().at("tip_uncertainty");
  const std::string page = page_of(calibrated_run());
  double sum = 0.0;
  for (const json& source : tip.at("sources")) {
    const double part = source.at("workspace_box_rms_mm"), whole = tip.at("workspace_box_rms_mm");
    const std::string share = fmt::format("{:.1f}", 1e2 * (part / whole) * (part / whole));
    EXPECT_THAT(page, HasSubstr(fmt::format("<td>{:.4f}</td><td>{}</td>", part, share))) << source;
    sum += part * part / (whole * whole);
  }
  EXPECT_NEAR(sum, 1.0, 1e-6) << "the sources are all that the tip's uncertainty is made of";
  EXPECT_THAT(page, HasSubstr("<td>touch noise</td><td>A</td><td>0 µm</td>"));
  EXPECT_THAT(page, HasSubstr("<td>block size</td><td>B</td><td>several</td><td>as declared</td>"));
}

TEST(Report, CertificatesAreToldByTheirKeysAndUnknownWhereNobodyGaveThem) {
  RunRecord known = calibrated_run();
  Json document = Json::parse(known.result_json.value());
  document.at("conditions").at("block")["certificate"] = {{"laboratory", "LNE"}, {"covers", "four <faces>"}};
  document.at("conditions").at("probe")["certificate"] = nullptr;
  known.result_json = document.dump();
  const std::string page = page_of(known);
  EXPECT_THAT(page, HasSubstr("<td>LNE</td><td>unknown</td><td>unknown</td><td>unknown</td><td>unknown</td>"
                              "<td>covers: four &lt;faces&gt;</td>"));
  EXPECT_THAT(page, HasSubstr("ISO/IEC 17025"));
}

TEST(Report, TextFromOutsideStaysText) {
  RunRecord hostile = calibrated_run();
  const std::string markup = "<script>alert('x')</script>\x01&\"";
  hostile.run.operator_name = markup;
  hostile.run.recipe = markup;
  SupersededTouch again;
  again.reason = markup;
  hostile.superseded.push_back(again);
  hostile.faults.push_back({.id = 1, .run_id = 7, .at = markup, .code = markup, .message = markup});
  const std::string page = page_of(hostile);
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&amp;&quot;"));
  EXPECT_EQ(first_unclosed(page), "");
}

TEST(Report, IsWrittenAsItWasRead) {
  const std::string text = report_document(calibrated_run());
  EXPECT_EQ(document_text(read_report(text)), text);
}

TEST(Report, ARunWithoutResultSaysSo) {
  RunRecord young = calibrated_run();
  young.result_json.reset();
  const Json report = json_of(young);
  EXPECT_TRUE(report.at("result").is_null());
  EXPECT_TRUE(report.at("touches")[0].at("use").is_null());
  EXPECT_THAT(page_of(young), HasSubstr("This run has no result"));
  EXPECT_EQ(first_unclosed(page_of(young)), "");
}

/// What a daemon of an earlier version stored lacks parts.
TEST(Report, WhatAnOlderResultLacksIsUnknown) {
  for (const auto& [key, unused] : result().items()) {
    json older = result();
    older.erase(key);
    RunRecord stored = calibrated_run();
    stored.result_json = older.dump();
    EXPECT_EQ(first_unclosed(page_of(stored)), "") << key;
    EXPECT_EQ(json_of(stored).at("result"), Json(older))
        << key << ": the stored result is passed on as it is";
  }
}

}  // namespace
}  // namespace cell
