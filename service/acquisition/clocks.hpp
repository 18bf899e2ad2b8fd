#pragma once

#include <chrono>
#include <functional>

namespace cell {

/// The time, handed in: the daemon gives the machine's clocks, a test gives made-up ones. Neither may be
/// empty.
struct Clocks {
  std::function<std::chrono::system_clock::time_point()> system;  // of what is stored and shown
  std::function<std::chrono::steady_clock::time_point()> steady;  // of deadlines
};

}  // namespace cell
