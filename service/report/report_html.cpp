#include "service/report/report_html.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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

std::string verdict_words(const std::string& verdict) {
  if (verdict == "accepted") return "The calibrated model meets every limit of the cell.";
  if (verdict == "rejected")
    return "The calibrated model does not meet the limits of the cell; do not use it as it is.";
  if (verdict == "incomplete") return "Not every touch was made; no verdict rests on this run.";
  return "There is no verdict.";
}

std::string bullets(const Json& texts) {
  std::string items;
  for (const Json& text : texts) items += html::element("li", html::escaped(text_or_unknown(text)));
  return items.empty() ? items : html::element("ul", items) + "\n";
}

/// A field name as words: "held_out_mean" becomes "held out mean".
std::string words_of(const Json& name) {
  std::string words = text_or_unknown(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string yes_no(const Json& value) {
  if (!value.is_boolean()) return "unknown";
  return value.get<bool>() ? "yes" : "no";
}

std::string decision_rule(const Json& rule) {
  if (!rule.is_object())
    return html::paragraph("Decision rule: a figure within its limit is accepted (simple acceptance).");
  std::vector<Row> rows;
  for (const Json& criterion : part(rule, "criteria")) {
    rows.push_back(
        {words_of(part(criterion, "name")) + figure_if_known(part(criterion, "plane"), ", plane {:.0f}"),
         text_or_unknown(part(criterion, "unit")), figure_text(part(criterion, "value"), "{:.4g}"),
         figure_text(part(criterion, "limit"), "{:.4g}"),
         figure_if_known(part(criterion, "expanded_uncertainty"), "{:.2g}"),
         yes_no(part(criterion, "within_limit")), yes_no(part(criterion, "proved"))});
  }
  return html::paragraph(fmt::format("Decision rule ({}, {}): {}.", text_or_unknown(part(rule, "standard")),
                                     text_or_unknown(part(rule, "rule")),
                                     text_or_unknown(part(rule, "text")))) +
         html::table("Figures and their limits",
                     {"figure", "unit", "value", "limit", "expanded uncertainty", "within", "proved"}, rows);
}

std::string verdict_box(const Json& report) {
  const std::string verdict = text_or_unknown(part(part(report, "run"), "verdict"));
  const Json& of_result = part(part(report, "result"), "verdict");
  return html::element("div",
                       html::element("strong", html::escaped("Verdict: " + verdict)) +
                           html::paragraph(verdict_words(verdict)) + bullets(part(of_result, "reasons")),
                       R"(class="verdict")") +
         decision_rule(part(of_result, "decision_rule"));
}

/// "number: demo; issued: 2026-01-07"
std::string certificate_text(const Json& certificate) {
  std::string words;
  if (!certificate.is_object()) return "unknown";
  for (const auto& [key, value] : certificate.items())
    words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", key, text_or_unknown(value));
  return words.empty() ? "unknown" : words;
}

/// The place of the block: that of the cell's file, or the located one.
std::string place_text(const Json& conditions) {
  if (!conditions.is_object() || !conditions.contains("place")) return "unknown";
  const Json& place = part(conditions, "place");
  if (place.is_null()) return "as the cell's file has it";
  std::string words = "located " + text_or_unknown(part(place, "located_at")) + ", shifted by";
  for (const Json& shift : part(place, "shift_mm")) words += figure_text(shift, " {:+.2f}");
  return words + " mm from where the cell's file has it";
}

std::string run_section(const Json& report) {
  const Json& run = part(report, "run");
  const Json& result = part(report, "result");
  const Json& conditions = part(result, "conditions");
  const Json& block = part(conditions, "block");
  const Json& probe = part(conditions, "probe");
  const Json& versions = part(conditions, "versions");
  const auto of = [](const Json& object, const char* key) { return text_or_unknown(part(object, key)); };
  return section(
      "Run and conditions",
      pairs_table(
          "What was calibrated, with what",
          {{"run", of(run, "id")},
           {"recipe", of(run, "recipe")},
           {"arm", of(result, "arm")},
           {"block, certificate", of(block, "name") + "; " + certificate_text(part(block, "certificate"))},
           {"probe, certificate", of(probe, "name") + "; " + certificate_text(part(probe, "certificate"))},
           {"block's temperature",
            figure_text(part(run, "block_temperature_c"), "{:.1f} °C") +
                figure_if_known(part(conditions, "std_temperature_k"), " ± {:.1f} K (std)")},
           {"place of the block", place_text(conditions)},
           {"touches made", of(conditions, "touching")},
           {"operator", of(run, "operator")},
           {"started, ended", of(run, "started_at") + ", " + of(run, "ended_at")},
           {"touches", figure_text(part(run, "touches_done"), "{:.0f}") +
                           figure_if_known(part(run, "touches_total"), " of {:.0f}")},
           {"outcome", of(run, "outcome")},
           {"versions",
            fmt::format("touchcal {}, protocol {}, controller's application {}",
                        of(report, "touchcal_version"), figure_text(part(versions, "protocol"), "{:.0f}"),
                        of(versions, "controller_application"))},
           {"plan", of(run, "plan_id")},
           {"digest of the configuration", of(run, "config_digest")},
           {"digest of the raw data", of(part(report, "raw_data"), "sha256") + " (SHA-256 over " +
                                          of(part(report, "raw_data"), "of") + ")"}}));
}

std::string summary_section(const Json& result) {
  const Json& tip = part(result, "tip_uncertainty");
  const Json& scale = part(result, "scale");
  return section(
      "Result in short",
      pairs_table(
          "Result",
          {{"identified errors", figure_text(part(result, "identifiable_count"), "{:.0f}") + " of " +
                                     std::to_string(part(result, "parameters").size())},
           {"condition number", figure_text(part(result, "condition_number"), "{:.0f}") +
                                    " (columns of unit norm: " +
                                    figure_text(part(result, "scaled_condition_number"), "{:.0f}") + ")"},
           {"predicted uncertainty of the tip in the workspace box, rms",
            figure_text(part(tip, "workspace_box_rms_mm"), "{:.3f} mm")},
           {"the same at the block", figure_text(part(tip, "at_block_rms_mm"), "{:.3f} mm")},
           {"common scale of all lengths",
            figure_text(part(scale, "stretch_ppm"), "{:+.0f} ppm found") +
                figure_if_known(part(scale, "std_uncertainty_ppm"), ", known within {:.0f} ppm (std)")}}) +
          bullets(part(result, "warnings")));
}

std::string budget_section(const Json& result) {
  std::vector<Row> sources;
  for (const Json& source : part(part(result, "tip_uncertainty"), "sources"))
    sources.push_back(
        {words_of(part(source, "name")), figure_text(part(source, "workspace_box_rms_mm"), "{:.4f}")});
  sources.push_back({"together (root of the sum of squares)",
                     figure_text(part(part(result, "tip_uncertainty"), "workspace_box_rms_mm"), "{:.4f}")});
  std::vector<Row> elsewhere{
      {"over the joint ranges",
       figure_text(part(part(result, "tip_uncertainty"), "joint_ranges_rms_mm"), "{:.3f}")}};
  for (const Json& tool : part(part(result, "tip_uncertainty"), "tools")) {
    const std::string name = text_or_unknown(part(tool, "name"));
    elsewhere.push_back(
        {name + ", in the workspace box", figure_text(part(tool, "workspace_box_rms_mm"), "{:.3f}")});
    elsewhere.push_back(
        {name + ", over the joint ranges", figure_text(part(tool, "joint_ranges_rms_mm"), "{:.3f}")});
  }
  std::vector<Row> correlations;
  for (const Json& pair : part(result, "correlations"))
    correlations.push_back({text_or_unknown(part(pair, "first")), text_or_unknown(part(pair, "second")),
                            figure_text(part(pair, "coefficient"), "{:+.3f}")});
  const Json& fit = part(result, "fit");
  std::vector<Row> lack{
      {"declared noise of a touch", figure_text(part(fit, "noise_declared_um"), "{:.1f} µm")},
      {"noise by the residuals", figure_text(part(fit, "noise_estimated_um"), "{:.1f} µm")},
      {"lack of fit, p", figure_text(part(fit, "lack_of_fit_p"), "{:.3g}")},
      {"degrees of freedom", figure_text(part(fit, "degrees_of_freedom"), "{:.1f}")}};
  for (const Json& plane : part(fit, "planes"))
    lack.push_back({figure_text(part(plane, "plane"), "lack of fit of plane {:.0f}, p"),
                    figure_text(part(plane, "p"), "{:.3g}")});
  return section("Uncertainty", html::table("Budget of the tip's predicted uncertainty in the workspace box",
                                            {"source", "rms mm"}, sources) +
                                    html::table("Predicted uncertainty of the tip elsewhere",
                                                {"where", "rms mm"}, elsewhere) +
                                    pairs_table("Lack of fit", lack) +
                                    html::table("Strongest correlations of identified errors",
                                                {"error of", "and of", "coefficient"}, correlations));
}

std::string touches_section(const Json& report) {
  std::vector<Row> rejected;
  for (const Json& touch : part(part(report, "result"), "rejected_touches"))
    rejected.push_back(
        {figure_text(part(touch, "touch"), "{:.0f}"), figure_text(part(touch, "residual_mm"), "{:+.3f}"),
         is(part(touch, "reason"), "wrong_plane") ? "on another plane" : "does not fit the others"});
  std::vector<Row> again;
  for (const Json& touch : part(report, "touched_again"))
    again.push_back({figure_text(part(touch, "number"), "{:.0f}"),
                     figure_text(part(touch, "plane"), "{:.0f}"), text_or_unknown(part(touch, "reason")),
                     text_or_unknown(part(touch, "captured_at"))});
  std::vector<Row> references;
  for (const Json& touch : part(report, "reference_touches"))
    references.push_back({figure_text(part(touch, "touches_done"), "{:.0f}"),
                          part(touch, "drift_mm").is_number() ? figure_text(part(touch, "drift_mm"), "{:.4f}")
                                                              : "the first one",
                          text_or_unknown(part(touch, "captured_at"))});
  std::vector<Row> faults;
  for (const Json& fault : part(report, "faults"))
    faults.push_back({text_or_unknown(part(fault, "at")), text_or_unknown(part(fault, "code")),
                      text_or_unknown(part(fault, "message"))});
  return section(
      "Touches and faults",
      html::table("Rejected touches", {"touch", "residual mm", "reason"}, rejected) +
          html::table("Touches that were made again", {"touch", "plane", "reason", "first made"}, again) +
          html::table("Reference touches", {"touches done", "drift mm", "made"}, references) +
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
              "Held-out touches took no part in the calibration. Distances run along the faces' outward "
              "normals."));
}

}  // namespace

const Json& part(const Json& object, const char* key) {
  static const Json nothing;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found == object.end() ? nothing : *found;
}

bool is(const Json& value, std::string_view text) {
  return value.is_string() && value.get_ref<const std::string&>() == text;
}

std::string figure_text(const Json& value, const char* format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "unknown";
}

std::string figure_if_known(const Json& value, const char* format) {
  return value.is_number() ? figure_text(value, format) : std::string();
}

std::string text_or_unknown(const Json& value) {
  return value.is_string() && !value.get_ref<const std::string&>().empty() ? value.get<std::string>()
                                                                           : "unknown";
}

std::string report_html(const Json& report) {
  const Json& result = part(report, "result");
  const std::string title = "Calibration report, run " + text_or_unknown(part(part(report, "run"), "id"));
  std::string body =
      html::element("h1", html::escaped(title)) + "\n" + verdict_box(report) + run_section(report);
  if (result.is_object()) {
    body += summary_section(result);
    body += section("Errors", errors_table(result) + intervals_table(result) + block_and_probe_table(result));
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
