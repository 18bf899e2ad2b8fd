#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/simulation/world.hpp"

namespace simulation {

/// A broken world made small.
struct Shrunk {
  std::vector<std::size_t> kept;  // places among the faults that were given, in their order
  Outcome outcome;                // of the world in which only these happen
  int worlds_count = 0;           // that were run to find it
};

/// The same scenario with these of its faults only; each must be a place among them.
Scenario with_only(const Scenario& scenario, const std::vector<std::size_t>& places);

/// Fewer faults that break the same invariant, the first of `broken`, where there must be one: the shortest
/// beginning of them that does, and of that so few that none can be left out. `broken`: the outcome of
/// `scenario`.
Shrunk shrink(const Scenario& scenario, const Outcome& broken);

/// What a person needs of a broken world: the journal of the small one, what is broken, which events are left
/// and how to repeat them.
std::string broken_report(const Scenario& scenario, const Outcome& broken);

}  // namespace simulation
