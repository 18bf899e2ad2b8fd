// The figures of a qualification of the probe beside their limits.
#include <spdlog/fmt/fmt.h>

#include <vector>

#include "service/report/internal/report_parts.hpp"
#include "service/report/internal/verification_parts.hpp"

namespace cell {
namespace {

using Across = QualificationDocument::Across;
using Criterion = QualificationDocument::Criterion;

std::string criterion_words(const Words& words, const std::string& name) {
  if (name == "scatter") return words("scatter of the touches of one place (1 std)");
  if (name == "run_out") return words("run-out of the ball, from where the cell's files have it");
  if (name == "lobes") return words("lobes of the pre-travel, amplitude");
  if (name == "turns") return words("chance of what is left between the turns (p)");
  if (name == "stylus") return words("chance of so large a change of the stylus since the calibration (p)");
  return words("known length, {}, as the calibrated arm measures it: off by", words.known(name));
}

html::Row limit_row(const Words& words, const Criterion& criterion) {
  const bool is_chance = criterion.unit == "p";
  const char* value = is_chance ? "{:.3g}" : "{:.4f} mm";
  std::string limit = words("no limit in the cell's file");
  if (criterion.limit)
    limit = words.or_dash(criterion.limit, is_chance ? "at least {:g}" : "at most {:g} mm");
  std::string shown = words.or_dash(criterion.value, value);
  if (criterion.expanded) shown += words.or_dash(criterion.expanded, " ± {:.4f} (k = 2)");
  return {criterion_words(words, criterion.name), std::move(shown), std::move(limit),
          words(criterion.passed ? "pass" : "fail")};
}

std::string across_words(const Words& words, const Across& across) {
  if (!across.size_mm) return "–";
  return words("{}, known within {} (std), towards {} in R7", words.or_dash(across.size_mm, "{:.4f} mm"),
               words.or_dash(across.std_mm, "{:.4f} mm"), words.or_dash(across.direction_deg, "{:.0f}°"));
}

}  // namespace

std::string qualification_tables(const Words& words, const QualificationDocument& qualification) {
  std::vector<html::Row> limits, lengths;
  for (const Criterion& criterion : qualification.criteria) limits.push_back(limit_row(words, criterion));
  const auto& scatter = qualification.scatter;
  limits.push_back(told(words("scatter of a touch, in 95 of 100"),
                        words("{} to {}", words.or_dash(scatter.low_um, "{:.1f}"),
                              words.or_dash(scatter.high_um, "{:.1f} µm"))));
  limits.push_back(told(words("run-out of the ball"), across_words(words, qualification.run_out)));
  limits.push_back(told(words("lobes of the pre-travel"), across_words(words, qualification.lobes)));
  limits.push_back(
      told(words("ball, from where the calibrated arm has it"), across_words(words, qualification.change)));
  limits.push_back(
      told(words("touches"), touches_text(words, qualification.touch_count, qualification.complete)));
  for (const QualificationDocument::Length& length : qualification.lengths)
    lengths.push_back({words("{} and {}", length.planes[0], length.planes[1]),
                       words.or_dash(length.known_mm, "{:.4f}"), words.or_dash(length.error_mm, "{:+.4f}"),
                       words.or_dash(length.std_mm, "{:.4f}"), words.or_dash(length.p, "{:.3g}")});
  const std::string measured =
      html::table(words, words("Known lengths, as the calibrated arm measures them"),
                  {words("planes"), words("known mm"), words("error mm"), words("std. uncertainty mm"),
                   words("chance of so large an error")},
                  lengths);
  return figures_table(words, limits) + (lengths.empty() ? std::string() : measured);
}

}  // namespace cell
