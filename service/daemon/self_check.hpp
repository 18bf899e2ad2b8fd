#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "service/daemon/daemon.hpp"

namespace cell {

/// What would keep a daemon with these options from starting: all of it at once, each in one line with what
/// to do. Changes nothing and leaves a daemon that runs alone.
struct SelfCheck {
  std::vector<std::string> bad_files;  // the cell and what it names
  std::vector<std::string> troubles;   // state directory, tokens, address
  std::string cell_name;               // empty when its file is bad
};
SelfCheck check_daemon(const std::filesystem::path& cell_file, const DaemonOptions& options);

}  // namespace cell
