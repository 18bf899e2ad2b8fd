#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "service/http/server/http_message.hpp"

namespace cell {

/// A target as it stands in the request line, taken apart; nothing when it is not an absolute path.
std::optional<std::pair<std::string, Query>> parse_target(std::string_view target);

}  // namespace cell
