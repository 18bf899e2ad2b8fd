#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "service/documents/conditions_document.hpp"
#include "service/run/block_pose.hpp"

namespace cell {

/// `place` of the cell and of a run: located_at, shift_mm, turn_deg (rotation vector in R_-1 as the cell's
/// file has it) and their standard deviations; nothing when the block stands where its file says.
std::optional<PlaceDocument> place_of(const std::optional<LocatedPlace>& place);

/// The same as JSON, a part of the cell's document.
nlohmann::ordered_json place_view(const std::optional<LocatedPlace>& place);

}  // namespace cell
