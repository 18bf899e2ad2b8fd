// The page that is signed.
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/report/internal/criterion_words.hpp"
#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

constexpr std::size_t kDateLength = 10;  // of RFC 3339
constexpr std::size_t kNumberDigits = 8;

std::string verdict_words(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAccepted:
      return "The calibrated model meets every limit of the cell.";
    case Verdict::kRejected:
      return "The calibrated model does not meet the limits of the cell; do not use it as it is.";
    case Verdict::kIncomplete:
      return "Not every touch was made; no verdict rests on this run.";
    case Verdict::kNone:
      break;
  }
  return "There is no verdict.";
}

std::string decision_rule(const Words& words, const std::optional<DecisionRuleDocument>& rule,
                          const PlanePlaces& places) {
  if (!rule)
    return html::paragraph(
        words("Decision rule: a figure within its limit is accepted (simple acceptance)."));
  std::vector<html::Row> rows;
  for (const CriterionFigures& criterion : by_decision(*rule))
    rows.push_back({criterion_words(words, criterion, places), words(decision_text(criterion, rule->rule)),
                    value_words(words, criterion), limit_words(words, criterion),
                    criterion.expanded_uncertainty
                        ? figure_words(words, criterion, criterion.expanded_uncertainty)
                        : std::string()});
  const std::string introduction =
      words("Decision rule ({}, {}): ", words.known(rule->standard), words(words.known(rule->rule)));
  html::Text rule_text = words.has(rule->text) ? html::Text(introduction + words(rule->text))
                                               : in_english(words, introduction, words.known(rule->text));
  rule_text.text += ".";
  return html::paragraph(rule_text) + html::table(words, words("Figures and their limits"),
                                                  {words("figure"), words("decision"), words("value"),
                                                   words("limit"), words("expanded uncertainty")},
                                                  rows);
}

/// k times the standard uncertainty; nothing where that is unknown.
std::string times(const Words& words, double k, const std::optional<double>& standard_mm) {
  return standard_mm ? words("{:.3f}", k * *standard_mm) : words("unknown");
}

std::string tip_table(const Words& words, const TipDocument& tip) {
  const double k = tip.expanded.k;
  const auto in_box = [&words](const char* where, const TipDocument::Expanded& expanded) {
    return Row{words(where), words.figure(expanded.box_rms_mm, "{:.3f}"),
               words.figure(expanded.box_p95_mm, "{:.3f}"), words.figure(expanded.box_max_mm, "{:.3f}")};
  };
  std::vector<Row> rows{
      in_box("stylus, in the workspace box, in the block's frame", tip.expanded),
      in_box("stylus, in the workspace box, in the arm's own frame", tip.arm_frame.expanded),
      {words("stylus, at the block"), times(words, k, tip.at_block_rms_mm), "", ""},
      {words("stylus, over the joint ranges"), times(words, k, tip.joint_ranges_rms_mm), "", ""}};
  for (const TipDocument::Tool& tool : tip.tools) {
    const std::string name = words.known(tool.name);
    rows.push_back(
        {words("{}, in the workspace box", name), times(words, k, tool.workspace_box_rms_mm), "", ""});
    rows.push_back(
        {words("{}, over the joint ranges", name), times(words, k, tool.joint_ranges_rms_mm), "", ""});
  }
  return html::table(
      words, words("Expanded uncertainty of the tip, k = {:g} (about 95 %), mm", k),
      {words("tool and region"), words("rms"), words("95 % of the postures within"), words("at the worst")},
      rows);
}

std::string named_instrument(const Words& words, const ConditionsDocument::Certified& certified) {
  return words.known(certified.name) + "; " + words.known(certified.serial);
}

std::string signature(const Words& words, std::string_view role) {
  return html::element("div", html::element("strong", html::escaped(words(role))) +
                                  html::paragraph(words("Name:")) + html::paragraph(words("Date:")) +
                                  html::paragraph(words("Signature:")));
}

}  // namespace

std::string verdict_box(const Words& words, std::string_view verdict, std::string_view meaning,
                        const std::vector<html::Text>& reasons) {
  return html::element("div",
                       html::element("strong", html::escaped(words("Verdict: {}", words(verdict)))) +
                           html::paragraph(words(meaning)) + bullets(reasons),
                       R"(class="verdict")");
}

