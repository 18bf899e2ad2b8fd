#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "sim_controller/val3/machine/system.hpp"

namespace val3 {

/// A line fails: its task stops there with this number.
struct RunFailure : std::runtime_error {
  RunFailure(RunError error_number, const std::string& text)
      : std::runtime_error(text), number(error_number) {}
  RunError number;
};

/// What help() says of a run-time error, in English; "unknown error" for a number that is none.
std::string_view run_error_text(int number);

/// Thrown out of an expression that has to wait: the line is carried out again at the task's next turn.
struct Wait {};

}  // namespace val3
