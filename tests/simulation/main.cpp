// touchcal-sim: one simulated world, or many.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "config/decimal_text.hpp"
#include "tests/simulation/chosen_world.hpp"
#include "tests/simulation/kept_journal.hpp"
#include "tests/simulation/made_table.hpp"
#include "tests/simulation/shrinking.hpp"

namespace {

// Exit codes are those of touchcal: 0 every invariant held, 1 one was broken, 2 usage, 3 a bad file.
constexpr int kExitUsage = 2;
constexpr int kExitBadFile = 3;

/// What the command line asks for.
struct Wanted {
  simulation::ChosenWorld first;
  std::uint64_t count = 1;
  bool is_quiet = false;
  std::string journal_file;       // empty: none
  bool is_table = false;          // the fault table as a document
  std::string checked_document;   // ... compared with this file; empty: printed
  std::vector<std::size_t> cell;  // of the table: mode and step
};

int run_seeds(const Wanted& wanted) {
  simulation::setting();
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t busy_begin = std::clock();
  double virtual_s = 0.0;
  std::uint64_t broken_count = 0;
  simulation::ChosenWorld chosen = wanted.first;
  for (std::uint64_t i = 0; i < wanted.count; ++i, ++chosen.seed) {
    const simulation::Scenario scenario = chosen.scenario();
    const simulation::Outcome outcome = simulation::run_world(scenario);
    virtual_s += std::chrono::duration<double>(outcome.virtual_time).count();
    if (!wanted.is_quiet) std::printf("%s\n%s", chosen.line().c_str(), outcome.journal.c_str());
    if (outcome.broken.empty()) continue;
    ++broken_count;
    std::fputs(simulation::broken_report(scenario, outcome).c_str(), stdout);
  }
  const double real_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double busy_s = static_cast<double>(std::clock() - busy_begin) / CLOCKS_PER_SEC;
  std::fprintf(
      stderr,
      "%llu seeds, %llu broken; %.0f s of virtual time in %.2f s: %.0f times; %.3f s of a processor a "
      "seed: %.0f times\n",
      static_cast<unsigned long long>(wanted.count), static_cast<unsigned long long>(broken_count), virtual_s,
      real_s, virtual_s / real_s, busy_s / static_cast<double>(wanted.count), virtual_s / busy_s);
  return broken_count == 0 ? 0 : 1;
}

int repeat_file(const std::string& name) {
  std::ifstream file(name);
  if (!file) throw simulation::BadJournal(name + ": cannot be read; give the journal of a world");
  const auto broken = simulation::repeat_journals(file, name);
  for (const std::string& line : broken) std::printf("breaks %s\n", line.c_str());
  std::fprintf(stderr, "%s: the same to the byte\n", name.c_str());
  return broken.empty() ? 0 : 1;
}

int make_or_check_table(const std::string& checked_document) {
  const std::string made = simulation::fault_table_document(simulation::make_table(stderr));
  if (checked_document.empty()) return std::fputs(made.c_str(), stdout) < 0 ? 1 : 0;
  std::ifstream file(checked_document);
  std::stringstream given;
  given << file.rdbuf();
  const std::string difference = simulation::first_difference(made, given.str());
  if (difference.empty()) return 0;
  std::printf("%s: %s\n", checked_document.c_str(), difference.c_str());
  return 1;
}

int run_table_cell(const std::vector<std::size_t>& number) {
  if (number[0] >= simulation::table_modes().size() || number[1] == 0 ||
      number[1] > simulation::table_steps().size()) {
    std::fprintf(stderr, "touchcal-sim: --cell: modes are 0 to %zu, steps 1 to %zu\n",
                 simulation::table_modes().size() - 1, simulation::table_steps().size());
    return kExitUsage;
  }
  const simulation::TableMode& mode = simulation::table_modes()[number[0]];
  const simulation::TableStep& step = simulation::table_steps()[number[1] - 1];
  const simulation::TriedCell tried = simulation::try_cell(mode, step, simulation::undisturbed(step));
  if (tried.cell.cannot_happen.empty())
    std::fputs(simulation::run_world(simulation::scenario_of(mode, step)).journal.c_str(), stdout);
  std::printf("%s: %s; %s\n| %s\n", std::string(mode.group).c_str(), std::string(mode.name).c_str(),
              std::string(step.name).c_str(), simulation::cell_text(tried.cell, {}).c_str());
  for (const std::string& what : tried.contradictions) std::printf("%s\n", what.c_str());
  return tried.contradictions.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("One simulated world of touchcal: daemon, link, disk, controller and people under one seed");
  Wanted wanted;
  const CLI::Validator decimal(cell::refuse_integer, "");
  auto* const seed = app.add_option("--seed", wanted.first.seed, "the world to run");
  seed->check(decimal)->check(CLI::Range(std::uint64_t{0}, simulation::kSeedMax));
  auto* const count =
      app.add_option("--count", wanted.count, "so many worlds, from that seed on; more than one are quiet");
  count->check(decimal)->check(CLI::Range(1, 10'000'000))->needs(seed);
  app.add_option("--events", wanted.first.events,
                 "only these of what the seed draws, by their numbers: 1,3; 0: none")
      ->delimiter(',')
      ->check(decimal)
      ->needs(seed)
      ->excludes(count);
  app.add_option("--repeat", wanted.journal_file,
                 "run the worlds again whose journals are in this file, and compare")
      ->excludes(seed);
  auto* const table =
      app.add_flag("--table", wanted.is_table, "print the fault table: every mode at every step");
  table->excludes(seed);
  app.add_option("--check", wanted.checked_document,
                 "compare the table with this file, and print nothing else")
      ->needs(table);
  app.add_option("--cell", wanted.cell, "one cell of the table with its journal: MODE,STEP")
      ->delimiter(',')
      ->expected(2)
      ->check(decimal)
      ->excludes(seed)
      ->excludes(table);
  app.add_flag("--quiet", wanted.is_quiet, "print the journal of broken worlds only");
  try {
    app.parse(argc, argv);
    if (seed->count() == 0 && wanted.journal_file.empty() && !wanted.is_table && wanted.cell.empty())
      throw CLI::RequiredError("--seed N, --repeat FILE, --table or --cell MODE,STEP");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  if (wanted.is_table) return make_or_check_table(wanted.checked_document);
  if (!wanted.cell.empty()) return run_table_cell(wanted.cell);
  if (!wanted.journal_file.empty()) return repeat_file(wanted.journal_file);
  wanted.is_quiet = wanted.is_quiet || wanted.count > 1;
  return run_seeds(wanted);
} catch (const simulation::UnknownEvent& error) {
  std::fprintf(stderr, "touchcal-sim: --events: %s\n", error.what());
  return kExitUsage;
} catch (const simulation::BadJournal& error) {
  std::fprintf(stderr, "touchcal-sim: %s\n", error.what());
  return kExitBadFile;
} catch (const std::exception& error) {
  std::fprintf(stderr, "touchcal-sim: %s\n", error.what());
  return 5;
}
