#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "sim_controller/run_socket.hpp"

namespace sim {

/// `cs8sim --run`: any VAL3 application on the simulated cell, without a host. As fast as it goes; with real
/// sockets by wall time.
struct RunCommand {
  std::string application;  // .pjx or its folder
  std::string script_file;  // may be empty: nothing is done to it
  std::string cell_file;    // arm and probe
  std::string truth_file;
  double seconds = 0.0;  // simulated; 0: to a second after the script's last line, or see below
  std::uint64_t seed = 1;
  std::vector<RunSocket> sockets;  // more of them stand in the script
  double speed = 1.0;              // with sockets, of motions: simulated seconds per wall second; kSpeedMax
};

/// Exit codes: nothing failed; a task ended with an error, a move could not be made, the arm hit something, a
/// period was too short, or an expectation of the script was not met; a socket is none of the application's;
/// the application, the script or the cell cannot be read or loaded; a socket cannot be had.
enum RunCode { kRanWell = 0, kRanWithFailures = 1, kWrongSocket = 2, kCannotRun = 3, kNoSocket = 4 };

/// Runs it and tells what happens, a line each with the simulated time. With real sockets and neither script
/// nor seconds it goes on until SIGINT or SIGTERM, which end any run with sockets. Throws cell::ConfigError.
int run_application(const RunCommand& command, std::ostream& out, std::ostream& error);

}  // namespace sim
