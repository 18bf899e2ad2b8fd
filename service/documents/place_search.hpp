#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "config/moved_cell.hpp"

namespace cell {

struct PlaceRange {
  BlockDisplacement min, max;
};

/// Predicted figures of a plan at a place. Workspace box and joint ranges are fixed in the room, the same for
/// all places.
struct PlaceFigures {
  std::optional<double> workspace_box_rms_m;
  std::optional<double> joint_ranges_rms_m;
  double condition_number = 0.0;
  double duration_s = 0.0;
  int touch_count = 0;
};

struct PlaceCandidate {
  BlockDisplacement place;
  bool present = false;                 // the present place
  bool fully_planned = false;           // else with few candidates: slightly worse
  std::optional<PlaceFigures> figures;  // absent if there is no plan
  std::string reason;                   // why not
};

struct PlaceSearchOptions {
  int place_count = 24;  // spread over the range, besides the present one
  int full_count = 3;    // the best of them are planned with all candidates
  int coarse_candidate_count = 2'000;
};

/// Plans at several places and ranks them by the predicted tip error over the recipe's region; places without
/// a plan come last.
std::vector<PlaceCandidate> search_places(const Cell& cell, const Recipe& recipe, const PlaceRange& range,
                                          const PlaceSearchOptions& options,
                                          const calib::PlanningProgress& progress = {});

}  // namespace cell
