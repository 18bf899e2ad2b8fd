#include <gmock/gmock.h>

#include <list>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "service/report/report_html.hpp"
#include "service/report/verification_html.hpp"
#include "tests/service/report/calibrated_run.hpp"
#include "tests/service/report/markup.hpp"
#include "tests/service/report/verified_run.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kIssuedAt = "2026-02-04T00:00:00.000Z";
constexpr std::string_view kOpen = "⟦", kClose = "⟧";

json criterion(const std::string& name, std::optional<double> value, bool is_within) {
  return {{"name", name},
          {"plane", name == "held_out_mean" ? json(3) : json()},
          {"tool", nullptr},
          {"unit", "mm"},
          {"value", value ? json(*value) : json()},
          {"side", name == "held_out_touches" ? "lower" : "upper"},
          {"limit", 0.125},
          {"expanded_uncertainty", 0.05},
          {"within_limit", is_within},
          {"proved", false}};
}

/// A calibration of which every part of the report has something to tell.
RunRecord told_calibration() {
  RunRecord made = calibrated_run();
  made.run.ended_at = "2026-01-31T08:25:30.250Z";
  made.run.outcome = RunOutcome::kComplete;
  made.run.verdict = Verdict::kRejected;
  made.run.operator_name = "Curie";
  made.run.touches_total = 200;
  made.run.block_temperature = StoredTemperature{.celsius = 25.5, .std_k = 0.5, .source = "run"};
  json more = result();
  json criteria = json::array();
  for (const char* name :
       {"complete", "converged", "held_out_touches", "held_out_mean", "held_out_rms", "condition_number",
        "tip_box_rms", "tip_box_max", "tool_box_rms", "unknown_errors", "nominal_miss", "scale", "artefact",
        "lack_of_fit", "rejected_touches", "held_parameters", "shown_parameters"})
    criteria.push_back(criterion(name, name == std::string("artefact") ? std::nullopt : std::optional(0.25),
                                 name == std::string("scale")));
  more["verdict"] = {{"accepted", false},
                     {"reasons", {"an English reason"}},
                     {"decision_rule",
                      {{"standard", "ISO 14253-1:2017"},
                       {"rule", "simple"},
                       {"text", "an English rule"},
                       {"coverage_factor", 2.0},
                       {"criteria", criteria}}}};
  more["warnings"] = {"an English warning"};
  more["planes"][0]["tip"] = "left";
  more["nongeometric_parameters"] = {{{"name", "compliance2"},
                                      {"unit", "rad/Nm"},
                                      {"value", 8.5e-7},
                                      {"std_uncertainty", 3e-7},
                                      {"status", "prior"}}};
  more["monte_carlo"] = {{"count", 400},
                         {"converged", 399},
                         {"box_rms_mm", 0.05},
                         {"box_p95_mm", 0.125},
                         {"joint_ranges_rms_mm", nullptr},
                         {"linear_over_monte_carlo", 1.02}};
  more["rejected_touches"] = {{{"touch", 3}, {"residual_mm", 0.5}, {"reason", "outlier"}},
                              {{"touch", 4}, {"residual_mm", 0.5}, {"reason", "wrong_plane"}}};
  more["conditions"]["block"]["certificate"] = nullptr;
  more["conditions"].update({{"block_temperature_source", "run"}, {"std_temperature_k", 0.5}});
  made.result_json = more.dump();
  SupersededTouch again;
  again.reason = "an English cause";
  made.superseded.push_back(again);
  made.references.push_back({.touches_done = 5, .drift_mm = 0.01});
  made.refused.push_back({.session = 1, .sequence = 4, .reason = "an English cause"});
  made.faults.push_back(
      {.id = 1, .run_id = 7, .at = "then", .code = "no_contact", .message = "an English message"});
  made.proofs.push_back({.id = 9, .ended_at = "then", .verdict = Verdict::kAccepted});
  return made;
}

VerificationRecord without_result(RunOutcome outcome) {
  VerificationRecord record = proof_record();
  record.own.result_json.reset();
  record.own.run.outcome = outcome;
  if (outcome == RunOutcome::kAborted) record.own.run.fault_message = "an English message";
  return record;
}

