#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/setup/answers.hpp"

namespace cell {

/// An arm that a cell is to be made with.
struct SetupArm {
  Arm arm;
  /// R_1, where joint 1 is at 0, in what BasePlace places.
  Eigen::Isometry3d base_from_frame1 = Eigen::Isometry3d::Identity();
  bool is_made = false;              // of a URDF or a table, also by setup-arm; then R_7 is at its tip
  std::vector<std::string> remarks;  // what was assumed of it, a line each
};

/// The arm that was chosen. A file that is no path of its own is looked for in `arms` of the shipped
/// configuration; relative paths count from the working directory. ConfigError.
SetupArm read_setup_arm(const ArmChoice& choice, const std::filesystem::path& shipped_config);

/// Names of the shipped arms.
std::vector<std::string> shipped_arms(const std::filesystem::path& shipped_config);

/// The texts of kSetupRecipes by their names. ConfigError.
std::map<std::string, std::string> shipped_recipes(const std::filesystem::path& shipped_config);

/// The folder with `arms` and `recipes` that belongs to a program: of a build, beside an installed one, or
/// /etc/touchcal. ConfigError that names TOUCHCAL_CONFIG where there is none.
std::filesystem::path shipped_config_of(const std::filesystem::path& program, const char* environment);

}  // namespace cell
