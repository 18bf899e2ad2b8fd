#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace cell {

/// RFC 3339, UTC, milliseconds: "2026-01-31T08:15:30.250Z".
std::string format_utc(std::chrono::system_clock::time_point time);

/// Whether a time that format_utc() wrote has come; never for one that was not set. In one form and zone the
/// order of times is that of their texts.
bool has_come(const std::optional<std::string>& time, std::chrono::system_clock::time_point now);

}  // namespace cell