/// Each kind of report, and what it says where something is missing.
std::map<std::string, std::string> pages(const Words& words) {
  std::map<std::string, std::string> made;
  const auto calibration = [&](const RunRecord& record) {
    return report_html(read_report(report_document(record)), kIssuedAt, words);
  };
  const auto verification = [&](const VerificationRecord& record) {
    return verification_html(read_verification_report(verification_report_document(record)), kIssuedAt,
                             words);
  };
  made["calibration"] = calibration(told_calibration());
  RunRecord bare = calibrated_run();
  bare.result_json.reset();
  made["calibration without result"] = calibration(bare);
  made["proof"] = verification(proof_record());
  VerificationRecord checked = check_record();
  checked.checks = charted_checks();
  made["check"] = verification(checked);
  QualificationDocument qualification = made_qualification();
  for (const char* name : {"scatter", "lobes", "stylus"})
    qualification.criteria.push_back({.name = name, .unit = "mm", .value = 0.25, .passed = false});
  made["qualification"] = verification(qualification_record(qualification));
  made["tool"] = verification(verified_run(RunKind::kTool, document_text(made_tool())));
  made["proof that goes on"] = verification(without_result(RunOutcome::kRunning));
  made["proof that failed"] = verification(without_result(RunOutcome::kAborted));
  VerificationRecord orphan = proof_record();
  orphan.calibration.reset();
  orphan.calibration_touches.clear();
  made["proof without calibration"] = verification(orphan);
  return made;
}

/// Says each text that has a translation between brackets: what stands outside of them has none.
Words marking() {
  static const std::list<std::string> kMarked = [] {
    std::list<std::string> marked;
    for (const auto& table : {kWordsFr, kVerificationWordsFr})
      for (const Translation& each : table)
        marked.push_back(std::string(kOpen) + std::string(each.english) + std::string(kClose));
    return marked;
  }();
  static const std::vector<Translation> kTable = [] {
    std::vector<Translation> table;
    for (const std::string& each : kMarked)
      table.push_back(
          {std::string_view(each).substr(kOpen.size(), each.size() - kOpen.size() - kClose.size()), each});
    return table;
  }();
  return {"x-marked", ',', {kTable}};
}

/// What a reader of the page sees outside of the brackets and of what is marked as English.
std::string unmarked(std::string page) {
  page = page.substr(page.find("<body>"));
  page = std::regex_replace(page, std::regex(R"re(<(\w+) lang="en">[^<]*</\w+>)re"), " ");
  page = std::regex_replace(page, std::regex("<[^>]*>"), " | ");
  std::string outside;
  int depth = 0;
  for (std::size_t i = 0; i < page.size(); ++i) {
    if (page.compare(i, kOpen.size(), kOpen) == 0) {
      ++depth;
      i += kOpen.size() - 1;
    } else if (page.compare(i, kClose.size(), kClose) == 0) {
      --depth;
      i += kClose.size() - 1;
    } else if (depth == 0) {
      outside += page[i];
    }
  }
  return outside;
}

/// What is the same in each language: units, names of parameters and of things, codes and digests.
bool is_no_word(const std::string& token) {
  static const std::regex kNames(
      R"([0-9a-f]*\d[0-9a-f]*|F09|[dr]\d|T\d\d|(alpha|beta|theta|compliance|plane|bore|sphere|offset|normal)_?\w*)");
  static const std::set<std::string> kSame{"mm",      "rad",  "ppm",     "mrad", "Nm",        "LNE",   "edf",
                                           "tx90",    "cube", "lp2",     "hall", "Curie",     "quick", "best",
                                           "gripper", "then", "undated", "left", "no_contact"};
  return kSame.contains(token) || std::regex_match(token, kNames);
}

