// The page that is signed.
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/documents/limit_table.hpp"
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

std::string decision_rule(const std::optional<DecisionRuleDocument>& rule) {
  if (!rule)
    return html::paragraph("Decision rule: a figure within its limit is accepted (simple acceptance).");
  std::vector<html::Row> rows;
  for (const LimitRow& row : limit_rows(*rule))
    rows.push_back({row.criterion, row.decision, row.value, row.limit, row.expanded_uncertainty});
  return html::paragraph(fmt::format("Decision rule ({}, {}): {}.", text_or_unknown(rule->standard),
                                     text_or_unknown(rule->rule), text_or_unknown(rule->text))) +
         html::table("Figures and their limits",
                     {"figure", "decision", "value", "limit", "expanded uncertainty"}, rows);
}

std::string verdict_box(const RunReport& report) {
  const VerdictDocument of_result = report.result ? report.result->value.verdict : VerdictDocument();
  return html::element(
      "div",
      html::element("strong", html::escaped(fmt::format("Verdict: {}", word_of(report.run.verdict)))) +
          html::paragraph(verdict_words(report.run.verdict)) + bullets(of_result.reasons),
      R"(class="verdict")");
}

std::string limits_table(const RunReport& report) {
  return decision_rule(report.result->value.verdict.decision_rule);
}

/// k times the standard uncertainty; nothing where that is unknown.
std::string times(double k, const std::optional<double>& standard_mm) {
  return standard_mm ? fmt::format("{:.3f}", k * *standard_mm) : "unknown";
}

std::string tip_table(const TipDocument& tip) {
  const double k = tip.expanded.k;
  const auto in_box = [](const std::string& where, const TipDocument::Expanded& expanded) {
    return Row{where, figure_text(expanded.box_rms_mm, "{:.3f}"), figure_text(expanded.box_p95_mm, "{:.3f}"),
               figure_text(expanded.box_max_mm, "{:.3f}")};
  };
  std::vector<Row> rows{
      in_box("stylus, in the workspace box, in the block's frame", tip.expanded),
      in_box("stylus, in the workspace box, in the arm's own frame", tip.arm_frame.expanded),
      {"stylus, at the block", times(k, tip.at_block_rms_mm), "", ""},
      {"stylus, over the joint ranges", times(k, tip.joint_ranges_rms_mm), "", ""}};
  for (const TipDocument::Tool& tool : tip.tools) {
    const std::string name = text_or_unknown(tool.name);
    rows.push_back({name + ", in the workspace box", times(k, tool.workspace_box_rms_mm), "", ""});
    rows.push_back({name + ", over the joint ranges", times(k, tool.joint_ranges_rms_mm), "", ""});
  }
  return html::table(fmt::format("Expanded uncertainty of the tip, k = {:g} (about 95 %), mm", k),
                     {"tool and region", "rms", "95 % of the postures within", "at the worst"}, rows);
}

std::string named_instrument(const ConditionsDocument::Certified& certified) {
  return text_or_unknown(certified.name) + "; " + text_or_unknown(certified.serial);
}

std::string identification(const RunReport& report, const std::string& issued_at) {
  const ResultDocument result = report.result ? report.result->value : ResultDocument();
  const ConditionsDocument& conditions = result.conditions.value;
  return pairs_table(
      "What was calibrated, with what, by whom",
      {{"report number", report_number(report)},
       {"date of the run", text_or_unknown(report.run.started_at)},
       {"date of issue", text_or_unknown(issued_at)},
       {"robot; serial number", text_or_unknown(result.arm) + "; " + text_or_unknown(conditions.arm_serial)},
       {"controller's serial number", text_or_unknown(conditions.controller_serial)},
       {"probe; serial number", named_instrument(conditions.probe)},
       {"block; serial number", named_instrument(conditions.block)},
       {"operator", text_or_unknown(report.run.operator_name)}});
}

std::string signature(std::string_view role) {
  return html::element("div", html::element("strong", html::escaped(role)) + html::paragraph("Name:") +
                                  html::paragraph("Date:") + html::paragraph("Signature:"));
}

}  // namespace

std::string report_number(const RunReport& report) {
  std::string day = report.run.ended_at.value_or(report.run.started_at).substr(0, kDateLength);
  std::erase_if(day, [](char each) { return each < '0' || each > '9'; });
  return fmt::format("{}-{}-{}", day.empty() ? "undated" : day, report.run.id,
                     report.raw_data.sha256.substr(0, kNumberDigits));
}

std::string front_page(const RunReport& report, const std::string& issued_at) {
  std::string inner = html::element("h1", html::escaped("Calibration report " + report_number(report))) +
                      "\n" + verdict_box(report) + identification(report, issued_at);
  if (report.result) inner += tip_table(report.result->value.tip_uncertainty);
  // Before the limits: whoever signs finds the place on this page however many of them there are.
  inner +=
      html::element("div", signature("Calibrated by") + signature("Approved by"), R"(class="sign")") + "\n";
  if (report.result) inner += limits_table(report);
  return html::element("section", inner, R"(class="front")") + "\n";
}

}  // namespace cell
