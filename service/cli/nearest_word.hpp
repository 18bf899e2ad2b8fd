#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cell {

/// The word that was probably meant: the one with the fewest letters that are missing, too many, wrong or
/// swapped with their neighbour; nothing where more than a third of the letters would be.
std::optional<std::string> nearest_word(std::string_view typed, std::span<const std::string> words);

}  // namespace cell
