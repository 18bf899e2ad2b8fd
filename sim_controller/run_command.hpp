#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace sim {

/// `cs8sim --run`: any VAL3 application on the simulated cell, without a host, as fast as it goes.
struct RunCommand {
  std::string application;  // .pjx or its folder
  std::string script_file;  // may be empty: nothing is done to it
  std::string cell_file;    // arm and probe
  std::string truth_file;
  double seconds = 0.0;  // simulated; 0: to a second behind the script's last line
  std::uint64_t seed = 1;
};

/// Exit codes: nothing failed; a task ended with an error, a period was too short, or an expectation of the
/// script was not met; the application, the script or the cell cannot be read or loaded.
enum RunCode { kRanWell = 0, kRanWithFailures = 1, kCannotRun = 3 };

/// Runs it and tells what happens, a line each with the simulated time. Throws cell::ConfigError.
int run_application(const RunCommand& command, std::ostream& out, std::ostream& error);

}  // namespace sim
