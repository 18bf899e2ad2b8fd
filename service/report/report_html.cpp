#include "service/report/report_html.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

constexpr std::string_view kStyle = R"(
@page { size: A4; margin: 18mm 14mm 14mm; }
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
.verdict strong { font-size: 20pt; }
.front { break-after: page; }
.front h1, .front .verdict, .front .verdict p { margin: 1.5mm 0; } .front .verdict { padding: 1mm 4mm; }
.front table { font-size: 7.5pt; line-height: 1.15; margin: 2mm 0; } .front th, .front td { padding: 0.1mm 1.6mm; }
.front > p { font-size: 8pt; margin: 1mm 0; }
.sign { display: flex; gap: 8mm; margin: 3mm 0; break-inside: avoid; }
.sign div { flex: 1; border: 1px solid #000; padding: 2mm 3mm; }
.sign p { border-bottom: 1px solid #bbb; margin: 0; padding-top: 5mm; }
)";

/// The head of each printed page. The number holds digits, letters and hyphens only.
std::string page_head(const RunReport& report) {
  return fmt::format(
      R"(@page {{ @top-left {{ content: "Calibration report {}"; font: 8pt sans-serif; }}
@top-right {{ content: counter(page) " of " counter(pages); font: 8pt sans-serif; }} }}
)",
      report_number(report));
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
          "How it was calibrated",
          {{"run", text_or_unknown(run.id)},
           {"recipe", text_or_unknown(run.recipe)},
           {"block's temperature", temperature_text(run.block_temperature_c, conditions)},
           {"arm had moved", figure_text(conditions.arm_moving_min, "{:.0f} min before the run")},
           {"place of the block", place_text(conditions)},
           {"touches made", text_or_unknown(conditions.touch_mode)},
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

std::string section(std::string_view title, const std::string& inner) {
  return html::element("section", html::element("h2", html::escaped(title)) + "\n" + inner) + "\n";
}

std::string pairs_table(std::string_view caption, const std::vector<html::Row>& rows) {
  return html::table(caption, {"what", "value"}, rows);
}

std::string bullets(const std::vector<std::string>& texts) {
  std::string items;
  for (const std::string& text : texts) items += html::element("li", html::escaped(text_or_unknown(text)));
  return items.empty() ? items : html::element("ul", items) + "\n";
}

std::string report_html(const RunReport& report, const std::string& issued_at) {
  const std::string title = "Calibration report " + report_number(report);
  std::string body = front_page(report, issued_at) + run_section(report);
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
  body += touches_section(report) + certificates_section(report) + words_section();
  return "<!DOCTYPE html>\n" +
         html::element(
             "html",
             html::element("head", R"(<meta charset="utf-8">)" +
                                       html::element("title", html::escaped(title)) +
                                       html::element("style", std::string(kStyle) + page_head(report))) +
                 "\n" + html::element("body", "\n" + body),
             R"(lang="en")") +
         "\n";
}

}  // namespace cell
