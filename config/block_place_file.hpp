#pragma once

#include "config/block_place.hpp"
#include "config/json_value.hpp"

namespace cell {

/// "place": "known" or "estimated", of a face or a place. ConfigError for another word.
bool is_estimated_place(const JsonObject& object);

/// One entry of a block's "places". ConfigError.
BlockPlace block_place_from_json(const JsonValue& value);

}  // namespace cell
