// The uncertainty: its budget as the GUM has it, where it holds, and what the touches say of the noise.
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/documents/plane_places.hpp"
#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

/// A field name as words: "touch_noise" becomes "touch noise".
std::string name_words(const Words& words, std::string name) {
  std::ranges::replace(name, '_', ' ');
  return words(words.known(name));
}

/// What is known of the quantity behind a source beside what it does to the tip.
struct SourceQuantity {
  bool by_statistics = false;             // type A of the GUM, 4.2; else what a file declares: type B
  std::string value;                      // empty: several
  std::optional<double> std_uncertainty;  // in `unit`
  std::string unit;
  std::optional<double> degrees_of_freedom;  // of type A
};

SourceQuantity quantity_of(const Words& words, const std::string& source, const ResultDocument& result) {
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
            .value = words.figure(conditions.block_temperature_c, "{:.1f} °C"),
            .std_uncertainty = conditions.std_temperature_k,
            .unit = "K",
            .degrees_of_freedom = {}};
  return {};
}

std::string freedom_of(const Words& words, const SourceQuantity& quantity) {
  if (!quantity.by_statistics) return "∞";
  return quantity.degrees_of_freedom ? words.figure(quantity.degrees_of_freedom, "{:.0f}")
                                     : words("not stated");
}

std::string sensitivity_of(const Words& words, const SourceQuantity& quantity,
                           const std::optional<double>& contribution_mm) {
  if (!quantity.std_uncertainty || !contribution_mm || *quantity.std_uncertainty <= 0.0)
    return words("not stated");
  return words("{:.2g} mm/{}", *contribution_mm / *quantity.std_uncertainty, quantity.unit);
}

std::string share_of(const Words& words, const std::optional<double>& part_mm,
                     const std::optional<double>& whole_mm) {
  if (!part_mm || !whole_mm || *whole_mm <= 0.0) return words("unknown");
  const double ratio = *part_mm / *whole_mm;
  return words("{:.1f}", 1e2 * ratio * ratio);
}

/// A row a source; what several quantities make together has no value and no sensitivity of its own.
std::string budget_table(const Words& words, const ResultDocument& result) {
  const TipDocument& tip = result.tip_uncertainty;
  std::vector<TipDocument::Source> sources = tip.sources;
  std::ranges::stable_sort(sources, [](const TipDocument::Source& a, const TipDocument::Source& b) {
    return a.workspace_box_rms_mm.value_or(0.0) > b.workspace_box_rms_mm.value_or(0.0);
  });
  std::vector<Row> rows;
  for (const TipDocument::Source& source : sources) {
    const SourceQuantity quantity = quantity_of(words, source.name, result);
    rows.push_back({name_words(words, source.name), quantity.by_statistics ? "A" : "B",
                    quantity.value.empty() ? words("several") : quantity.value,
                    quantity.std_uncertainty
                        ? words.figure(quantity.std_uncertainty, "{:.3g} ") + quantity.unit
                        : words(quantity.by_statistics ? "by the reference touches" : "as declared"),
                    words("normal"), freedom_of(words, quantity),
                    sensitivity_of(words, quantity, source.workspace_box_rms_mm),
                    words.figure(source.workspace_box_rms_mm, "{:.4f}"),
                    share_of(words, source.workspace_box_rms_mm, tip.workspace_box_rms_mm)});
  }
  rows.push_back({words("together (root of the sum of squares)"), "", "", "", "", "", "",
                  words.figure(tip.workspace_box_rms_mm, "{:.4f}"),
                  share_of(words, tip.workspace_box_rms_mm, tip.workspace_box_rms_mm)});
  return html::table(words,
                     words("Budget of the tip's predicted uncertainty, rms in the workspace box (GUM, 8)"),
                     {words("quantity"), words("type"), words("value"), words("standard uncertainty"),
                      words("distribution"), words("degrees of freedom"), words("sensitivity"),
                      words("contribution mm"), words("share %")},
                     rows) +
         html::paragraph(words(
             "Type A: from the touches of this run. Type B: what the cell's files declare, their digest is "
             "above; "
             "a source of several quantities (the parameters of the arm, the faces of the block, the steps "
             "between its places, the tips of the stylus) has no single "
             "value and no single sensitivity. A sensitivity is the contribution over the standard "
             "uncertainty, "
             "rms over the postures."));
}

