// The figures of a qualification of the probe beside their limits.
#include <spdlog/fmt/fmt.h>

#include <vector>

#include "service/report/internal/report_parts.hpp"
#include "service/report/internal/verification_parts.hpp"

namespace cell {
namespace {

using Across = QualificationDocument::Across;
using Criterion = QualificationDocument::Criterion;

std::string criterion_words(const std::string& name) {
  if (name == "scatter") return "scatter of the touches of one place (1 std)";
  if (name == "run_out") return "run-out of the ball, from where the cell's files have it";
  if (name == "lobes") return "lobes of the pre-travel, amplitude";
  if (name == "turns") return "chance of what is left between the turns (p)";
  if (name == "stylus") return "chance of so large a change of the stylus since the calibration (p)";
  return "known length, " + text_or_unknown(name) + ", as the calibrated arm measures it: off by";
}

html::Row limit_row(const Criterion& criterion) {
  const bool is_chance = criterion.unit == "p";
  const char* value = is_chance ? "{:.3g}" : "{:.4f} mm";
  std::string limit = "no limit in the cell's file";
  if (criterion.limit) limit = or_dash(criterion.limit, is_chance ? "at least {:g}" : "at most {:g} mm");
  std::string shown = or_dash(criterion.value, value);
  if (criterion.expanded) shown += or_dash(criterion.expanded, " ± {:.4f} (k = 2)");
  return {criterion_words(criterion.name), std::move(shown), std::move(limit),
          criterion.passed ? "pass" : "fail"};
}

std::string across_words(const Across& across) {
  if (!across.size_mm) return "–";
  return fmt::format("{}, known within {} (std), towards {} in R7", or_dash(across.size_mm, "{:.4f} mm"),
                     or_dash(across.std_mm, "{:.4f} mm"), or_dash(across.direction_deg, "{:.0f}°"));
}

}  // namespace

std::string qualification_tables(const QualificationDocument& qualification) {
  std::vector<html::Row> limits, lengths;
  for (const Criterion& criterion : qualification.criteria) limits.push_back(limit_row(criterion));
  const auto& scatter = qualification.scatter;
  limits.push_back(told("scatter of a touch, in 95 of 100",
                        or_dash(scatter.low_um, "{:.1f}") + " to " + or_dash(scatter.high_um, "{:.1f} µm")));
  limits.push_back(told("run-out of the ball", across_words(qualification.run_out)));
  limits.push_back(told("lobes of the pre-travel", across_words(qualification.lobes)));
  limits.push_back(told("ball, from where the calibrated arm has it", across_words(qualification.change)));
  limits.push_back(told("touches", std::to_string(qualification.touch_count) +
                                       (qualification.complete ? "" : ", not complete")));
  for (const QualificationDocument::Length& length : qualification.lengths)
    lengths.push_back({fmt::format("{} and {}", length.planes[0], length.planes[1]),
                       or_dash(length.known_mm, "{:.4f}"), or_dash(length.error_mm, "{:+.4f}"),
                       or_dash(length.std_mm, "{:.4f}"), or_dash(length.p, "{:.3g}")});
  const std::string measured = html::table(
      "Known lengths, as the calibrated arm measures them",
      {"planes", "known mm", "error mm", "std. uncertainty mm", "chance of so large an error"}, lengths);
  return figures_table(limits) + (lengths.empty() ? std::string() : measured);
}

}  // namespace cell
