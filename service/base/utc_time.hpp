#pragma once

#include <chrono>
#include <string>

namespace cell {

/// RFC 3339, UTC, milliseconds: "2026-01-31T08:15:30.250Z".
std::string format_utc(std::chrono::system_clock::time_point time);

}  // namespace cell
