#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cs8_protocol/messages.hpp"

namespace cell {

inline constexpr std::string_view kLocatingSchema = "touchcal/locating/1";

/// A touch by hand of the dialogue that finds the block, as it was taken.
struct LocatingTouch {
  cs8::JointsMicrodeg joints{};
  std::optional<double> moved_m;  // HandTouch::moved_m
  std::string touched_at;         // RFC 3339
};

/// A dialogue that is under way: its touches in the order in which they were asked for, and what they belong
/// to. With the same files of the cell and the same place before it, the same touches give the same place.
struct LocatingRecord {
  std::optional<std::string> config_digest;  // configuration_digest() of the cell
  std::optional<std::string> from_place;     // BlockPose::located_at of the place before; empty: the file's
  std::vector<LocatingTouch> touches;
};

/// Durable on return, all or nothing. Throws std::runtime_error.
void write_locating(const std::filesystem::path& file, const LocatingRecord& record);
/// Nothing if there is no such file. Throws ConfigError if it is invalid or was changed by anything but
/// write_locating().
std::optional<LocatingRecord> read_locating(const std::filesystem::path& file);

}  // namespace cell
