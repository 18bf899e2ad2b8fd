#include "service/base/state_directory.hpp"

#include <cstdlib>
#include <stdexcept>
#include <system_error>

namespace cell {

std::filesystem::path default_state_directory() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    return std::filesystem::path(state) / "touchcal";
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home && *home ? home : "/var/lib") / ".local" / "state" / "touchcal";
}

std::filesystem::path demand_state_directory(const std::filesystem::path& directory) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::path existing = fs::absolute(directory);
  while (!fs::exists(existing, ignored) && existing.has_relative_path()) existing = existing.parent_path();
  if (!fs::is_directory(existing, ignored)) {
    throw std::runtime_error("--state " + directory.string() + ": " + existing.string() +
                             " is not a directory; name another");
  }
  return existing;
}

}  // namespace cell
