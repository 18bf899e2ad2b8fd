#pragma once

#include <filesystem>
#include <string_view>

#include "config/cell.hpp"

namespace cell {

inline constexpr std::string_view kRecipeSchema = "touchcal/recipe/2";
inline constexpr std::string_view kFirstRecipeSchema = "touchcal/recipe/1";  // stiffness true or false

/// A recipe for an arm and a block. A plane that the block does not have is a ConfigError, as is a parameter
/// name that does not exist, or stiffness of an arm that says nothing of its masses.
Recipe read_recipe(const std::filesystem::path& file, const Arm& arm, const Block& block);

}  // namespace cell