std::vector<html::Row> identification_rows(const Words& words, const ReportHead& head,
                                           const std::string& issued_at, const std::string& arm,
                                           const ConditionsDocument& conditions) {
  return {{words("report number"), report_number(head)},
          {words("date of the run"), words.known(head.run.started_at)},
          {words("date of issue"), words.known(issued_at)},
          {words("robot; serial number"), words.known(arm) + "; " + words.known(conditions.arm_serial)},
          {words("controller's serial number"), words.known(conditions.controller_serial)},
          {words("probe; serial number"), named_instrument(words, conditions.probe)},
          {words("block; serial number"), named_instrument(words, conditions.block)},
          {words("operator"), words.known(head.run.operator_name)}};
}

std::string signatures(const Words& words, std::string_view maker) {
  return html::element("div", signature(words, maker) + signature(words, "Approved by"), R"(class="sign")") +
         "\n";
}

std::string front_sheet(std::string_view title, const std::string& inner) {
  return html::element("section", html::element("h1", html::escaped(title)) + "\n" + inner,
                       R"(class="front")") +
         "\n";
}

std::string report_number(std::string day, const std::string& run, const std::string& raw_data_sha256) {
  day.resize(std::min(day.size(), kDateLength));
  std::erase_if(day, [](char each) { return each < '0' || each > '9'; });
  return fmt::format("{}-{}-{}", day.empty() ? "undated" : day, run,
                     raw_data_sha256.substr(0, kNumberDigits));
}

std::string report_number(const ReportHead& head) {
  return report_number(head.run.ended_at.value_or(head.run.started_at), head.run.id, head.raw_data.sha256);
}

namespace {

std::string proofs_text(const Words& words, const std::vector<RunReport::ProofRun>& proofs) {
  std::string text;
  for (const RunReport::ProofRun& proof : proofs)
    text += (text.empty() ? "" : "; ") + words("run {} of {}: {}", proof.run, proof.ended_at,
                                               words(proof.verdict == Verdict::kAccepted   ? "proved"
                                                     : proof.verdict == Verdict::kRejected ? "not proved"
                                                                                           : "no verdict"));
  return text.empty() ? words("none was made") : text;
}

/// Whose repeats count among those of the run.
std::string qualification_text_of(const Words& words, const ConditionsDocument& conditions) {
  if (!conditions.qualification) return words("unknown");
  const auto& told = *conditions.qualification;
  if (!told) return words("none counted");
  return words("run {}, whose touches scatter by {:.1f} µm ({:.0f} degrees of freedom)", told->run_id,
               told->scatter_um, told->degrees_of_freedom);
}

/// As the run stored them, in English; in another language made from the figures where each comes from one.
std::vector<html::Text> reasons_of(const Words& words, const ResultDocument& result) {
  const std::vector<std::string>& stored = result.verdict.reasons;
  if (words.tag() == english().tag() || !result.verdict.decision_rule) return stored_texts(words, stored);
  const DecisionRuleDocument& rule = *result.verdict.decision_rule;
  const PlanePlaces places = places_of(words, result);
  std::vector<html::Text> reasons;
  for (const CriterionFigures& criterion : rule.criteria)
    if (fails(criterion, rule.rule)) reasons.emplace_back(reason_words(words, criterion, places));
  return reasons.size() == stored.size() ? reasons : stored_texts(words, stored);
}

}  // namespace

std::string front_page(const Words& words, const RunReport& report, const std::string& issued_at) {
  const ResultDocument result = report.result ? report.result->value : ResultDocument();
  std::vector<Row> rows = identification_rows(words, report, issued_at, result.arm, result.conditions.value);
  rows.push_back(
      {words("qualification of the probe before it"), qualification_text_of(words, result.conditions.value)});
  rows.push_back({words("proofs at another place"), proofs_text(words, report.proofs)});
  std::string inner = verdict_box(words, word_of(report.run.verdict), verdict_words(report.run.verdict),
                                  reasons_of(words, result)) +
                      pairs_table(words, words("What was calibrated, with what, by whom"), rows);
  if (report.result) inner += tip_table(words, result.tip_uncertainty);
  // Before the limits: whoever signs finds the place on this page however many of them there are.
  inner += signatures(words, "Calibrated by");
  if (report.result) inner += decision_rule(words, result.verdict.decision_rule, places_of(words, result));
  return front_sheet(words("Calibration report {}", report_number(report)), inner);
}

}  // namespace cell
