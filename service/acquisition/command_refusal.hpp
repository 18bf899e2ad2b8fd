#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/run/fault_table.hpp"

namespace cell {

/// A precondition of a start that is not met.
struct Unmet {
  std::string code;    // "not_powered"
  std::string detail;  // what to do
};

/// Why a command was refused.
struct CommandRefusal {
  enum class Kind { kState, kPreconditions, kUnknownRecipe, kUnknownRun, kNotThisRun, kOtherKey };
  Kind kind = Kind::kState;
  std::string detail;
  std::vector<Unmet> unmet;       // all of them at once
  std::optional<FaultCode> code;  // its entry in the fault table
};

}  // namespace cell
