#include "service/report/report_html.hpp"

#include <spdlog/fmt/fmt.h>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

std::string expanded_words(const Words& words, const TipDocument::Expanded& expanded) {
  return words.figure(expanded.box_rms_mm, "{:.3f} mm rms") + ", " +
         words.figure(expanded.box_p95_mm, "{:.3f} mm at 95 % of the postures") + ", " +
         words.figure(expanded.box_max_mm, "{:.3f} mm at the worst");
}

std::string summary_section(const Words& words, const ResultDocument& result) {
  const TipDocument& tip = result.tip_uncertainty;
  const ResultDocument::Scale& scale = result.scale;
  return section(
      words("Result in short"),
      pairs_table(
          words, words("Result"),
          {{words("identified errors"),
            words("{} of {}", words.figure(result.identifiable_count, "{:.0f}"), result.parameters.size())},
           {words("condition number"),
            words("{} (columns of unit norm: {})", words.figure(result.condition_number, "{:.0f}"),
                  words.figure(result.scaled_condition_number, "{:.0f}"))},
           {words("smallest singular value kept over the next"),
            words.figure(result.rank.singular_value_gap, "{:.3g}")},
           {words("predicted uncertainty of the tip in the workspace box, k = {:g}", tip.expanded.k),
            expanded_words(words, tip.expanded)},
           {words("the same in the arm's own frame, without the block's place"),
            expanded_words(words, tip.arm_frame.expanded)},
           {words("standard uncertainty in the workspace box, rms"),
            words.figure(tip.workspace_box_rms_mm, "{:.3f} mm")},
           {words("the same at the block"), words.figure(tip.at_block_rms_mm, "{:.3f} mm")},
           {words("common scale of all lengths"),
            words.figure(scale.stretch_ppm, "{:+.0f} ppm found") +
                words.if_known(scale.std_uncertainty_ppm, ", known within {:.0f} ppm (std)")}}) +
          bullets(stored_texts(words, result.warnings)));
}

std::string touches_section(const Words& words, const RunReport& report) {
  std::vector<Row> rejected;
  if (report.result) {
    for (const ResultDocument::RejectedTouch& touch : report.result->value.rejected_touches)
      rejected.push_back(
          {std::to_string(touch.touch), words.figure(touch.residual_mm, "{:+.3f}"),
           words(touch.reason == calib::RejectionReason::kWrongFace ? "on another plane"
                                                                    : "does not fit the others")});
  }
  std::vector<Row> references;
  for (const RunReport::Reference& touch : report.reference_touches)
    references.push_back({std::to_string(touch.touches_done),
                          touch.drift_mm ? words.figure(touch.drift_mm, "{:.4f}") : words("the first one"),
                          words.known(touch.captured_at)});
  return section(words("Touches and faults"),
                 html::table(words, words("Rejected touches"),
                             {words("touch"), words("residual mm"), words("reason")}, rejected) +
                     made_again_table(words, report) +
                     html::table(words, words("Reference touches"),
                                 {words("touches done"), words("drift mm"), words("made")}, references) +
                     incident_tables(words, report));
}

std::string words_section(const Words& words) {
  return section(
      words("Words"),
      html::paragraph(
          words("Calibration is finding the errors; adjustment is correcting the arm by them. This "
                "report tells of a "
                "calibration: the arm is adjusted only where its exported model is put to use.")) +
          html::paragraph(words(
              "Reference: the distance of a face from the block's origin as its certificate or drawing gives "
              "it. "
              "Predicted uncertainty: what the touches, the block and the makers' tolerances let expect of "
              "the "
              "tip, one standard deviation unless another coverage is said; it is computed, not measured. "
              "The arm's own frame: the block's place counts as exact, as for whoever works in the "
              "controller's world. "
              "Held-out touches took no part in the calibration. Distances run along the faces' outward "
              "normals.")));
}

}  // namespace

std::string report_html(const RunReport& report, const std::string& issued_at, const Words& words) {
  const ConditionsDocument conditions =
      report.result ? report.result->value.conditions.value : ConditionsDocument();
  std::string body = front_page(words, report, issued_at) +
                     run_section(words, words("How it was calibrated"), report, conditions);
  if (report.result) {
    const ResultDocument& result = report.result->value;
    body += summary_section(words, result);
    body += section(words("Errors"), errors_table(words, result) + intervals_table(words, result) +
                                         model_table(words, result) + block_and_probe_table(words, result));
    body += section(words("Repetitions"), repetition_tables(words, result));
    body += section(words("Convergence"), condition_figure(words, result));
    body += section(words("Distances"), distance_tables(words, result) + distance_figures(words, report));
    body += budget_section(words, result);
  } else {
    body += section(words("Result"),
                    html::paragraph(words("This run has no result: too few touches were made.")));
  }
  body += touches_section(words, report) + certificates_section(words, conditions) + words_section(words);
  return printed_page(words, words("Calibration report {}", report_number(report)), body);
}

}  // namespace cell
