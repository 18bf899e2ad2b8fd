#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "config/cell.hpp"

namespace cell {

/// Displacement of the block from its place in the cell, in R_-1 before the move: a translation, then a
/// rotation about the y axis of R_-1. The arm and the surroundings do not move.
struct BlockDisplacement {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

/// The cell with its block moved. R_-1 moves with the block: faces and solids keep their coordinates; the
/// arm's frames 0 and 1, the keep-out boxes and the workspace box change theirs. A rotated workspace box is
/// replaced by its axis-aligned bounding box, a rotated keep-out box by bounding boxes of its pieces.
/// `old_from_new`: R_-1 after the move, in R_-1 of the cell.
Cell with_block_moved(const Cell& cell, const Eigen::Isometry3d& old_from_new);
Cell with_block_displaced(const Cell& cell, const BlockDisplacement& place);
/// The boxes of the surroundings after the same move.
std::vector<calib::Box> boxes_after_move(const std::vector<calib::Box>& boxes,
                                         const Eigen::Isometry3d& old_from_new);

/// Away from the ground, a unit vector in R_-1.
Eigen::Vector3d up_in_block(const Cell& cell);

}  // namespace cell
