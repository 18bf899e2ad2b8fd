#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"
#include "service/base/exit_code.hpp"

/// Shared by the commands that need no daemon.
namespace cell {

struct CellArguments;

/// The cell of the command line, its block at the temperature that is given there. Throws ConfigError where a
/// file is wrong, or where the block's file does not say how it grows.
Cell given_cell(const CellArguments& given);

/// The recipe that the command line names, the cell's default one without a name, with the choice of
/// stiffness of the command line. Throws ConfigError if there is none, or if the arm cannot be taken so.
Recipe given_recipe(const Cell& cell, const CellArguments& given);

/// Prints on standard error, in one line, why the touches give no result; returns the exit code.
ExitCode print_refusal(const std::filesystem::path& touches_file, const calib::IdentificationResult& result);

void print_warnings(const std::vector<std::string>& warnings);

/// Prints a text as it is, which may be tens of megabytes: fmt::print() would copy it several times. Throws
/// std::system_error where standard output does not take it.
void print_whole(const std::string& text);

/// Writes a whole file or nothing; "-" is standard output. Throws std::invalid_argument if the file exists
/// and must not be overwritten, std::runtime_error if it cannot be written.
void write_whole_file(const std::string& file, const std::string& text, bool overwrite);

/// As write_whole_file() refuses before it writes: throws std::invalid_argument if one of the files exists
/// and must not be overwritten, or if more than one is standard output.
void demand_writable(const std::vector<std::string>& files, bool overwrite);

/// Warnings for users of the exported arm.
std::vector<std::string> export_warnings(const std::vector<int>& cell_frames, bool accepted,
                                         const std::vector<std::string>& reasons);

}  // namespace cell
