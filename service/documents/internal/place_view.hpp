#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "service/run/block_pose.hpp"

namespace cell {

/// `place` of the cell and of a run: located_at, shift_mm, turn_deg (rotation vector in R_-1 as the cell's
/// file has it) and their standard deviations; null if the block stands where the cell's file says.
nlohmann::ordered_json block_pose_json(const std::optional<BlockPose>& place);

}  // namespace cell
