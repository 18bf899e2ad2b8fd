// touchcal-sim: one simulated world, or many.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/decimal_text.hpp"
#include "tests/simulation/shrinking.hpp"
#include "tests/simulation/world.hpp"

namespace {

/// What is drawn from a seed counts on from it.
constexpr std::uint64_t kSeedMax = 1'000'000'000'000;

/// What the command line asks for.
struct Wanted {
  std::uint64_t first_seed = 0;
  std::uint64_t count = 1;
  std::vector<std::size_t> events;  // of the one seed, by their numbers from 1; empty: all, 0: none
  bool is_quiet = false;
};

class UnknownEvent : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

simulation::Scenario scenario_wanted(const Wanted& wanted, std::uint64_t seed) {
  simulation::Scenario scenario = simulation::scenario_of(seed);
  if (wanted.events.empty()) return scenario;
  std::vector<std::size_t> places;
  for (const std::size_t number : wanted.events) {
    if (number > scenario.faults.size())
      throw UnknownEvent("--events: seed " + std::to_string(seed) + " has " +
                         std::to_string(scenario.faults.size()) + " events, and " + std::to_string(number) +
                         " is none of them; give numbers of its report");
    if (number > 0) places.push_back(number - 1);
  }
  std::ranges::sort(places);
  return simulation::with_only(scenario, places);
}

/// Exit codes are those of touchcal: 0 every invariant held, 1 one was broken.
int run_seeds(const Wanted& wanted) {
  simulation::setting();
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t busy_begin = std::clock();
  double virtual_s = 0.0;
  std::uint64_t broken_count = 0;
  for (std::uint64_t seed = wanted.first_seed; seed < wanted.first_seed + wanted.count; ++seed) {
    const simulation::Scenario scenario = scenario_wanted(wanted, seed);
    const simulation::Outcome outcome = simulation::run_world(scenario);
    virtual_s += std::chrono::duration<double>(outcome.virtual_time).count();
    if (!wanted.is_quiet) std::fputs(outcome.journal.c_str(), stdout);
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

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("One simulated world of touchcal: daemon, link, disk, controller and people under one seed");
  Wanted wanted;
  const CLI::Validator decimal(cell::refuse_integer, "");
  app.add_option("--seed", wanted.first_seed, "the world to run")
      ->required()
      ->check(decimal)
      ->check(CLI::Range(std::uint64_t{0}, kSeedMax));
  auto* const count =
      app.add_option("--count", wanted.count, "so many worlds, from that seed on; more than one are quiet")
          ->check(decimal)
          ->check(CLI::Range(1, 10'000'000));
  app.add_option("--events", wanted.events,
                 "only these of what the seed draws, by their numbers: 1,3; 0: none")
      ->delimiter(',')
      ->check(decimal)
      ->excludes(count);
  app.add_flag("--quiet", wanted.is_quiet, "print the journal of broken worlds only");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  wanted.is_quiet = wanted.is_quiet || wanted.count > 1;
  return run_seeds(wanted);
} catch (const UnknownEvent& error) {
  std::fprintf(stderr, "touchcal-sim: %s\n", error.what());
  return 2;
} catch (const std::exception& error) {
  std::fprintf(stderr, "touchcal-sim: %s\n", error.what());
  return 5;
}
