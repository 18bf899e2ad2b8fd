#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <stdexcept>
#include <string>

#include "service/archive/archive_options.hpp"
#include "service/archive/archive_reader.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/fleet_reader.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/fleet_text.hpp"
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
