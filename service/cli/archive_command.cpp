#include <spdlog/fmt/fmt.h>

#include <algorithm>
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

/// Whether the robot's programs were corrected with the cell's model, as a person said last.
std::string in_use(const FleetCell& cell) {
  if (!cell.applied_model) return "-";
  return cell.applied_model == cell.model ? "yes" : "other";
}

/// A field of a table: any cell may have written there what it likes, a line of another cell too.
std::string field(const std::optional<std::string>& text) {
  std::string shown = terminal_text(text.value_or("-"));
  std::ranges::replace(shown, '\n', '?');
  return shown;
}

/// Of a time.
std::string day_in_table(const std::optional<std::string>& at) {
  constexpr std::size_t kDay = 10;
  return at ? field(at).substr(0, kDay) : "-";
}

/// A date that has passed.
std::string mark_late(bool is_late) { return is_late ? "!" : ""; }

std::string fleet_text(const FleetDocument& fleet) {
  constexpr auto kLine = "{:<16}{:<9}{:<10}{:<12}{:<12}{:<12}{:<10}{:<8}{:<8}{:<13}{:<22}{:<13}{:<22}{}\n";
  std::string lines =
      fmt::format(kLine, "cell", "state", "arm", "heard of", "last run", "result", "model", "in use",
                  "tip mm", "valid until", "check", "next check", "last fault", "certificate");
  for (const FleetCell& cell : fleet.cells) {
    lines += fmt::format(
        kLine, field(cell.cell), field(cell.state), field(cell.arm), day_in_table(cell.heard_at),
        day_in_table(cell.ended_at), field(cell.outcome == "complete" ? cell.verdict : cell.outcome),
        field(cell.model).substr(0, kShownOfModel), in_use(cell),
        cell.tip_box_max_mm ? fmt::format("{:.3f}", *cell.tip_box_max_mm) : "-",
        day_in_table(cell.valid_until) + mark_late(cell.model_over),
        cell.last_check_at
            ? day_in_table(cell.last_check_at) + " " +
                  field(cell.last_check_cause ? cell.last_check_cause : cell.last_check_verdict)
            : "-",
        day_in_table(cell.check_due_at) + mark_late(cell.check_overdue),
        cell.last_fault_code ? day_in_table(cell.last_fault_at) + " " + field(cell.last_fault_code) : "-",
        cell.certificate_artefact
            ? field(cell.certificate_artefact) + " " + day_in_table(cell.certificate_valid_until)
            : "-");
  }
  return lines + "days in UTC, heard of by the archive's clock; ! is over\n";
}

std::string trends_text(const FleetTrendsDocument& document) {
  const auto shown = [](std::optional<double> figure, int digits) {
    return figure ? fmt::format("{:.{}f}", *figure, digits) : std::string("-");
  };
  constexpr auto kLine = "{:<9}{:<20}{:>6}{:>14}{:>10}{:>10}{:>9}{:>8}{:>8}{:>12}{:>8}{:>8}{:>8}\n";
  std::string lines = fmt::format(kLine, "month", "arm", "cells", "calibrations", "rejected", "approved",
                                  "tip mm", "checks", "alarms", "growth ppm", "proofs", "failed", "faults");
  for (const FleetTrend& trend : document.trends)
    lines += fmt::format(kLine, field(trend.month), trend.arm ? field(trend.arm) : "not known", trend.cells,
                         trend.calibrations, trend.rejected, trend.approved, shown(trend.tip_box_max_mm, 3),
                         trend.checks, trend.alarms, shown(trend.growth_ppm, 1), trend.proofs,
                         trend.failed_proofs, trend.faults);
  return lines;
}

std::string history_text(const HistoryDocument& history) {
  std::string lines = fmt::format("{:>8}  {:<26}{:<20}{:<6}{}\n", "number", "at", "what", "run", "said");
  for (const ArchivedFact& fact : history.facts)
    lines += fmt::format("{:>8}  {:<26}{:<20}{:<6}{}\n", fact.seq, field(fact.at), field(fact.kind),
                         field(fact.run_id), field(fact.body.text));
  if (history.next_before)
    lines +=
        fmt::format("older ones: touchcal fleet --cell {} --before {}\n", history.cell, *history.next_before);
  return lines;
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
