#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/simulation/record.hpp"

namespace simulation {

/// What every run keeps, whatever goes wrong. `broken`: what is wrong, with the times to look for in the
/// journal; nothing when it holds.
struct Invariant {
  std::string_view name;
  std::optional<std::string> (*broken)(const Record& record);
};

/// All of them; here only.
std::span<const Invariant> invariants();

/// A line each of those that do not hold: "NAME: what is wrong".
std::vector<std::string> broken_invariants(const Record& record);

}  // namespace simulation
