#pragma once

#include <Eigen/Geometry>

#include "config/cell.hpp"

namespace cell {

/// How far the block is moved from where the cell has it, in R_-1 as it is there; then turned about R_-1's
/// y axis. The arm and all else in the room stay.
struct BlockPlace {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

/// The cell with its block elsewhere. R_-1 moves with the block: faces and solids keep their coordinates, the
/// arm's frames 0 and 1, the keep-out boxes and the workspace box get others. The workspace box, when it is
/// no longer along the axes, becomes the smallest one along them that holds it; a keep-out box becomes pieces
/// that are such. `old_from_new`: R_-1 as it stands then, in R_-1 as the cell has it.
Cell with_block_moved(const Cell& cell, const Eigen::Isometry3d& old_from_new);
Cell with_block_at(const Cell& cell, const BlockPlace& place);

}  // namespace cell
