#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "service/run/block_pose.hpp"

namespace cell {

inline constexpr std::string_view kBlockPoseSchema = "touchcal/place/1";

/// A file that anything but write_block_pose() has changed is refused, since the arm moves by it.
inline constexpr std::string_view kBlockPoseChecksum = "sha256";

/// One JSON document: schema, located_at, digest, shift_mm, turn_rad (rotation vector), std_shift_mm,
/// std_turn_rad, and the touches and covariance that restore the value.
std::string block_pose_document(const BlockPose& place);

/// Atomic, and durable on return. Throws std::runtime_error.
void write_block_pose(const std::filesystem::path& file, const BlockPose& place);
/// Nothing if there is no such file. Throws ConfigError if it is invalid.
std::optional<BlockPose> read_block_pose(const std::filesystem::path& file);

}  // namespace cell
