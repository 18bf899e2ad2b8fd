#include "tests/simulation/shrinking.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "tests/simulation/chosen_world.hpp"

namespace simulation {
namespace {

/// Of a line of Outcome::broken.
std::string_view invariant_in(std::string_view broken) { return broken.substr(0, broken.find(':')); }

class Shrinking {
 public:
  Shrinking(const Scenario& scenario, const Outcome& broken)
      : scenario_(scenario), invariant_(invariant_in(broken.broken.at(0))) {
    smallest_.kept.resize(scenario.faults.size());
    std::iota(smallest_.kept.begin(), smallest_.kept.end(), std::size_t{0});
    smallest_.outcome = broken;
  }

  void find_shortest_beginning() {
    const std::vector<std::size_t> all = smallest_.kept;
    std::vector<std::size_t> beginning;
    for (const std::size_t next : all) {
      if (take_if_broken(beginning)) return;
      beginning.push_back(next);
    }
  }

  /// False when none can be left out.
  bool leave_one_out() {
    const std::vector<std::size_t> all = smallest_.kept;
    return std::ranges::any_of(all, [&](std::size_t one) {
      std::vector<std::size_t> fewer = all;
      std::erase(fewer, one);
      return take_if_broken(fewer);
    });
  }

  [[nodiscard]] Shrunk smallest() const { return smallest_; }

 private:
  bool take_if_broken(const std::vector<std::size_t>& kept) {
    const Scenario fewer = with_only(scenario_, kept);
    Outcome outcome = run_world(fewer);
    ++smallest_.worlds_count;
    const bool is_broken = std::ranges::any_of(
        outcome.broken, [this](std::string_view line) { return invariant_in(line) == invariant_; });
    if (!is_broken) return false;
    smallest_.kept = kept;
    smallest_.outcome = std::move(outcome);
    return true;
  }

  const Scenario& scenario_;
  std::string invariant_;
  Shrunk smallest_;
};

}  // namespace

Scenario with_only(const Scenario& scenario, const std::vector<std::size_t>& places) {
  Scenario fewer = scenario;
  fewer.faults.clear();
  for (const std::size_t place : places) fewer.faults.push_back(scenario.faults.at(place));
  return fewer;
}

Shrunk shrink(const Scenario& scenario, const Outcome& broken) {
  Shrinking shrinking(scenario, broken);
  shrinking.find_shortest_beginning();
  while (shrinking.leave_one_out()) {
  }
  return shrinking.smallest();
}

std::string broken_report(const Scenario& scenario, const Outcome& broken) {
  const Shrunk shrunk = shrink(scenario, broken);
  const std::string_view invariant = invariant_in(broken.broken.at(0));
  ChosenWorld smallest{.seed = scenario.seed, .events = {}};
  for (const std::size_t place : shrunk.kept) smallest.events.push_back(scenario.faults[place].event);
  if (smallest.events.empty() && !scenario.faults.empty()) smallest.events = {0};
  std::string text = fmt::format("---- smallest world that breaks {}, of {} that were tried\n{}\n", invariant,
                                 shrunk.worlds_count, smallest.line());
  text += shrunk.outcome.journal;
  for (const std::string& line : broken.broken)
    text += fmt::format("seed {} breaks {}\n", scenario.seed, line);
  text += fmt::format("{} of its {} events are enough for {}, and none of these can be left out:\n",
                      shrunk.kept.size(), scenario.faults.size(), invariant);
  for (const std::size_t place : shrunk.kept) {
    const DrawnFault& fault = scenario.faults[place];
    const double at_s = std::chrono::duration<double>(fault.at).count();
    text += fmt::format("  event {} at {:.3f} s: {}\n", fault.event, at_s, fault_text(fault));
  }
  return text + "again: " + smallest.line() + "\n";
}

}  // namespace simulation
