#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "sim_controller/run_command.hpp"

namespace sim::testing {

/// What `cs8sim --run` answers and writes.
struct SmallRun {
  int code = 0;
  std::string out;
  std::string error;
};

/// An application on the demo cell, with a script beside its folder.
inline SmallRun run_small(const std::filesystem::path& application, const std::string& script,
                          double seconds = 0.0) {
  const std::string cell_folder = TOUCHCAL_SOURCE_DIR "/config/cells/demo/";
  const std::filesystem::path file = application.parent_path() / "script.txt";
  if (!script.empty()) std::ofstream(file) << script;
  std::ostringstream out;
  std::ostringstream error;
  RunCommand command;
  command.application = application.string();
  command.script_file = script.empty() ? "" : file.string();
  command.cell_file = cell_folder + "cell.json";
  command.truth_file = cell_folder + "truth.json";
  command.seconds = seconds;
  SmallRun ran;
  ran.code = run_application(command, out, error);
  ran.out = out.str();
  ran.error = error.str();
  return ran;
}

}  // namespace sim::testing
