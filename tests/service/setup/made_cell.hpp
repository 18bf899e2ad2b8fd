#pragma once

#include <filesystem>

#include "service/setup/arm_source.hpp"
#include "service/setup/cell_files.hpp"
#include "tests/config/folder.hpp"

namespace cell {

inline SetupArm arm_to_set_up(const std::string& name) {
  return read_setup_arm({.file = name}, kSourceDir / "config");
}

inline CellFiles files_of(const SetupAnswers& answers) {
  return cell_files(answers, read_setup_arm(answers.arm, kSourceDir / "config"),
                    shipped_recipes(kSourceDir / "config"));
}

/// As the daemon reads it.
inline Cell made_cell(const SetupAnswers& answers) {
  return check_cell_files(files_of(answers), std::filesystem::temp_directory_path());
}

}  // namespace cell
