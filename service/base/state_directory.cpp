#include "service/base/state_directory.hpp"

#include <cstdlib>

namespace cell {

std::filesystem::path default_state_directory() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    return std::filesystem::path(state) / "touchcal";
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home && *home ? home : "/var/lib") / ".local" / "state" / "touchcal";
}

}  // namespace cell