/// Nothing where none were asked for.
std::string monte_carlo_table(const Words& words, const ResultDocument& result) {
  const std::optional<ResultDocument::MonteCarlo>& simulated = result.monte_carlo;
  if (!simulated) return {};
  const TipDocument& linear = result.tip_uncertainty;
  return html::table(
      words,
      words("Simulated calibrations (Monte Carlo by the GUM, Supplement 1): {} drawn, {} converged",
            simulated->count, simulated->converged),
      {words("uncertainty of the tip, mm"), words("linear"), words("Monte Carlo")},
      {{words("standard, rms in the workspace box"), words.figure(linear.workspace_box_rms_mm, "{:.3f}"),
        words.figure(simulated->box_rms_mm, "{:.3f}")},
       {words("standard, rms over the joint ranges"), words.figure(linear.joint_ranges_rms_mm, "{:.3f}"),
        words.figure(simulated->joint_ranges_rms_mm, "{:.3f}")},
       {words("95 % of the errors in the workspace box within"), "",
        words.figure(simulated->box_p95_mm, "{:.3f}")},
       {words("linear over Monte Carlo, same postures of the box"),
        words.figure(simulated->linear_over_monte_carlo, "{:.3f}"), ""}});
}

}  // namespace

std::string budget_section(const Words& words, const ResultDocument& result) {
  const TipDocument& tip = result.tip_uncertainty;
  std::vector<Row> elsewhere{
      {words("over the joint ranges"), words.figure(tip.joint_ranges_rms_mm, "{:.3f}")},
      {words("in the arm's own frame, at the block"), words.figure(tip.arm_frame.at_block_rms_mm, "{:.3f}")},
      {words("in the arm's own frame, in the workspace box"),
       words.figure(tip.arm_frame.workspace_box_rms_mm, "{:.3f}")},
      {words("in the arm's own frame, over the joint ranges"),
       words.figure(tip.arm_frame.joint_ranges_rms_mm, "{:.3f}")}};
  if (tip.warmer) {
    const double rise_k = tip.warmer->rise_k;
    elsewhere.push_back({words("arm {:g} K warmer than at the touches, in the workspace box", rise_k),
                         words.figure(tip.warmer->workspace_box_rms_mm, "{:.3f}")});
    elsewhere.push_back({words("arm {:g} K warmer than at the touches, over the joint ranges", rise_k),
                         words.figure(tip.warmer->joint_ranges_rms_mm, "{:.3f}")});
  }
  for (const TipDocument::Tool& tool : tip.tools) {
    const std::string name = words.known(tool.name);
    elsewhere.push_back(
        {words("{}, in the workspace box", name), words.figure(tool.workspace_box_rms_mm, "{:.3f}")});
    elsewhere.push_back(
        {words("{}, over the joint ranges", name), words.figure(tool.joint_ranges_rms_mm, "{:.3f}")});
  }
  std::vector<Row> correlations;
  for (const CorrelationOfErrors& pair : result.correlations)
    correlations.push_back(
        {words.known(pair.first), words.known(pair.second), words.figure(pair.coefficient, "{:+.3f}")});
  const ResultDocument::Fit& fit = result.fit;
  std::vector<Row> lack{
      {words("declared noise of a touch"), words.figure(fit.noise_declared_um, "{:.1f} µm")},
      {words("noise by the residuals"), words.figure(fit.noise_estimated_um, "{:.1f} µm")},
      {words("noise by repeated touches of one place"), words.figure(fit.noise_repeats_um, "{:.1f} µm")},
      {words("tested against (repeats and gears, or declared)"),
       words.figure(fit.lack_of_fit_noise_um, "{:.1f} µm")},
      {words("of that, by repeats"), words.figure(fit.lack_of_fit_repeats_um, "{:.1f} µm")},
      {words("of that, by the maker's figures of the gears"),
       words.figure(fit.lack_of_fit_gears_um, "{:.1f} µm")},
      {words("lack of fit, p"), words.figure(fit.lack_of_fit_p, "{:.3g}")},
      {words("droop that is not in the model, p"), words.figure(fit.droop_p, "{:.3g}")},
      {words("that test finds a droop of one standard deviation in"),
       words.figure(fit.droop_power, "{:.2f} of 1")},
      {words("degrees of freedom"), words.figure(fit.degrees_of_freedom, "{:.1f}")}};
  const PlanePlaces places = places_of(words, result);
  for (const ResultDocument::PlaneFit& plane : fit.planes)
    lack.push_back({words("lack of fit of plane {}, p", plane_text(plane.plane, places)),
                    words.figure(plane.p, "{:.3g}")});
  return section(words("Uncertainty"),
                 budget_table(words, result) +
                     html::table(words, words("Predicted uncertainty of the tip elsewhere"),
                                 {words("where"), words("rms mm")}, elsewhere) +
                     monte_carlo_table(words, result) + pairs_table(words, words("Lack of fit"), lack) +
                     html::table(words, words("Strongest correlations of identified errors"),
                                 {words("error of"), words("and of"), words("coefficient")}, correlations));
}

}  // namespace cell
