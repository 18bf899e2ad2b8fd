#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "service/http/server/http_message.hpp"

namespace cell {

/// Splits the target of a request line into path and query. The query is percent-decoded; a plus sign stays
/// one. The path stays encoded, so that an encoded slash does not split a segment. Nothing when the target is
/// not an absolute path, is malformed (RFC 3986), or contains a control character, literal or encoded.
std::optional<std::pair<std::string, Query>> parse_target(std::string_view target);

/// One segment of such a path, percent-decoded.
std::string decode_segment(std::string_view segment);

}  // namespace cell
