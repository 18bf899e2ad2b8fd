// The uncertainty: its budget as the GUM has it, where it holds, and what the touches say of the noise.
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/documents/plane_places.hpp"
#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

/// A field name as words: "held_out_mean" becomes "held out mean".
std::string words_of(const std::string& name) {
  std::string words = text_or_unknown(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

/// What is known of the quantity behind a source beside what it does to the tip.
struct SourceQuantity {
  bool by_statistics = false;  // type A of the GUM, 4.2; else what a file declares: type B
  std::string value = "several";
  std::optional<double> std_uncertainty;  // in `unit`
  std::string unit;
  std::optional<double> degrees_of_freedom;  // of type A
};

SourceQuantity quantity_of(const std::string& source, const ResultDocument& result) {
  const ConditionsDocument& conditions = result.conditions.value;
  if (source == "touch_noise")
    return {.by_statistics = true,
            .value = "0 µm",
            .std_uncertainty = result.fit.noise_used_um,
            .unit = "µm",
            .degrees_of_freedom = result.fit.degrees_of_freedom};
  if (source == "drift")
    return {.by_statistics = true,
            .value = "0 µm",
            .std_uncertainty = {},
            .unit = "µm",
            .degrees_of_freedom = {}};
  if (source == "block_temperature")
    return {.by_statistics = false,
            .value = figure_text(conditions.block_temperature_c, "{:.1f} °C"),
            .std_uncertainty = conditions.std_temperature_k,
            .unit = "K",
            .degrees_of_freedom = {}};
  return {};
}

std::string freedom_of(const SourceQuantity& quantity) {
  if (!quantity.by_statistics) return "∞";
  return quantity.degrees_of_freedom ? figure_text(quantity.degrees_of_freedom, "{:.0f}") : "not stated";
}

std::string sensitivity_of(const SourceQuantity& quantity, const std::optional<double>& contribution_mm) {
  if (!quantity.std_uncertainty || !contribution_mm || *quantity.std_uncertainty <= 0.0) return "not stated";
  return fmt::format("{:.2g} mm/{}", *contribution_mm / *quantity.std_uncertainty, quantity.unit);
}

std::string share_of(const std::optional<double>& part_mm, const std::optional<double>& whole_mm) {
  if (!part_mm || !whole_mm || *whole_mm <= 0.0) return "unknown";
  const double ratio = *part_mm / *whole_mm;
  return fmt::format("{:.1f}", 1e2 * ratio * ratio);
}

/// A row a source; what several quantities make together has no value and no sensitivity of its own.
std::string budget_table(const ResultDocument& result) {
  const TipDocument& tip = result.tip_uncertainty;
  std::vector<TipDocument::Source> sources = tip.sources;
  std::ranges::stable_sort(sources, [](const TipDocument::Source& a, const TipDocument::Source& b) {
    return a.workspace_box_rms_mm.value_or(0.0) > b.workspace_box_rms_mm.value_or(0.0);
  });
  std::vector<Row> rows;
  for (const TipDocument::Source& source : sources) {
    const SourceQuantity quantity = quantity_of(source.name, result);
    rows.push_back({words_of(source.name), quantity.by_statistics ? "A" : "B", quantity.value,
                    quantity.std_uncertainty
                        ? figure_text(quantity.std_uncertainty, "{:.3g} ") + quantity.unit
                        : std::string(quantity.by_statistics ? "by the reference touches" : "as declared"),
                    "normal", freedom_of(quantity), sensitivity_of(quantity, source.workspace_box_rms_mm),
                    figure_text(source.workspace_box_rms_mm, "{:.4f}"),
                    share_of(source.workspace_box_rms_mm, tip.workspace_box_rms_mm)});
  }
  rows.push_back({"together (root of the sum of squares)", "", "", "", "", "", "",
                  figure_text(tip.workspace_box_rms_mm, "{:.4f}"),
                  share_of(tip.workspace_box_rms_mm, tip.workspace_box_rms_mm)});
  return html::table("Budget of the tip's predicted uncertainty, rms in the workspace box (GUM, 8)",
                     {"quantity", "type", "value", "standard uncertainty", "distribution",
                      "degrees of freedom", "sensitivity", "contribution mm", "share %"},
                     rows) +
         html::paragraph(
             "Type A: from the touches of this run. Type B: what the cell's files declare, their digest is "
             "above; "
             "a source of several quantities (the parameters of the arm, the faces of the block, the steps "
             "between its places, the tips of the stylus) has no single "
             "value and no single sensitivity. A sensitivity is the contribution over the standard "
             "uncertainty, "
             "rms over the postures.");
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

}  // namespace

std::string budget_section(const ResultDocument& result) {
  const TipDocument& tip = result.tip_uncertainty;
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
  const PlanePlaces places = plane_places_of(result);
  for (const ResultDocument::PlaneFit& plane : fit.planes)
    lack.push_back({fmt::format("lack of fit of plane {}, p", plane_text(plane.plane, places)),
                    figure_text(plane.p, "{:.3g}")});
  return section("Uncertainty", budget_table(result) +
                                    html::table("Predicted uncertainty of the tip elsewhere",
                                                {"where", "rms mm"}, elsewhere) +
                                    monte_carlo_table(result) + pairs_table("Lack of fit", lack) +
                                    html::table("Strongest correlations of identified errors",
                                                {"error of", "and of", "coefficient"}, correlations));
}

}  // namespace cell
