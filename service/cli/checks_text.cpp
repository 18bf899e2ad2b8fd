#include "service/cli/checks_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace cell {
namespace {

/// A mark beside a figure that is beyond a limit.
constexpr char kBeyondShewhart = '!', kBeyondEwma = '~', kWithin = ' ';

std::string check_verdict_text(const ChecksDocument::Check& check) {
  if (check.reference) return "reference";
  if (!check.accepted) return "no verdict";
  if (*check.accepted) return "unchanged";
  return check.joint ? fmt::format("JOINT {}", *check.joint) : check.cause.value_or("changed");
}

std::string minutes_of(const std::string& time) {
  constexpr std::size_t kToMinutes = 16;  // 2026-11-28T09:15
  std::string shown = time.substr(0, kToMinutes);
  std::ranges::replace(shown, 'T', ' ');
  return shown;
}

/// Of a check in a chart; a dash where it is not in it.
std::string figure_text(const ChecksDocument::Chart& chart, const std::string& run) {
  const auto point = std::ranges::find(chart.points, run, &ChecksDocument::Point::run);
  if (point == chart.points.end() || !point->value) return "- ";
  const char mark = point->beyond_shewhart ? kBeyondShewhart : point->beyond_ewma ? kBeyondEwma : kWithin;
  return chart.unit == "ppm" ? fmt::format("{:.1f}{}", *point->value, mark)
                             : fmt::format("{:.3f}{}", *point->value, mark);
}

std::string column_name(const ChecksDocument::Chart& chart) {
  if (chart.quantity == "growth") return "growth ";
  if (chart.quantity == "residual") return "rms ";
  return "J" + chart.quantity.substr(chart.quantity.rfind('_') + 1) + " ";
}

std::string row_text(const std::string& run, const std::string& ended, const std::string& verdict) {
  return fmt::format("{:<6}{:<17}{:<11}", run, ended, verdict);
}

std::string table_text(const ChecksDocument& document) {
  std::string lines = row_text("run", "ended (UTC)", "verdict"), units = row_text("", "", "");
  for (const ChecksDocument::Chart& chart : document.charts) {
    lines += fmt::format("{:>7}", column_name(chart));
    units += fmt::format("{:>7}", chart.unit + " ");
  }
  lines += "\n" + units + "\n";
  for (const ChecksDocument::Check& check : document.checks) {
    lines += row_text(check.run, minutes_of(check.ended_at), check_verdict_text(check));
    for (const ChecksDocument::Chart& chart : document.charts)
      lines += fmt::format("{:>7}", figure_text(chart, check.run));
    lines += "\n";
  }
  return lines;
}

}  // namespace

std::string checks_text(const ChecksDocument& document) {
  std::string lines = fmt::format("checks of run {}: {}, reference of {} of {}, limits from {} of {}\n",
                                  document.of_run, document.checks.size(), document.reference.count,
                                  document.reference.needed, document.base.count, document.base.needed);
  if (document.due_at)
    lines += fmt::format("{}: {} (every {} days)\n",
                         document.overdue.value_or(false) ? "OVERDUE since" : "next one due",
                         minutes_of(*document.due_at), document.every_days.value_or(0));
  else
    lines += "none is due: the cell's file has no check_every_days, or another calibration counts\n";
  if (!document.checks.empty()) lines += "\n" + table_text(document);
  if (std::ranges::any_of(document.charts, [](const auto& chart) { return chart.centre.has_value(); }))
    lines += fmt::format(
        "\n{} beyond 3 sigma of the first checks\n{} its weighted mean is beyond its limit: it creeps\n",
        kBeyondShewhart, kBeyondEwma);
  for (const std::string& warning : document.warnings) lines += "\nWARNING " + warning + "\n";
  return lines;
}

}  // namespace cell
