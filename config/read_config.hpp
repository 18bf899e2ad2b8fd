#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "config/cell.hpp"
#include "config/config_error.hpp"
#include "config/stiffness_choice.hpp"

namespace cell {

inline constexpr std::string_view kCellSchema = "touchcal/cell/7";
inline constexpr std::string_view kSixthCellSchema = "touchcal/cell/6";   // without target_frames
inline constexpr std::string_view kFifthCellSchema = "touchcal/cell/5";   // without tips of tools
inline constexpr std::string_view kFourthCellSchema = "touchcal/cell/4";  // without limits of the probe
inline constexpr std::string_view kThirdCellSchema = "touchcal/cell/3";   // without serial numbers
inline constexpr std::string_view kSecondCellSchema = "touchcal/cell/2";  // without tip_box_max_by_recipe_mm
inline constexpr std::string_view kFirstCellSchema =
    "touchcal/cell/1";  // without block_temperature_age_max_h

/// While this folder is beside a cell's file a change of its files by touchcal setup is not complete, and
/// what stands there may be of two cells: it is not read.
inline constexpr const char* kBrokenChangeFolder = ".setup-change";

/// The cell and the arm, block, probe and recipes that it names (paths are relative to the cell file). Throws
/// ConfigError with file, JSON pointer and remedy. The shapes of the files: config/FILES.md. `stiffness`: in
/// place of what each recipe says of it.
Cell read_cell(const std::filesystem::path& file, std::optional<StiffnessChoice> stiffness = {});

}  // namespace cell
