#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"

namespace cell {

struct DaemonOptions {
  std::filesystem::path state_directory;
  Endpoint listen{"127.0.0.1", 8080};
  std::vector<std::string> host_names;    // by which clients may call it, beside its address
  std::optional<Endpoint> controller;     // the cell's when absent
  std::optional<int> retain_days;         // how long runs are kept; for ever when absent
  std::filesystem::path tls_certificate;  // PEM, its chain behind it; with tls_key: TLS
  std::filesystem::path tls_key;
};

/// Serves one cell until SIGINT or SIGTERM; a running motion is stopped then. Prints "listening on HOST:PORT"
/// on standard output when ready. Throws std::exception when it cannot start (address taken, state not
/// writable).
void run_daemon(const Cell& cell, const DaemonOptions& options);

}  // namespace cell
