#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/setup/answers.hpp"
#include "service/setup/arm_source.hpp"

namespace cell {

/// What stands in the directory of a cell, by the names of the files.
using CellFiles = std::map<std::string, std::string>;

inline constexpr const char* kSetupCellFile = "cell.json";
inline constexpr const char* kSetupAnswersFile = "setup.json";

/// The geometry of the answers: arm and probe, block, boxes, park posture; the rest is not filled in. A park
/// posture that is not given is searched.
Cell setup_scene(const SetupAnswers& answers, const SetupArm& arm);

/// The files of the cell: arm, block, probe, recipes and the cell itself, the answers, and a truth for the
/// simulator. `recipes`:
/// shipped_recipes(). Pure; whether the reader takes them: check_cell_files().
CellFiles cell_files(const SetupAnswers& answers, const SetupArm& arm,
                     const std::map<std::string, std::string>& recipes);

/// What is doubtful of a scene, a line each with the remedy: nothing of it keeps a daemon from starting, all
/// of it keeps a plan from being made.
std::vector<std::string> scene_remarks(const Cell& scene);

/// ConfigError of /park_joints_deg with the two bodies and the remedy where the arm is too near to something
/// in its park posture, so that no plan can be made. `answers`: of which the scene is.
void demand_clear_park(const SetupAnswers& answers, const Cell& scene);

/// Reads the files as the daemon does, from a new folder in `temporary`, which goes again. ConfigError whose
/// source is the name of the file.
Cell check_cell_files(const CellFiles& files, const std::filesystem::path& temporary);

}  // namespace cell
