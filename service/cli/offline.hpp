#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"
#include "service/base/exit_code.hpp"

/// What the commands that need no daemon have in common.
namespace cell {

/// The cell's default recipe when `name` is empty. ConfigError when the cell has no such recipe.
const Recipe& recipe_named(const Cell& cell, const std::string& name);

/// Tells on standard error, in one line, why touches did not give a result; the exit code that goes with it.
ExitCode tell_refusal(const std::filesystem::path& touches_file, const calib::IdentificationResult& result);

void tell_warnings(const std::vector<std::string>& warnings);

/// Writes a whole file or nothing; "-" is standard output. std::invalid_argument when the file is there and
/// may not be overwritten, std::runtime_error when it cannot be written.
void write_whole_file(const std::string& file, const std::string& text, bool overwrite);

/// Warns of what somebody who uses the exported arm has to know.
std::vector<std::string> export_warnings(const std::vector<int>& cell_frames, bool accepted,
                                         const std::vector<std::string>& reasons);

}  // namespace cell
