#include "service/report/report_html.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/documents/limit_table.hpp"
#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

constexpr std::string_view kStyle = R"(
@page { size: A4; margin: 16mm 14mm; @bottom-right { content: counter(page) " / " counter(pages); font-size: 8pt; } }
body { font: 10pt/1.4 sans-serif; color: #000; background: #fff; max-width: 190mm; margin: 0 auto; padding: 0 4mm; }
h1 { font-size: 16pt; } h2 { font-size: 12pt; border-bottom: 1px solid #000; break-after: avoid; margin-top: 8mm; }
table { border-collapse: collapse; width: 100%; margin: 4mm 0; break-inside: auto; font-size: 8.5pt; }
caption { text-align: left; font-weight: bold; padding: 1mm 0; break-after: avoid; }
th, td { border-bottom: 1px solid #bbb; padding: 0.6mm 1.6mm; text-align: left; }
td:last-child { overflow-wrap: anywhere; }
thead { display: table-header-group; } tr { break-inside: avoid; }
.short { break-inside: avoid; }
svg { width: 49%; height: auto; font: 9px sans-serif; break-inside: avoid; }
.verdict { border: 2px solid #000; padding: 3mm 4mm; margin: 4mm 0; }
.verdict strong { font-size: 14pt; }
)";

std::string section(std::string_view title, const std::string& inner) {
  return html::element("section", html::element("h2", html::escaped(title)) + "\n" + inner) + "\n";
}

std::string pairs_table(std::string_view caption, const std::vector<Row>& rows) {
  return html::table(caption, {"what", "value"}, rows);
}

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

std::string bullets(const std::vector<std::string>& texts) {
  std::string items;
  for (const std::string& text : texts) items += html::element("li", html::escaped(text_or_unknown(text)));
  return items.empty() ? items : html::element("ul", items) + "\n";
}

/// A field name as words: "held_out_mean" becomes "held out mean".
std::string words_of(const std::string& name) {
  std::string words = text_or_unknown(name);
  std::ranges::replace(words, '_', ' ');
  return words;
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
             R"(class="verdict")") +
         decision_rule(of_result.decision_rule);
}

/// "number: demo; issued: 2026-01-07"
std::string certificate_text(const std::optional<std::map<std::string, std::string>>& certificate) {
  std::string words;
  if (!certificate) return "unknown";
  for (const auto& [key, value] : *certificate)
    words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", key, text_or_unknown(value));
  return words.empty() ? "unknown" : words;
}

std::string certified_text(const ConditionsDocument::Certified& certified) {
  return text_or_unknown(certified.name) + "; " + text_or_unknown(certified.serial) + "; " +
         certificate_text(certified.certificate);
}

/// The place of the block: that of the cell's file, or the located one.
std::string place_text(const ConditionsDocument& conditions) {
  if (!conditions.place) return "unknown";
  const std::optional<PlaceDocument>& place = *conditions.place;
  if (!place) return "as the cell's file has it";
  std::string words = "located " + text_or_unknown(place->located_at) + ", shifted by";
  for (const double shift : place->shift_mm) words += figure_text(shift, " {:+.2f}");
  return words + " mm from where the cell's file has it";
}

/// The block's temperature with who told it, and when it was measured.
std::string temperature_text(const std::optional<double>& celsius, const ConditionsDocument& conditions) {
  std::string words =
      figure_text(celsius, "{:.1f} °C") + figure_if_known(conditions.std_temperature_k, " ± {:.1f} K (std)");
  if (conditions.block_temperature_source == "run") words += ", given with the run";
  if (conditions.block_temperature_source == "file") words += ", from the block's file";
  if (conditions.block_temperature_at)
    words += ", measured " + text_or_unknown(conditions.block_temperature_at);
  return words;
}

std::string run_section(const RunReport& report) {
  const RunReport::OfRun& run = report.run;
  const ResultDocument result = report.result ? report.result->value : ResultDocument();
  const ConditionsDocument& conditions = result.conditions.value;
  const ConditionsDocument::Versions& versions = conditions.versions;
  return section(
      "Run and conditions",
      pairs_table(
          "What was calibrated, with what",
          {{"run", text_or_unknown(run.id)},
           {"recipe", text_or_unknown(run.recipe)},
           {"arm, serial number",
            text_or_unknown(result.arm) + "; " + text_or_unknown(conditions.arm_serial)},
           {"controller's serial number", text_or_unknown(conditions.controller_serial)},
           {"block, serial number, certificate", certified_text(conditions.block)},
           {"probe, serial number, certificate", certified_text(conditions.probe)},
           {"block's temperature", temperature_text(run.block_temperature_c, conditions)},
           {"arm had moved", figure_text(conditions.arm_moving_min, "{:.0f} min before the run")},
           {"place of the block", place_text(conditions)},
           {"touches made", text_or_unknown(conditions.touch_mode)},
           {"operator", text_or_unknown(run.operator_name)},
           {"started, ended", text_or_unknown(run.started_at) + ", " + text_or_unknown(run.ended_at)},
           {"touches", std::to_string(run.touches_done) + figure_if_known(run.touches_total, " of {:.0f}")},
           {"outcome", std::string(word_of(run.outcome))},
           {"versions",
            fmt::format("touchcal {}, protocol {}, controller's application {}",
                        text_or_unknown(report.touchcal_version), figure_text(versions.protocol, "{:.0f}"),
                        text_or_unknown(versions.controller_application))},
           {"plan", text_or_unknown(run.plan_id)},
           {"digest of the configuration", text_or_unknown(run.config_digest)},
           {"digest of the raw data", text_or_unknown(report.raw_data.sha256) + " (SHA-256 over " +
                                          text_or_unknown(report.raw_data.of) + ")"}}));
}

std::string expanded_words(const TipDocument::Expanded& expanded) {
  return figure_text(expanded.box_rms_mm, "{:.3f} mm rms") + ", " +
         figure_text(expanded.box_p95_mm, "{:.3f} mm at 95 % of the postures") + ", " +
         figure_text(expanded.box_max_mm, "{:.3f} mm at the worst");
}

std::string summary_section(const ResultDocument& result) {
  const TipDocument& tip = result.tip_uncertainty;
  const ResultDocument::Scale& scale = result.scale;
  return section(
      "Result in short",
      pairs_table(
          "Result",
          {{"identified errors", figure_text(result.identifiable_count, "{:.0f}") + " of " +
                                     std::to_string(result.parameters.size())},
           {"condition number", figure_text(result.condition_number, "{:.0f}") + " (columns of unit norm: " +
                                    figure_text(result.scaled_condition_number, "{:.0f}") + ")"},
           {"smallest singular value kept over the next",
            figure_text(result.rank.singular_value_gap, "{:.3g}")},
           {fmt::format("predicted uncertainty of the tip in the workspace box, k = {:g}", tip.expanded.k),
            expanded_words(tip.expanded)},
           {"the same in the arm's own frame, without the block's place",
            expanded_words(tip.arm_frame.expanded)},
           {"standard uncertainty in the workspace box, rms",
            figure_text(tip.workspace_box_rms_mm, "{:.3f} mm")},
           {"the same at the block", figure_text(tip.at_block_rms_mm, "{:.3f} mm")},
           {"common scale of all lengths",
            figure_text(scale.stretch_ppm, "{:+.0f} ppm found") +
                figure_if_known(scale.std_uncertainty_ppm, ", known within {:.0f} ppm (std)")}}) +
          bullets(result.warnings));
}

/// Nothing where none were asked for.
std::string monte_carlo_table(const ResultDocument& result) {
  const std::optional<ResultDocument::MonteCarlo>& simulated = result.monte_carlo;
  if (!simulated) return {};
  const TipDocument& linear = result.tip_uncertainty;
  return html::table(
      fmt::format("Simulated calibrations (Monte Carlo by the GUM, Supplement 1): {} drawn, {} converged",
                  simulated->count, simulated->converged),
      {"uncertainty of the tip, mm", "linear", "Monte Carlo"},
      {{"standard, rms in the workspace box", figure_text(linear.workspace_box_rms_mm, "{:.3f}"),
        figure_text(simulated->box_rms_mm, "{:.3f}")},
       {"standard, rms over the joint ranges", figure_text(linear.joint_ranges_rms_mm, "{:.3f}"),
        figure_text(simulated->joint_ranges_rms_mm, "{:.3f}")},
       {"95 % of the errors in the workspace box within", "", figure_text(simulated->box_p95_mm, "{:.3f}")},
       {"linear over Monte Carlo, same postures of the box",
        figure_text(simulated->linear_over_monte_carlo, "{:.3f}"), ""}});
}

std::string budget_section(const ResultDocument& result) {
  const TipDocument& tip = result.tip_uncertainty;
  std::vector<Row> sources;
  for (const TipDocument::Source& source : tip.sources)
    sources.push_back({words_of(source.name), figure_text(source.workspace_box_rms_mm, "{:.4f}")});
  sources.push_back(
      {"together (root of the sum of squares)", figure_text(tip.workspace_box_rms_mm, "{:.4f}")});
  std::vector<Row> elsewhere{
      {"over the joint ranges", figure_text(tip.joint_ranges_rms_mm, "{:.3f}")},
      {"in the arm's own frame, at the block", figure_text(tip.arm_frame.at_block_rms_mm, "{:.3f}")},
      {"in the arm's own frame, in the workspace box",
       figure_text(tip.arm_frame.workspace_box_rms_mm, "{:.3f}")},
      {"in the arm's own frame, over the joint ranges",
       figure_text(tip.arm_frame.joint_ranges_rms_mm, "{:.3f}")}};
  if (tip.warmer) {
    const std::string warmer = fmt::format("arm {:g} K warmer than at the touches, ", tip.warmer->rise_k);
    elsewhere.push_back(
        {warmer + "in the workspace box", figure_text(tip.warmer->workspace_box_rms_mm, "{:.3f}")});
    elsewhere.push_back(
        {warmer + "over the joint ranges", figure_text(tip.warmer->joint_ranges_rms_mm, "{:.3f}")});
  }
  for (const TipDocument::Tool& tool : tip.tools) {
    const std::string name = text_or_unknown(tool.name);
    elsewhere.push_back({name + ", in the workspace box", figure_text(tool.workspace_box_rms_mm, "{:.3f}")});
    elsewhere.push_back({name + ", over the joint ranges", figure_text(tool.joint_ranges_rms_mm, "{:.3f}")});
  }
  std::vector<Row> correlations;
  for (const CorrelationOfErrors& pair : result.correlations)
    correlations.push_back({text_or_unknown(pair.first), text_or_unknown(pair.second),
                            figure_text(pair.coefficient, "{:+.3f}")});
  const ResultDocument::Fit& fit = result.fit;
  std::vector<Row> lack{
      {"declared noise of a touch", figure_text(fit.noise_declared_um, "{:.1f} µm")},
      {"noise by the residuals", figure_text(fit.noise_estimated_um, "{:.1f} µm")},
      {"noise by repeated touches of one place", figure_text(fit.noise_repeats_um, "{:.1f} µm")},
      {"tested against (repeats and gears, or declared)", figure_text(fit.lack_of_fit_noise_um, "{:.1f} µm")},
      {"of that, by repeats", figure_text(fit.lack_of_fit_repeats_um, "{:.1f} µm")},
      {"of that, by the maker's figures of the gears", figure_text(fit.lack_of_fit_gears_um, "{:.1f} µm")},
      {"lack of fit, p", figure_text(fit.lack_of_fit_p, "{:.3g}")},
      {"droop that is not in the model, p", figure_text(fit.droop_p, "{:.3g}")},
      {"that test finds a droop of one standard deviation in", figure_text(fit.droop_power, "{:.2f} of 1")},
      {"degrees of freedom", figure_text(fit.degrees_of_freedom, "{:.1f}")}};
  for (const ResultDocument::PlaneFit& plane : fit.planes)
    lack.push_back({fmt::format("lack of fit of plane {}, p", plane.plane), figure_text(plane.p, "{:.3g}")});
  return section("Uncertainty", html::table("Budget of the tip's predicted uncertainty in the workspace box",
                                            {"source", "rms mm"}, sources) +
                                    html::table("Predicted uncertainty of the tip elsewhere",
                                                {"where", "rms mm"}, elsewhere) +
                                    monte_carlo_table(result) + pairs_table("Lack of fit", lack) +
                                    html::table("Strongest correlations of identified errors",
                                                {"error of", "and of", "coefficient"}, correlations));
}

std::string touches_section(const RunReport& report) {
  std::vector<Row> rejected;
  if (report.result) {
    for (const ResultDocument::RejectedTouch& touch : report.result->value.rejected_touches)
      rejected.push_back({std::to_string(touch.touch), figure_text(touch.residual_mm, "{:+.3f}"),
                          touch.reason == calib::RejectionReason::kWrongFace ? "on another plane"
                                                                             : "does not fit the others"});
  }
  std::vector<Row> again;
  for (const RunReport::Superseded& touch : report.touched_again)
    again.push_back({std::to_string(touch.number), std::to_string(touch.plane), text_or_unknown(touch.reason),
                     text_or_unknown(touch.captured_at)});
  std::vector<Row> references;
  for (const RunReport::Reference& touch : report.reference_touches)
    references.push_back({std::to_string(touch.touches_done),
                          touch.drift_mm ? figure_text(touch.drift_mm, "{:.4f}") : "the first one",
                          text_or_unknown(touch.captured_at)});
  std::vector<Row> refused;
  for (const RunReport::Refused& contact : report.refused_contacts)
    refused.push_back({text_or_unknown(contact.at), fmt::format("{}", fmt::join(contact.joints_deg, ", ")),
                       text_or_unknown(contact.reason)});
  std::vector<Row> faults;
  for (const RunReport::RaisedFault& fault : report.faults)
    faults.push_back(
        {text_or_unknown(fault.at), text_or_unknown(fault.code), text_or_unknown(fault.message)});
  return section(
      "Touches and faults",
      html::table("Rejected touches", {"touch", "residual mm", "reason"}, rejected) +
          html::table("Touches that were made again", {"touch", "plane", "reason", "first made"}, again) +
          html::table("Reference touches", {"touches done", "drift mm", "made"}, references) +
          html::table("Refused contacts", {"when", "joints °", "why"}, refused) +
          html::table("Faults during the run", {"when", "code", "what"}, faults));
}

std::string words_section() {
  return section(
      "Words",
      html::paragraph("Calibration is finding the errors; adjustment is correcting the arm by them. This "
                      "report tells of a "
                      "calibration: the arm is adjusted only where its exported model is put to use.") +
          html::paragraph(
              "Reference: the distance of a face from the block's origin as its certificate or drawing gives "
              "it. "
              "Predicted uncertainty: what the touches, the block and the makers' tolerances let expect of "
              "the "
              "tip, one standard deviation unless another coverage is said; it is computed, not measured. "
              "The arm's own frame: the block's place counts as exact, as for whoever works in the "
              "controller's world. "
              "Held-out touches took no part in the calibration. Distances run along the faces' outward "
              "normals."));
}

}  // namespace

std::string figure_text(std::optional<double> value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "unknown";
}

std::string figure_if_known(std::optional<double> value, const char* format) {
  return value ? figure_text(value, format) : std::string();
}

std::string text_or_unknown(const std::string& text) { return text.empty() ? "unknown" : text; }

std::string text_or_unknown(const std::optional<std::string>& text) {
  return text_or_unknown(text.value_or(std::string()));
}

std::string report_html(const RunReport& report) {
  const std::string title = "Calibration report, run " + text_or_unknown(report.run.id);
  std::string body =
      html::element("h1", html::escaped(title)) + "\n" + verdict_box(report) + run_section(report);
  if (report.result) {
    const ResultDocument& result = report.result->value;
    body += summary_section(result);
    body += section("Errors", errors_table(result) + intervals_table(result) + model_table(result) +
                                  block_and_probe_table(result));
    body += section("Repetitions", repetition_tables(result));
    body += section("Convergence", condition_figure(result));
    body += section("Distances", distance_tables(result) + distance_figures(report));
    body += budget_section(result);
  } else {
    body += section("Result", html::paragraph("This run has no result: too few touches were made."));
  }
  body += touches_section(report) + words_section();
  return "<!DOCTYPE html>\n" +
         html::element("html",
                       html::element("head", R"(<meta charset="utf-8">)" +
                                                 html::element("title", html::escaped(title)) +
                                                 html::element("style", kStyle)) +
                           "\n" + html::element("body", "\n" + body),
                       R"(lang="en")") +
         "\n";
}

}  // namespace cell
