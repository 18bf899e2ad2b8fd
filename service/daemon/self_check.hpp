#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "service/daemon/daemon.hpp"

namespace cell {

/// Everything that would keep a daemon with these options from starting, one line each with what to do.
/// Changes nothing and makes no file, also beside a running daemon.
struct SelfCheck {
  std::vector<std::string> bad_files;  // the cell file and those it names, the database, the block's place
  std::vector<std::string> troubles;   // state directory, tokens, address
  std::vector<std::string> remarks;    // damage or what could not be read: it keeps no daemon from starting
  std::string not_looked_at;           // of the database, in words; empty: all of it was
  std::string cell_name;               // empty if its file is invalid
};
SelfCheck check_daemon(const std::filesystem::path& cell_file, const DaemonOptions& options);

}  // namespace cell
