#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "tests/simulation/faults.hpp"

namespace simulation {

/// What a mode needs at a step, else it cannot happen there.
enum class Needs {
  kNothing,
  kMessage,        // the message of its line is among the next ones of the step
  kMotionCommand,  // the controller carries out a motion
  kWrite,          // the daemon writes to its disk next
};

/// A row of the fault table.
struct TableMode {
  std::string_view group;  // "link"
  std::string_view name;
  std::vector<DrawnFault> faults;  // at once, in this order
  Needs needs = Needs::kNothing;
  std::string_view modes = {};  // of P01 to P42, separated by spaces
};

/// The first one is that nothing goes wrong.
std::span<const TableMode> table_modes();

/// The message type in a kMessage mode's line: "touch_result".
std::string_view message_of(const TableMode& mode);
/// "it takes a motion"; of a step where it cannot happen.
std::string_view reason_of(Needs needs);

}  // namespace simulation
