#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/run/fault_table.hpp"

namespace cell {

/// One thing that stands in the way of a start.
struct Unmet {
  std::string code;    // "not_powered"
  std::string detail;  // what to do
};

/// Why a command was not taken.
struct CommandRefusal {
  enum class Kind { kState, kPreconditions, kUnknownRecipe, kNotThisRun, kOtherKey };
  Kind kind = Kind::kState;
  std::string detail;
  std::vector<Unmet> unmet;       // all of them at once
  std::optional<FaultCode> code;  // its entry in the fault table
};

}  // namespace cell
