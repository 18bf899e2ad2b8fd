#include "tests/simulation/chosen_world.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "tests/simulation/shrinking.hpp"

namespace simulation {
namespace {

constexpr std::string_view kSeedAt = "touchcal-sim --seed ";
constexpr std::string_view kEventsAt = " --events ";

/// Takes a number from the beginning of `text`; false where there is none.
template <class Number>
bool take_number(std::string_view& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take_text(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

}  // namespace

std::string ChosenWorld::line() const {
  if (events.empty()) return fmt::format("{}{}", kSeedAt, seed);
  return fmt::format("{}{}{}{}", kSeedAt, seed, kEventsAt, fmt::join(events, ","));
}

Scenario ChosenWorld::scenario() const {
  Scenario whole = scenario_of(seed);
  if (events.empty()) return whole;
  std::vector<std::size_t> places;
  for (const std::size_t number : events) {
    if (number > whole.faults.size())
      throw UnknownEvent(
          fmt::format("seed {} has {} events, and {} is none of them; take numbers from the report of this "
                      "commit's program",
                      seed, whole.faults.size(), number));
    if (number > 0) places.push_back(number - 1);
  }
  std::ranges::sort(places);
  return with_only(whole, places);
}

std::optional<ChosenWorld> chosen_by(std::string_view line) {
  ChosenWorld chosen;
  if (!take_text(line, kSeedAt) || !take_number(line, chosen.seed) || chosen.seed > kSeedMax)
    return std::nullopt;
  if (line.empty()) return chosen;
  if (!take_text(line, kEventsAt)) return std::nullopt;
  do {
    std::size_t number = 0;
    if (!take_number(line, number)) return std::nullopt;
    chosen.events.push_back(number);
  } while (take_text(line, ","));
  return line.empty() ? std::optional(chosen) : std::nullopt;
}

}  // namespace simulation
