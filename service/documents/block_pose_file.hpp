#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "service/run/block_pose.hpp"

namespace cell {

inline constexpr std::string_view kPlaceSchema = "touchcal/place/1";

/// A file that was changed by other means than write_place() is refused: the arm goes by it.
inline constexpr std::string_view kPlaceChecksum = "sha256";

/// schema, located_at, digest, shift_mm, turn_rad (rotation vector), std_shift_mm, std_turn_rad, and what a
/// reader needs to make it again. One JSON document.
std::string place_document(const LocatedPlace& place);

/// Durable when it returns: the file is the old one or the new one at every instant. std::runtime_error.
void write_place(const std::filesystem::path& file, const LocatedPlace& place);
/// Nothing when there is no such file. ConfigError when it cannot be read as one.
std::optional<LocatedPlace> read_place(const std::filesystem::path& file);

}  // namespace cell
