#include "service/cli/checks_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace cell {
namespace {

/// A mark beside a figure that is beyond a limit.
constexpr char kBeyondShewhart = '!', kBeyondEwma = '~', kWithin = ' ';

std::string check_verdict_text(const ChecksDocument::Check& check) {
  if (check.reference) return "reference";
  if (!check.accepted) return "no verdict";
  if (*check.accepted) return "unchanged";
  if (check.joint) return fmt::format("JOINT {}", *check.joint);
  return check.cause == "block" ? "BLOCK" : check.cause == "stylus" ? "STYLUS" : "CHANGED";
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
  // Fewer decimals of what is large: a joint that has slipped by a degree must not push the columns.
  const double size = std::abs(*point->value);
  const int decimals = size >= 1000.0 ? 0 : chart.unit == "ppm" || size >= 10.0 ? 1 : size >= 1.0 ? 2 : 3;
  return fmt::format("{:.{}f}{}", *point->value, decimals, mark);
}

/// So that the table has 77 columns.
int width_of(const ChecksDocument::Chart& chart) { return chart.unit == "ppm" ? 8 : 7; }

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
    lines += fmt::format("{:>{}}", column_name(chart), width_of(chart));
    units += fmt::format("{:>{}}", chart.unit + " ", width_of(chart));
  }
  lines += "\n" + units + "\n";
  for (const ChecksDocument::Check& check : document.checks) {
    lines += row_text(check.run, minutes_of(check.ended_at), check_verdict_text(check));
    for (const ChecksDocument::Chart& chart : document.charts)
      lines += fmt::format("{:>{}}", figure_text(chart, check.run), width_of(chart));
    lines += "\n";
  }
  return lines;
}

std::string due_text(const ChecksDocument& document) {
  if (!document.every_days)
    return "none is due: no check_every_days in the cell's file, or another run counts";
  if (!document.due_at) return "when the next one is due is not known";
  return fmt::format("{}: {} (every {} days)",
                     document.overdue.value_or(false) ? "OVERDUE since" : "next one due",
                     minutes_of(*document.due_at), *document.every_days);
}

}  // namespace

std::string checks_text(const ChecksDocument& document) {
  std::string lines = fmt::format("checks of run {}: {}, reference of {} of {}, limits from {} of {}\n",
                                  document.of_run, document.count, document.reference.count,
                                  document.reference.needed, document.base.count, document.base.needed);
  lines += due_text(document) + "\n";
  if (std::ssize(document.checks) < document.count)
    lines += fmt::format("the newest {} are listed\n", document.checks.size());
  if (!document.checks.empty()) lines += "\n" + table_text(document);
  if (std::ranges::any_of(document.charts, [](const auto& chart) { return chart.centre.has_value(); }))
    lines += fmt::format(
        "\n{} differs from the first {} checks by more than chance explains\n"
        "{} creeps: its weighted mean does\n"
        "Chance alone marks one check in 30 or fewer: check again before anything else.\n",
        kBeyondShewhart, document.base.needed, kBeyondEwma);
  for (const std::string& warning : document.warnings) lines += "\nWARNING " + warning + "\n";
  return lines;
}

}  // namespace cell
