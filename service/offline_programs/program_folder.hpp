#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "service/offline_programs/program_warnings.hpp"

namespace cell {

/// What stands beside a data file: the programs that use it, and the unit of its lengths.
struct ProgramFolder {
  std::vector<ProgramFile> programs;  // by name
  double mm_per_unit = 1.0;           // 25.4 where the project says that it counts in inches
  std::vector<std::string> notes;     // what is not there or cannot be read
};

/// More programs than that no application has.
inline constexpr std::size_t kProgramFilesMax = 20'000;
inline constexpr std::size_t kProgramBytesMax = 64U << 20U;  // of all of them

/// Reads the .pgx and the .pjx files in the folder of `data_file`, letter case aside, not those in folders
/// below. Throws ConfigError: projects in different units, a project that says of its unit what is neither
/// true nor false, more than kProgramFilesMax files or kProgramBytesMax bytes.
ProgramFolder read_program_folder(const std::filesystem::path& data_file);

/// Of a .pjx; millimetres where it does not say.
double mm_per_unit_of_project(const XmlText& project);

}  // namespace cell
