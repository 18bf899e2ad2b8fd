// Runs in which a call of touchcald fails, or ends it: the n-th allocation finds no memory, the n-th write to
// a file no space or only half of it, the n-th fsync fails, or SIGKILL comes in the middle of the n-th write.
// A start with an empty state directory, a start behind a kill, a touch, the end at SIGTERM. What the
// controller answered is held against the store, results against that of an undisturbed run; whoever ends has
// said why, and the next daemon is ready in a second.
//   failing_runs steps [EACH [CALL [PART PARTS]]]   of each kind of call in each step the first so many, the
//     last so many, and as many between; all: 0. Of one kind of call, or `all`. PART of PARTS, from 1: for
//     several programs side by side
//   failing_runs drawn [COUNT [SEED]]   so many by lot over whole runs; 1,000
//   failing_runs one STEP CALL AT [COUNT]   the same place again and again, each in a run of its own; once.
//     STEP: first_start, start, touch, end; CALL: allocation, write, short_write, sync, kill; an AT below 0
//     counts from the last call that an undisturbed step makes, which is -1
#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/benchmark/failing_steps.hpp"

namespace bench {
namespace {

constexpr std::array<std::string_view, kSteps.size()> kStepWords{"first_start", "start", "touch", "end"};
constexpr std::array<std::string_view, kCalls.size()> kCallWords{"allocation", "write", "short_write", "sync",
                                                                 "kill"};
constexpr int kFailuresInARun = 5;  // of those by lot
/// A run that goes on behind a restart is planned again, which takes longer than all the rest: in `steps`
/// only one of so many starts and ends is in a touch, and finds the run on hold else.
constexpr int kRestartsForAPlan = 8;

/// Throws what std::stoll throws, and std::invalid_argument for a name that is none.
template <class Names>
std::size_t place_in(const Names& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw std::invalid_argument("there is no '" + name + "'");
  return static_cast<std::size_t>(found - names.begin());
}

struct Part {
  std::int64_t number = 1, of = 1;
};

/// Of 1 to `count` the first and the last `each`, and as many between, evenly; all of them: 0.
std::vector<std::int64_t> places_of(std::int64_t count, std::int64_t each) {
  std::set<std::int64_t> places;
  for (std::int64_t i = 1; i <= (each == 0 ? count : std::min(each, count)); ++i) {
    places.insert(i);
    places.insert(count + 1 - i);
    if (each > 0) places.insert(1 + (i - 1) * count / each);
  }
  return {places.begin(), places.end()};
}

bool fail_in_steps(std::int64_t each, const std::optional<FailingCall>& only, const Part& part) {
  FailingRuns runs(kWatchedTouches, kRestartsForAPlan);
  for (const Step step : kSteps) {
    for (const FailingCall call : kCalls) {
      if (only && call != *only) continue;
      const std::int64_t count = runs.counts(step).of(call);
      const std::vector<std::int64_t> places = places_of(count, each);
      std::size_t made = 0;
      for (auto i = static_cast<std::size_t>(part.number - 1); i < places.size();
           i += static_cast<std::size_t>(part.of), ++made)
        runs.make({step, call, places[i]});
      std::printf("%-11s %s: %zu of %lld\n", kStepNames[static_cast<std::size_t>(step)],
                  kCallNames[static_cast<std::size_t>(call)], made, static_cast<long long>(count));
      std::fflush(stdout);
    }
  }
  runs.settle();
  return runs.print("steps");
}

bool fail_in_steps(const std::vector<std::string>& words) {
  const std::int64_t each = words.empty() ? 0 : std::stoll(words[0]);
  std::optional<FailingCall> only;
  if (words.size() > 1 && words[1] != "all") only = kCalls.at(place_in(kCallWords, words[1]));
  Part part;
  if (words.size() > 3) part = {std::stoll(words[2]), std::stoll(words[3])};
  if (each < 0 || part.number < 1 || part.number > part.of)
    throw std::invalid_argument("give EACH from 0, PART from 1 to PARTS");
  return fail_in_steps(each, only, part);
}

bool fail_by_lot(int count, std::uint64_t seed) {
  std::mt19937_64 chance(seed);
  FailingRuns runs(kFailuresInARun);
  std::vector<Failure> failures;
  for (int i = 0; i < count; ++i) {
    // Every other one in a touch or those behind it.
    const std::size_t drawn = std::uniform_int_distribution<std::size_t>(0, 2 * kSteps.size() - 1)(chance);
    const Step step = drawn < kSteps.size() ? kSteps[drawn] : Step::kTouch;
    const FailingCall call = kCalls[std::uniform_int_distribution<std::size_t>(0, kCalls.size() - 1)(chance)];
    const std::int64_t last = std::max<std::int64_t>(1, runs.counts(step).of(call)) *
                              (step == Step::kTouch ? kTouchesAtOnce - 1 : 1);
    failures.push_back({step, call, std::uniform_int_distribution<std::int64_t>(1, last)(chance)});
  }
  // A state directory that is new has no plan, and the planner takes longer than a run: those come together.
  std::ranges::stable_partition(failures, [](const Failure& one) { return one.step == Step::kFirstStart; });
  for (const Failure& failure : failures) runs.make(failure);
  runs.settle();
  return runs.print("by lot");
}

bool fail_one(const std::vector<std::string>& words) {
  if (words.size() < 3) throw std::invalid_argument("give STEP CALL AT [COUNT]");
  Failure failure{kSteps.at(place_in(kStepWords, words[0])), kCalls.at(place_in(kCallWords, words[1])),
                  std::stoll(words[2])};
  const int count = words.size() > 3 ? std::stoi(words[3]) : 1;
  FailingRuns runs(1);
  if (failure.at < 0) failure.at += runs.counts(failure.step).of(failure.call) + 1;
  for (int i = 0; i < count; ++i) runs.make(failure);
  runs.settle();
  return runs.print("one");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // what came before is seen where it ends by a hang
  const std::string what = argc > 1 ? argv[1] : "drawn";
  const std::uint64_t seed = what == "drawn" && argc > 3 ? std::stoull(argv[3]) : 1;
  try {
    if (what == "steps") return bench::fail_in_steps({argv + 2, argv + argc}) ? 0 : 1;
    if (what == "drawn") return bench::fail_by_lot(argc > 2 ? std::stoi(argv[2]) : 1'000, seed) ? 0 : 1;
    if (what == "one") return bench::fail_one({argv + 2, argv + argc}) ? 0 : 1;
    std::fprintf(stderr, "failing_runs: there is no '%s'; give steps, drawn or one\n", what.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failing_runs: seed %llu: %s\n", static_cast<unsigned long long>(seed),
                 error.what());
  }
  return 2;
}