TEST(ReportLanguages, NoTextOfAReportOfAnyKindIsWithoutTranslation) {
  static const std::regex kToken(R"([A-Za-z_][A-Za-z_0-9]+)");
  const Words words = marking();
  for (const auto& [kind, page] : pages(words)) {
    EXPECT_THAT(page, HasSubstr(kOpen));
    const std::string seen = unmarked(page);
    std::set<std::string> left;
    for (std::sregex_iterator each(seen.begin(), seen.end(), kToken), end; each != end; ++each)
      if (!is_no_word(each->str())) left.insert(each->str());
    EXPECT_THAT(left, IsEmpty()) << kind;
  }
}

TEST(ReportLanguages, APageSaysItsLanguageAndHasNoFigureWithAPoint) {
  static const std::regex kPoint(R"(>[^<]*[^-:T\d]\d+\.\d+[^<]*<)");
  for (const char* tag : {"fr", "de"}) {
    for (const auto& [kind, page] : pages(*words_in(tag))) {
      EXPECT_THAT(page, HasSubstr(std::string("<html lang=\"") + tag + "\">")) << kind;
      EXPECT_EQ(first_unclosed(page), "") << tag << kind;
      EXPECT_THAT(page, HasSubstr(kIssuedAt)) << "dates stay as they are";
      std::smatch found;
      std::string body = page.substr(page.find("<body>"));
      body = std::regex_replace(body, std::regex(R"re(lang="en">[^<]*<|touchcal [\d.]+)re"), "<");
      EXPECT_FALSE(std::regex_search(body, found, kPoint)) << tag << ' ' << kind << ": " << found.str();
    }
  }
}

TEST(ReportLanguages, WhatARunStoredInEnglishIsMarkedAndNeverInAnEnglishReport) {
  for (const auto& [kind, page] : pages(*words_in("fr"))) {
    const std::string rest = std::regex_replace(page, std::regex(R"re(<\w+ lang="en">[^<]*<)re"), "<");
    EXPECT_THAT(rest, Not(HasSubstr("an English"))) << kind;
  }
  const auto french = pages(*words_in("fr"));
  EXPECT_THAT(french.at("calibration"), AllOf(HasSubstr("<td lang=\"en\">an English message</td>"),
                                              HasSubstr("<li lang=\"en\">an English warning</li>")));
  EXPECT_THAT(french.at("proof that failed"),
              HasSubstr("<li>il a fini par un défaut : <span lang=\"en\">an English message</span></li>"));
  for (const auto& [kind, page] : pages(english())) EXPECT_THAT(page, Not(HasSubstr("<td lang"))) << kind;
}

TEST(ReportLanguages, AFrenchAndAGermanFrontPageSayTheVerdictAndMarkWhatFails) {
  const std::string french = pages(*words_in("fr")).at("calibration");
  EXPECT_THAT(french,
              AllOf(HasSubstr("<strong>Verdict : refusé</strong>"), HasSubstr("<td>ÉCHEC</td>"),
                    HasSubstr("<td>moyenne de vérification, plan 3</td>"), HasSubstr("<td>0,250 mm</td>")));
  const std::string german = pages(*words_in("de")).at("calibration");
  EXPECT_THAT(german, AllOf(HasSubstr("<strong>Urteil: abgelehnt</strong>"),
                            HasSubstr("<td>NICHT BESTANDEN</td>"), HasSubstr("Bild 4. Konditionszahl")));
  EXPECT_THAT(pages(*words_in("de")).at("tool"), HasSubstr("Werkzeugbericht 20260203-9-"));
}

/// A run has stored its reasons in English; each comes from a criterion, which is told anew.
TEST(ReportLanguages, TheReasonsOfACalibrationAreMadeFromItsFigures) {
  RunRecord made = told_calibration();
  json more = json::parse(made.result_json.value());
  more["verdict"]["decision_rule"]["criteria"] = {criterion("held_out_mean", 0.25, false)};
  made.result_json = more.dump();
  const auto page = [&](const Words& words) {
    return report_html(read_report(report_document(made)), kIssuedAt, words);
  };
  EXPECT_THAT(page(*words_in("de")),
              HasSubstr("<li>Mittel der Prüfung, Fläche 3: 0,250 mm, die Grenze ist 0,125 mm</li>"));
  EXPECT_THAT(page(english()), HasSubstr("<li>an English reason</li>"));
}

}  // namespace
}  // namespace cell
