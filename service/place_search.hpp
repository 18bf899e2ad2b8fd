#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"
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

struct PlaceRange {
  BlockPlace min, max;
};

/// What a plan there is predicted to give, over the workspace box and the joint ranges as they are in the
/// room: the same for all places.
struct PlaceFigures {
  std::optional<double> workspace_box_rms_m;
  std::optional<double> joint_ranges_rms_m;
  double condition_number = 0.0;
  double duration_s = 0.0;
  int touch_count = 0;
};

struct PlaceFinding {
  BlockPlace place;
  bool present = false;                 // where the block is now
  bool fully_planned = false;           // else from few candidates: a little worse than it could be
  std::optional<PlaceFigures> figures;  // nothing when there is no plan
  std::string reason;                   // why not
};

struct PlaceSearchOptions {
  int place_count = 24;  // spread evenly over the range, besides the present one
  int full_count = 3;    // of them, the best, with all candidates
  int coarse_candidate_count = 2'000;
};

/// Tries places and ranks them by the predicted tip error over the recipe's region; those without a plan come
/// last.
std::vector<PlaceFinding> search_places(const Cell& cell, const Recipe& recipe, const PlaceRange& range,
                                        const PlaceSearchOptions& options,
                                        const calib::PlanningProgress& progress = {});

}  // namespace cell
