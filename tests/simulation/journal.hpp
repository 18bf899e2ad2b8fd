#pragma once

#include <string>
#include <string_view>

#include "tests/simulation/virtual_clock.hpp"

namespace simulation {

/// What happened in a world, a line each: when, who, what. The same seed of the same commit writes the same
/// bytes.
class Journal {
 public:
  explicit Journal(const VirtualClock& clock) : clock_(clock) {}

  void note(std::string_view who, std::string_view what);
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  const VirtualClock& clock_;
  std::string text_;
};

}  // namespace simulation
