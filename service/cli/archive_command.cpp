#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <stdexcept>
#include <string>

#include "service/archive/archive_options.hpp"
#include "service/archive/archive_reader.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/fleet_reader.hpp"
#include "service/base/terminal_text.hpp"
#include "service/cli/commands.hpp"
#include "service/documents/fleet_document.hpp"

namespace cell {
namespace {

/// Of a hash, in a table.
constexpr std::size_t kShownOfModel = 8;

/// Of a time, in a table.
std::string day_of(const std::optional<std::string>& at) {
  constexpr std::size_t kDay = 10;
  return at ? at->substr(0, kDay) : "-";
}

/// Whether the robot's programs were corrected with the cell's model, as a person said last.
std::string in_use(const FleetCell& cell) {
  if (!cell.applied_model) return "-";
  return cell.applied_model == cell.model ? "yes" : "other";
}

std::string fleet_text(const FleetDocument& fleet) {
  const auto shown = [](const std::optional<std::string>& text) { return text.value_or("-"); };
  constexpr auto kLine = "{:<16}{:<9}{:<10}{:<12}{:<12}{:<10}{:<8}{:<8}{:<13}{:<22}{:<12}{}\n";
  std::string lines = fmt::format(kLine, "cell", "state", "arm", "calibrated", "result", "model", "in use",
                                  "tip mm", "valid until", "check", "next check", "last fault");
  for (const FleetCell& cell : fleet.cells) {
    const std::string found = cell.last_check_cause.value_or(shown(cell.last_check_verdict));
    lines += fmt::format(
        kLine, cell.cell, shown(cell.state), shown(cell.arm), day_of(cell.ended_at),
        cell.outcome == "complete" ? shown(cell.verdict) : shown(cell.outcome),
        shown(cell.model).substr(0, kShownOfModel), in_use(cell),
        cell.tip_box_max_mm ? fmt::format("{:.3f}", *cell.tip_box_max_mm) : "-", day_of(cell.valid_until),
        cell.last_check_at ? day_of(cell.last_check_at) + " " + found : "-", day_of(cell.check_due_at),
        cell.last_fault_code ? day_of(cell.last_fault_at) + " " + *cell.last_fault_code : "-");
  }
  return terminal_text(lines);
}

std::string trends_text(const FleetTrendsDocument& document) {
  const auto shown = [](std::optional<double> figure, int digits) {
    return figure ? fmt::format("{:.{}f}", *figure, digits) : std::string("-");
  };
  constexpr auto kLine = "{:<9}{:<20}{:>6}{:>14}{:>10}{:>10}{:>9}{:>8}{:>8}{:>12}{:>8}{:>8}{:>8}\n";
  std::string lines = fmt::format(kLine, "month", "arm", "cells", "calibrations", "rejected", "approved",
                                  "tip mm", "checks", "alarms", "growth ppm", "proofs", "failed", "faults");
  for (const FleetTrend& trend : document.trends)
    lines += fmt::format(kLine, trend.month, trend.arm.value_or("not known"), trend.cells, trend.calibrations,
                         trend.rejected, trend.approved, shown(trend.tip_box_max_mm, 3), trend.checks,
                         trend.alarms, shown(trend.growth_ppm, 1), trend.proofs, trend.failed_proofs,
                         trend.faults);
  return terminal_text(lines);
}

std::string history_text(const HistoryDocument& history) {
  std::string lines = fmt::format("{:>8}  {:<26}{:<20}{:<6}{}\n", "number", "at", "what", "run", "said");
  for (const ArchivedFact& fact : history.facts)
    lines += fmt::format("{:>8}  {:<26}{:<20}{:<6}{}\n", fact.seq, fact.at, fact.kind,
                         fact.run_id.value_or("-"), fact.body.text);
  if (history.next_before)
    lines +=
        fmt::format("older ones: touchcal fleet --cell {} --before {}\n", history.cell, *history.next_before);
  return terminal_text(lines);  // any cell may write there what it likes
}

ExitCode history_command(const ArchiveArguments& arguments, bool json) {
  const HistoryDocument history =
      history_of(arguments.url, arguments.cell, arguments.limit, arguments.before);
  if (history.facts.empty() && history_of(arguments.url, arguments.cell, 1).facts.empty()) {
    fmt::print(stderr, "the archive has no cell '{}'; touchcal fleet lists those that it has\n",
               arguments.cell);
    return kExitUsage;
  }
  fmt::print("{}", json ? document_text(history) + "\n" : history_text(history));
  return kExitDone;
}

ExitCode verify_archive(const std::string& url, bool json) {
  const ArchiveDocument look = look_at_archive(url);
  if (json) fmt::print("{}\n", document_text(look));
  for (const std::string& line : look.damage) fmt::print(stderr, "{}\n", line);
  if (!look.damage.empty()) return kExitBadInput;
  if (!json) fmt::print("{} events of {} cells are in order\n", look.events, look.cells);
  return kExitDone;
}

/// What the archive says, or that it is not reached.
template <class Work>
ExitCode with_archive(const Work& work) {
  try {
    return work();
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kExitUnreachable;
  }
}

}  // namespace

std::string refuse_archive_url(const std::string& text) {
  if (archive_from_url(text)) return "";
  return "'" + text +
         "' is not postgresql://[USER@]HOST[:PORT]/DATABASE?sslmode=verify-full, without a password; a host "
         "that is this machine needs no sslmode";
}

ExitCode archive_command(const ArchiveArguments& arguments, bool json) {
  return with_archive([&] {
    if (arguments.action == "verify") return verify_archive(arguments.url, json);
    const std::string done = prepare_archive(arguments.url);
    fmt::print(json ? stderr : stdout, "{}\n", done);
    if (json) fmt::print("{}\n", document_text(look_at_archive(arguments.url)));
    return kExitDone;
  });
}

ExitCode fleet_command(const ArchiveArguments& arguments, bool json) {
  return with_archive([&] {
    if (!arguments.cell.empty()) return history_command(arguments, json);
    if (arguments.months) {
      const FleetTrendsDocument trends = trends_of(arguments.url, *arguments.months);
      fmt::print("{}", json ? document_text(trends) + "\n" : trends_text(trends));
      return kExitDone;
    }
    const FleetDocument fleet = fleet_of(arguments.url);
    fmt::print("{}", json ? document_text(fleet) + "\n" : fleet_text(fleet));
    return kExitDone;
  });
}

}  // namespace cell
