#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace cell {

/// What the database holds is not what was written. Nothing computed from it may be told or moved by. The
/// message names the file, the place in it (table, run, number) and what to do.
class DamagedStore : public std::runtime_error {
 public:
  /// `where`: "table touches, run 3, number 12"; `what`: in which way.
  DamagedStore(const std::filesystem::path& file, const std::string& where, const std::string& what)
      : std::runtime_error(file.string() + ": " + where + ": " + what +
                           "; stop the daemon and restore the last backup (touchcald --verify lists all "
                           "damage)") {}
};

}  // namespace cell
