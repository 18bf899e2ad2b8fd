#pragma once

#include <chrono>
#include <functional>

namespace cell {

/// The clocks to read: the machine's in the daemon, made-up ones in tests. Neither may be empty.
struct Clocks {
  std::function<std::chrono::system_clock::time_point()> system;  // of what is stored and shown
  std::function<std::chrono::steady_clock::time_point()> steady;  // of deadlines
};

}  // namespace cell
