#pragma once

#include <filesystem>
#include <string_view>

#include "config/recipe.hpp"

namespace cell {

inline constexpr std::string_view kRecipeSchema = "touchcal/recipe/1";

/// A recipe for a block of `face_count` faces; a plane that the block does not have is a ConfigError, as is a
/// parameter name that does not exist.
Recipe read_recipe(const std::filesystem::path& file, int face_count);

}  // namespace cell
