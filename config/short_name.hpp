#pragma once

#include <string>

#include "config/json_value.hpp"

namespace cell {

/// The name of a place or a tip, which is part of parameters' names, of commands and of messages: 1 to 32 of
/// the characters a to z, 0 to 9 and _. ConfigError for another, and for one that means something else in
/// other files.
std::string short_name(const JsonValue& value);

}  // namespace cell
