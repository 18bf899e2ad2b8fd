#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "service/documents/conditions_document.hpp"
#include "service/run/block_pose.hpp"

namespace cell {

/// `place` of the cell and of a run: located_at, shift_mm, turn_deg (rotation vector in R_-1 as the cell's
/// file has it) and their standard deviations; absent if the block stands where the cell's file says.
std::optional<PlaceDocument> block_pose_of(const std::optional<BlockPose>& place);

/// The same as JSON, a part of the cell's document.
nlohmann::ordered_json block_pose_json(const std::optional<BlockPose>& place);

}  // namespace cell
