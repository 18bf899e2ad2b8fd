// touchcal-sim: one simulated world, or many.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <string>

#include "config/decimal_text.hpp"
#include "tests/simulation/chosen_world.hpp"
#include "tests/simulation/kept_journal.hpp"
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
  std::string journal_file;  // empty: none
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
  app.add_flag("--quiet", wanted.is_quiet, "print the journal of broken worlds only");
  try {
    app.parse(argc, argv);
    if (seed->count() == 0 && wanted.journal_file.empty())
      throw CLI::RequiredError("--seed N, or --repeat FILE,");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
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
