#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "service/run/block_pose.hpp"

namespace cell {

/// `place` of the cell and of a run: located_at, shift_mm, turn_deg (rotation vector in R_-1 as the cell's
/// file has it) and their standard deviations; null when the block stands where its file says.
nlohmann::ordered_json place_view(const std::optional<LocatedPlace>& place);

}  // namespace cell
