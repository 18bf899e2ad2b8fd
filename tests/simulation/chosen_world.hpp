#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/simulation/world.hpp"

namespace simulation {

/// What is drawn from a seed counts on from it.
inline constexpr std::uint64_t kSeedMax = 1'000'000'000'000;

/// The seed does not draw so many events.
class UnknownEvent : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Which world is meant: that of a seed, or the same with some of its events only.
struct ChosenWorld {
  std::uint64_t seed = 0;
  std::vector<std::size_t> events;  // by their numbers, from 1; empty: all, 0: none

  /// The command that runs it, and the first line of its journal: "touchcal-sim --seed 7 --events 1,3".
  [[nodiscard]] std::string line() const;
  /// Throws UnknownEvent.
  [[nodiscard]] Scenario scenario() const;
};

/// Nothing where the line is none of ChosenWorld::line().
std::optional<ChosenWorld> chosen_by(std::string_view line);

}  // namespace simulation
