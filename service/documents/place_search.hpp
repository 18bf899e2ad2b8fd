#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "service/run/moved_cell.hpp"

namespace cell {

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
