#pragma once

#include <stdexcept>
#include <string>

#include "sim_controller/val3/machine/system.hpp"

namespace val3 {

/// A line fails: its task stops there with this number.
struct RunFailure : std::runtime_error {
  RunFailure(RunError error_number, const std::string& text)
      : std::runtime_error(text), number(error_number) {}
  RunError number;
};

/// Thrown out of an expression that has to wait: the line is carried out again at the task's next turn.
struct Wait {};

}  // namespace val3
