#pragma once

#include <filesystem>
#include <vector>

#include "tests/val3/program.hpp"

namespace val3 {

/// What was read, and what is wrong with it. An application with problems is not for running.
struct Loaded {
  Application application;
  std::vector<Problem> problems;
};

/// Reads an s7 project: NAME.pjx in a folder NAME and the .dtx and .pgx files that it lists. Beside what is
/// listed nothing may lie in the folder. `world` and `flange` are there without being declared.
Loaded load(const std::filesystem::path& project_file);

}  // namespace val3
