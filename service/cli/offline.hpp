#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"
#include "service/base/exit_code.hpp"

/// Shared by the commands that need no daemon.
namespace cell {

/// The recipe of this name; the cell's default one if `name` is empty. Throws ConfigError if there is none.
const Recipe& recipe_named(const Cell& cell, const std::string& name);

/// Prints on standard error, in one line, why the touches give no result; returns the exit code.
ExitCode print_refusal(const std::filesystem::path& touches_file, const calib::IdentificationResult& result);

void print_warnings(const std::vector<std::string>& warnings);

/// Writes a whole file or nothing; "-" is standard output. Throws std::invalid_argument if the file exists
/// and must not be overwritten, std::runtime_error if it cannot be written.
void write_whole_file(const std::string& file, const std::string& text, bool overwrite);

/// Warnings for users of the exported arm.
std::vector<std::string> export_warnings(const std::vector<int>& cell_frames, bool accepted,
                                         const std::vector<std::string>& reasons);

}  // namespace cell
