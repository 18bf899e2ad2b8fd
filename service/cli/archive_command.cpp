#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <stdexcept>
#include <string>

#include "config/file_bytes.hpp"
#include "service/archive/archive_options.hpp"
#include "service/archive/archive_reader.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/fleet_reader.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/fleet_text.hpp"
#include "service/cli/result_text.hpp"
#include "service/documents/fleet_document.hpp"

namespace cell {
namespace {

std::string history_text(const HistoryDocument& history) {
  std::string lines = fmt::format("{:>8}  {:<26}{:<20}{:<6}{}\n", "number", "at", "what", "run", "said");
  for (const ArchivedFact& fact : history.facts)
    lines += fmt::format("{:>8}  {:<26}{:<20}{:<6}{}\n", fact.seq, table_field(fact.at),
                         table_field(fact.kind), table_field(fact.run_id), table_field(fact.body.text));
  if (history.next_before)
    lines +=
        fmt::format("older ones: touchcal fleet --cell {} --before {}\n", history.cell, *history.next_before);
  return lines;
}

/// Whether the archive has heard of the cell; says so where it has not.
bool demand_cell(const ArchiveArguments& arguments) {
  if (!history_of(arguments.url, arguments.cell, 1).facts.empty()) return true;
  fmt::print(stderr, "the archive has no cell '{}'; touchcal fleet lists those that it has\n",
             arguments.cell);
  return false;
}

/// Any cell may have written there what it likes.
std::vector<RunSummary> shown(std::vector<RunSummary> runs) {
  for (RunSummary& run : runs) {
    for (std::string* text : {&run.kind, &run.recipe, &run.started_at}) *text = table_field(*text);
    if (run.fault_code) run.fault_code = table_field(run.fault_code);
  }
  return runs;
}

ExitCode runs_in_archive(const ArchiveArguments& arguments, bool json) {
  if (!demand_cell(arguments)) return kExitUsage;
  const RunsDocument page = runs_of_cell(arguments.url, arguments.cell, arguments.limit, arguments.before);
  fmt::print("{}", json ? document_text(page) + "\n" : runs_text(shown(page.runs)));
  for (const DamagedRunDocument& run : page.damaged)
    fmt::print(stderr, "run {} cannot be told: {}\n", run.id, table_field(run.detail));
  if (page.next_before && !json)
    fmt::print("older ones: touchcal fleet --cell {} --runs --before {}\n", arguments.cell,
               *page.next_before);
  return kExitDone;
}

ExitCode history_command(const ArchiveArguments& arguments, bool json) {
  const HistoryDocument history =
      history_of(arguments.url, arguments.cell, arguments.limit, arguments.before);
  if (history.facts.empty() && !demand_cell(arguments)) return kExitUsage;
  fmt::print("{}", json ? document_text(history) + "\n" : history_text(history));
  return kExitDone;
}

/// Of a look at an archive: a line a cell, and the damage.
constexpr std::size_t kEarlierBytesMax = 100'000'000;

std::string chain_text(const ArchivedChain& chain) {
  const std::string before =
      chain.first > 1 ? fmt::format(" ({} before them were never archived, or are gone)", chain.first - 1)
                      : "";
  return fmt::format("{}: events {} to {}{}, the last {}\n", table_field(chain.cell), chain.first, chain.last,
                     before, table_field(chain.last_sha256));
}

ExitCode verify_archive(const ArchiveArguments& arguments, bool json) {
  ArchiveLook how{.touches = !arguments.without_touches, .earlier = {}};
  if (!arguments.earlier.empty()) {
    try {
      how.earlier = archive_document_from(read_file_bytes(arguments.earlier, kEarlierBytesMax));
    } catch (const std::runtime_error& error) {
      fmt::print(stderr, "{}: {}\n", arguments.earlier, error.what());
      return kExitBadInput;
    }
  }
  const ArchiveDocument look = look_at_archive(arguments.url, how);
  if (json) fmt::print("{}\n", document_text(look));
  for (const std::string& line : look.damage) fmt::print(stderr, "{}\n", table_field(line));
  if (!json)
    for (const ArchivedChain& chain : look.chains) fmt::print("{}", chain_text(chain));
  if (!look.damage.empty()) return kExitBadInput;
  if (!json) fmt::print("{} events of {} cells are in order\n", look.events, look.cells);
  return kExitDone;
}

/// What the archive says, that it does not do, or that it is not reached.
template <class Work>
ExitCode with_archive(const Work& work) {
  try {
    return work();
  } catch (const ArchiveRefused& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kExitRefused;
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
    if (arguments.action == "verify") return verify_archive(arguments, json);
    const std::string done = prepare_archive(arguments.url);
    fmt::print(json ? stderr : stdout, "{}\n", done);
    if (json) fmt::print("{}\n", document_text(look_at_archive(arguments.url)));
    return kExitDone;
  });
}

ExitCode fleet_command(const ArchiveArguments& arguments, bool json) {
  return with_archive([&] {
    if (arguments.runs) return runs_in_archive(arguments, json);
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
