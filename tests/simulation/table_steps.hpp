#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/simulation/script.hpp"

namespace simulation {

/// A column of the fault table: a step of the protocol or a state, reached by what is seen.
struct TableStep {
  std::string_view name;
  std::vector<ScriptStep> script;  // its last sight is the step; what is done there comes before the mode

  /// What is seen when the step is struck.
  [[nodiscard]] const std::string& sight() const { return script.back().sight; }
};

std::span<const TableStep> table_steps();

}  // namespace simulation
