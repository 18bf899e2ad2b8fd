#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "service/cli/api_client.hpp"
#include "service/exit_code.hpp"

/// touchcal's commands. Each prints to standard output (with `json` one document and nothing else), tells
/// errors on standard error and returns the exit code.
namespace cell {

struct IdentifyArguments {
  std::filesystem::path cell_file;
  std::filesystem::path touches_file;
  std::string recipe;  // the cell's default when empty
};
ExitCode identify_command(const IdentifyArguments& arguments, bool json);

/// Starts a run and watches it to its end.
ExitCode run_command(const ApiClient& daemon, const std::string& recipe, bool json);
/// Watches the run under way.
ExitCode watch_command(const ApiClient& daemon, bool json);
ExitCode status_command(const ApiClient& daemon, bool json);
ExitCode runs_command(const ApiClient& daemon, bool json);
ExitCode show_command(const ApiClient& daemon, const std::string& run_id, bool json);

/// pause, resume, abort: of the active run. stop, acknowledge, clear, reset: of the cell.
ExitCode give_command(const ApiClient& daemon, const std::string& command, bool json);

/// Tells a problem document that the daemon answered; the exit code that goes with it.
ExitCode tell_problem(const ApiReply& reply, bool json);

}  // namespace cell
