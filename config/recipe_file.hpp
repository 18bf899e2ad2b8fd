#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "config/cell.hpp"
#include "config/stiffness_choice.hpp"

namespace cell {

inline constexpr std::string_view kRecipeSchema = "touchcal/recipe/5";
inline constexpr std::string_view kFourthRecipeSchema = "touchcal/recipe/4";  // without tips
inline constexpr std::string_view kThirdRecipeSchema = "touchcal/recipe/3";   // without places
inline constexpr std::string_view kSecondRecipeSchema = "touchcal/recipe/2";  // without ripple
inline constexpr std::string_view kFirstRecipeSchema = "touchcal/recipe/1";   // stiffness true or false

/// A recipe for an arm, a block and a probe. A plane that the block does not have is a ConfigError, as is a
/// tip that the probe does not have, a parameter name that does not exist, or stiffness of an arm that says
/// nothing of its masses. `stiffness`: in place of what the file says of it, which must be a choice all the
/// same.
Recipe read_recipe(const std::filesystem::path& file, const Arm& arm, const Block& block, const Probe& probe,
                   std::optional<StiffnessChoice> stiffness = {});

}  // namespace cell
