#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/http/server/host_name.hpp"
#include "service/mqtt/mqtt_options.hpp"

namespace cell {

struct DaemonOptions {
  std::filesystem::path state_directory;
  Endpoint listen{"127.0.0.1", 8080};
  std::vector<HostName> host_names;       // accepted in Host, besides its address
  std::optional<Endpoint> controller;     // absent: the cell's
  std::optional<int> retain_days;         // absent: runs are kept for ever
  std::filesystem::path tls_certificate;  // PEM, followed by its chain; with tls_key: TLS
  std::filesystem::path tls_key;
  std::optional<MqttOptions> mqtt;     // absent: no broker is told
  std::optional<std::string> archive;  // absent: none; archive_from_url()
  bool trusts_loopback = true;         // reading over loopback needs no token
};

/// Longest time to keep runs: a hundred years.
inline constexpr int kRetainDaysMax = 36'500;

/// Serves one cell, on the address and on a Unix socket in the state directory, until SIGINT, SIGTERM or
/// SIGHUP, which stop a motion under way and leave a run on hold. Where the disk does not answer at the end,
/// the process ends with kExitFailed. Prints "listening on HOST:PORT" on standard output when ready.
/// Throws std::exception if it cannot start (address in use, state directory not writable).
void run_daemon(const Cell& cell, const DaemonOptions& options);

}  // namespace cell
