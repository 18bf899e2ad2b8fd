#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "config/cell.hpp"

namespace cell {

/// Which of the block's solids go with it to another place: the first one and the balls on it; all of them
/// where the first face lies on none.
std::vector<bool> solids_that_move(const Block& block);

/// The cell while the block stands at a place of the recipe (config/touched_places.hpp), in R_-1 there: what
/// is on the block's first solid has moved with it, everything else stands where it did, and under a lifted
/// block is its stand. Kept out of is also where the block stood
/// before, unless that is so near that the touches need the room: somebody may say that he brought it and has
/// not. A stand that the block is not on is known by the cell's keep_out_boxes only.
Cell cell_at_place(const Cell& cell, const Recipe& recipe, int place);

/// The cell, whose block has come from `before_from_block`, with what stands under a block that was lifted:
/// nobody tells of the stand, so that all of the space under the block is kept out of.
Cell with_stand_under(const Cell& cell, const Eigen::Isometry3d& before_from_block);

}  // namespace cell
