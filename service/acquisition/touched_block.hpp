#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/cell.hpp"
#include "service/acquisition/locating.hpp"
#include "service/run/block_pose.hpp"

namespace cell {

/// Where the touches of a dialogue have found the block, and the way around it.
struct FoundBlock {
  BlockPose place;  // `located_at` and `digest` are empty: it is not proven yet
  Cell cell;        // with the block there
  /// The postures of the pass around it; or why there are none, and what to do.
  std::variant<std::vector<calib::JointVector>, std::string> pass;
};

/// The touches of a dialogue and what they say. A value: a touch goes to a copy, on the thread of the
/// arithmetic, and the copy counts when it comes back.
struct TouchedBlock {
  Locating locating;
  std::optional<FoundBlock> found;  // while all touches are made and fit

  /// See Locating::take(); milliseconds behind the last touch. `configured`: the cell as its file has it;
  /// `before`: where its block was found last.
  void take(const HandTouch& touch, const Cell& configured, const std::optional<BlockPose>& before);
  void undo();
};

}  // namespace cell
