#include "service/report/report_html.hpp"

#include <spdlog/fmt/fmt.h>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

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
  std::vector<Row> references;
  for (const RunReport::Reference& touch : report.reference_touches)
    references.push_back({std::to_string(touch.touches_done),
                          touch.drift_mm ? figure_text(touch.drift_mm, "{:.4f}") : "the first one",
                          text_or_unknown(touch.captured_at)});
  return section("Touches and faults",
                 html::table("Rejected touches", {"touch", "residual mm", "reason"}, rejected) +
                     made_again_table(report) +
                     html::table("Reference touches", {"touches done", "drift mm", "made"}, references) +
                     incident_tables(report));
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

std::string report_html(const RunReport& report, const std::string& issued_at) {
  const ConditionsDocument conditions =
      report.result ? report.result->value.conditions.value : ConditionsDocument();
  std::string body = front_page(report, issued_at) + run_section("How it was calibrated", report, conditions);
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
  body += touches_section(report) + certificates_section(conditions) + words_section();
  return printed_page("Calibration report " + report_number(report), body);
}

}  // namespace cell
