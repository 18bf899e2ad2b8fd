// touchcal-sim: one simulated world, or many.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>

#include "config/decimal_text.hpp"
#include "tests/simulation/invariants.hpp"
#include "tests/simulation/world.hpp"

namespace {

/// What is drawn from a seed counts on from it.
constexpr std::uint64_t kSeedMax = 1'000'000'000'000;

/// A world that ends the program, and not only its daemon, breaks what it should show.
simulation::Outcome run_seed(std::uint64_t seed) try {
  return simulation::run_world(simulation::scenario_of(seed));
} catch (const std::exception& error) {
  simulation::Outcome outcome;
  outcome.broken.push_back(std::string("the world itself: ") + error.what());
  return outcome;
}

/// Exit codes are those of touchcal: 0 every invariant held, 1 one was broken, 2 usage.
int run_seeds(std::uint64_t first, std::uint64_t count, bool prints_journal) {
  simulation::setting();
  const auto begin = std::chrono::steady_clock::now();
  double virtual_s = 0.0;
  std::uint64_t broken_count = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const simulation::Outcome outcome = run_seed(seed);
    virtual_s += std::chrono::duration<double>(outcome.virtual_time).count();
    if (prints_journal || !outcome.broken.empty()) std::fputs(outcome.journal.c_str(), stdout);
    for (const std::string& broken : outcome.broken)
      std::printf("seed %llu breaks %s\n", static_cast<unsigned long long>(seed), broken.c_str());
    broken_count += outcome.broken.empty() ? 0 : 1;
  }
  const double real_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::fprintf(stderr, "%llu seeds, %llu broken; %.0f s of virtual time in %.2f s: %.0f times\n",
               static_cast<unsigned long long>(count), static_cast<unsigned long long>(broken_count),
               virtual_s, real_s, virtual_s / real_s);
  return broken_count == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("One simulated world of touchcal: daemon, link, disk, controller and people under one seed");
  std::uint64_t seed = 0, count = 1;
  bool is_quiet = false;
  const CLI::Validator decimal(cell::refuse_integer, "");
  app.add_option("--seed", seed, "the world to run")
      ->required()
      ->check(decimal)
      ->check(CLI::Range(std::uint64_t{0}, kSeedMax));
  app.add_option("--count", count, "so many worlds, from that seed on; more than one are quiet")
      ->check(decimal)
      ->check(CLI::Range(1, 10'000'000));
  app.add_flag("--quiet", is_quiet, "print the journal of broken worlds only");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return run_seeds(seed, count, !is_quiet && count == 1);
} catch (const std::exception& error) {
  std::fprintf(stderr, "touchcal-sim: %s\n", error.what());
  return 5;
}
