#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace cell {

/// The time that a text of RFC 3339 in UTC names, "2026-01-31T08:15:30.250Z", of the years 1970 to 2199; the
/// fraction may be left out, digits beyond milliseconds are not kept. Nothing when it is no such text.
std::optional<std::chrono::system_clock::time_point> time_from_utc(std::string_view text);

}  // namespace cell
