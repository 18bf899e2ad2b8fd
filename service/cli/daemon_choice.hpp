#pragma once

#include <CLI/App.hpp>
#include <string>

#include "service/base/state_directory.hpp"
#include "service/cli/api_client.hpp"

namespace cell {

/// The value of a variable of the environment, `otherwise` where it is not set or empty.
std::string environment_or(const char* name, const std::string& otherwise);

/// Which daemon a command of the command line talks to, and how: --daemon, --state, --ca, --token-in-clear
/// and what of them the environment says.
class DaemonChoice {
 public:
  void add_to(CLI::App& command);
  /// The client that a command which was parsed is for. Throws std::invalid_argument where there is no such
  /// state directory or no daemon can be meant.
  [[nodiscard]] ApiClient client(const CLI::App& command) const;

 private:
  // Not by CLI11's envname: with it the environment of one subcommand would override the flag of another.
  std::string url_ = environment_or("TOUCHCAL_DAEMON", "http://127.0.0.1:8080");
  std::string state_directory_ = environment_or("TOUCHCAL_STATE", default_state_directory().string());
  std::string ca_file_ = environment_or("TOUCHCAL_CA", "");
  bool token_in_clear_ = false;
};

}  // namespace cell
