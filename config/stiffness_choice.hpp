#pragma once

#include <optional>
#include <string_view>

#include "config/cell.hpp"

namespace cell {

/// Whether the compliance of the joints is estimated; kAuto: where the arm's file allows it.
enum class StiffnessChoice { kOn, kOff, kAuto };

/// "on", "off" or "auto"; nothing for another text.
std::optional<StiffnessChoice> stiffness_choice_named(std::string_view name);

/// The name that stiffness_choice_named() takes.
std::string_view name_of(StiffnessChoice choice);

/// Whether the arm's file has masses and the standard deviation of a compliance of joints 1 to 3.
bool can_estimate_stiffness(const Arm& arm);

bool is_estimated(StiffnessChoice choice, const Arm& arm);

/// The recipe with this choice in place of its own. ConfigError at /arm of the cell's file when kOn asks for
/// what the arm's file does not allow.
Recipe with_stiffness(Recipe recipe, StiffnessChoice choice, const Cell& cell);

}  // namespace cell
