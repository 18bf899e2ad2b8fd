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

std::string decision_rule(const std::optional<DecisionRuleDocument>& rule, const PlanePlaces& places) {
  if (!rule)
    return html::paragraph("Decision rule: a figure within its limit is accepted (simple acceptance).");
  std::vector<html::Row> rows;
  for (const LimitRow& row : limit_rows(*rule, places))
    rows.push_back({row.criterion, row.decision, row.value, row.limit, row.expanded_uncertainty});
  return html::paragraph(fmt::format("Decision rule ({}, {}): {}.", text_or_unknown(rule->standard),
                                     text_or_unknown(rule->rule), text_or_unknown(rule->text))) +
         html::table("Figures and their limits",
                     {"figure", "decision", "value", "limit", "expanded uncertainty"}, rows);
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

std::string signature(std::string_view role) {
  return html::element("div", html::element("strong", html::escaped(role)) + html::paragraph("Name:") +
                                  html::paragraph("Date:") + html::paragraph("Signature:"));
}

}  // namespace

std::string verdict_box(std::string_view verdict, std::string_view words,
                        const std::vector<std::string>& reasons) {
  return html::element("div",
                       html::element("strong", html::escaped(fmt::format("Verdict: {}", verdict))) +
                           html::paragraph(words) + bullets(reasons),
                       R"(class="verdict")");
}

std::vector<html::Row> identification_rows(const ReportHead& head, const std::string& issued_at,
                                           const std::string& arm, const ConditionsDocument& conditions) {
  return {{"report number", report_number(head)},
          {"date of the run", text_or_unknown(head.run.started_at)},
          {"date of issue", text_or_unknown(issued_at)},
          {"robot; serial number", text_or_unknown(arm) + "; " + text_or_unknown(conditions.arm_serial)},
          {"controller's serial number", text_or_unknown(conditions.controller_serial)},
          {"probe; serial number", named_instrument(conditions.probe)},
          {"block; serial number", named_instrument(conditions.block)},
          {"operator", text_or_unknown(head.run.operator_name)}};
}

std::string signatures(std::string_view maker) {
  return html::element("div", signature(maker) + signature("Approved by"), R"(class="sign")") + "\n";
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

std::string proofs_text(const std::vector<RunReport::ProofRun>& proofs) {
  std::string text;
  for (const RunReport::ProofRun& proof : proofs)
    text += fmt::format("{}run {} of {}: {}", text.empty() ? "" : "; ", proof.run, proof.ended_at,
                        proof.verdict == Verdict::kAccepted   ? "proved"
                        : proof.verdict == Verdict::kRejected ? "not proved"
                                                              : "no verdict");
  return text.empty() ? "none was made" : text;
}

/// Whose repeats count among those of the run.
std::string qualification_text_of(const ConditionsDocument& conditions) {
  if (!conditions.qualification) return "unknown";
  const auto& told = *conditions.qualification;
  if (!told) return "none counted";
  return fmt::format("run {}, whose touches scatter by {:.1f} µm ({:.0f} degrees of freedom)", told->run_id,
                     told->scatter_um, told->degrees_of_freedom);
}

}  // namespace

std::string front_page(const RunReport& report, const std::string& issued_at) {
  const ResultDocument result = report.result ? report.result->value : ResultDocument();
  std::vector<Row> rows = identification_rows(report, issued_at, result.arm, result.conditions.value);
  rows.push_back({"qualification of the probe before it", qualification_text_of(result.conditions.value)});
  rows.push_back({"proofs at another place", proofs_text(report.proofs)});
  std::string inner =
      verdict_box(word_of(report.run.verdict), verdict_words(report.run.verdict), result.verdict.reasons) +
      pairs_table("What was calibrated, with what, by whom", rows);
  if (report.result) inner += tip_table(result.tip_uncertainty);
  // Before the limits: whoever signs finds the place on this page however many of them there are.
  inner += signatures("Calibrated by");
  if (report.result) inner += decision_rule(result.verdict.decision_rule, plane_places_of(result));
  return front_sheet("Calibration report " + report_number(report), inner);
}

}  // namespace cell
