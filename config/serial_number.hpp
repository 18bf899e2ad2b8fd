#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "config/json_value.hpp"

namespace cell {

/// Longest serial number in a file, in bytes of UTF-8: what fits a line of a report.
inline constexpr std::size_t kSerialNumberSizeMax = 64;

/// A serial number as its maker engraved it; nothing for no value. ConfigError for one that is longer than
/// kSerialNumberSizeMax or has a space at an end, which no eye sees and every comparison does.
std::optional<std::string> serial_number(const std::optional<JsonValue>& value);

}  // namespace cell
