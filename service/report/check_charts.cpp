#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/report/internal/figure.hpp"
#include "service/report/internal/report_parts.hpp"
#include "service/report/internal/verification_parts.hpp"

namespace cell {
namespace {

std::string quantity_title(const Words& words, const std::string& quantity) {
  if (quantity == "growth") return words("Growth of the arm");
  if (quantity == "residual") return words("Change that the growth does not explain");
  return words("Joint {}, as if it alone had changed", quantity.substr(quantity.rfind('_') + 1));
}

/// The points are numbered as checks of the calibration, the reference among them.
Figure figure_of(const Words& words, const ChecksDocument::Chart& chart,
                 const std::vector<std::string>& runs) {
  Series values{.name = words("check")},
      means{.name = words("weighted mean"), .mark = Mark::kRing, .joined = true};
  Series upper{.name = words("limits"), .mark = Mark::kCross, .joined = true};
  Series lower = upper;
  lower.name = "";
  const bool is_bad_below = chart.quantity != "residual";
  Series mean_upper{.name = "", .mark = Mark::kRing, .joined = true}, mean_lower = mean_upper;
  for (const ChecksDocument::Point& point : chart.points) {
    const auto number = static_cast<double>(std::ranges::find(runs, point.run) - runs.begin() + 1);
    if (point.value) values.points.emplace_back(number, *point.value);
    if (point.weighted_mean) means.points.emplace_back(number, *point.weighted_mean);
    if (!point.shewhart_limit || !chart.centre) continue;
    if (point.ewma_limit) {
      mean_upper.points.emplace_back(number, *chart.centre + *point.ewma_limit);
      if (is_bad_below) mean_lower.points.emplace_back(number, *chart.centre - *point.ewma_limit);
    }
    upper.points.emplace_back(number, *chart.centre + *point.shewhart_limit);
    if (is_bad_below) lower.points.emplace_back(number, *chart.centre - *point.shewhart_limit);
  }
  Figure figure{.title = quantity_title(words, chart.quantity),
                .x_label = words("number of the check"),
                .y_label = chart.unit,
                .series = {values},
                .level = chart.centre,
                .level_name = words("first checks"),
                .x_range = std::pair(1.0, static_cast<double>(runs.size()))};
  if (!upper.points.empty())
    figure.series.insert(figure.series.end(), {means, upper, lower, mean_upper, mean_lower});
  return figure;
}

}  // namespace

std::string check_charts(const Words& words, const ChecksDocument& checks) {
  std::vector<std::string> runs;
  for (const ChecksDocument::Check& check : checks.checks) runs.push_back(check.run);
  std::string drawn;
  for (const ChecksDocument::Chart& chart : checks.charts)
    if (chart.points.size() > 1) drawn += svg(words, figure_of(words, chart, runs));
  const std::string counts = words(
      "{} checks up to this one, reference of {} of {}, limits from {} of {}. Beyond a limit is what chance "
      "makes of one check in 30 or fewer.",
      checks.count, checks.reference.count, checks.reference.needed, checks.base.count, checks.base.needed);
  return html::paragraph(counts) +
         (drawn.empty()
              ? html::paragraph(words("A figure begins with the second check that was held against the "
                                      "reference."))
              : drawn);
}

}  // namespace cell
