#pragma once

#include <functional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"

namespace calib {

/// What a way is judged by: whether a straight joint move is clear, and how long it takes.
struct WayJudge {
  std::function<bool(const JointVector& from, const JointVector& to)> is_clear;
  std::function<double(const JointVector& from, const JointVector& to)> seconds;
};

/// A shorter way with the same ends and no more postures: each one in between in turn is drawn towards the
/// straight move between its neighbours, as far as both its own moves stay clear, or left out where that move
/// is clear. Both ends belong to `way`, which must be clear; so is the one returned, and it takes no longer.
std::vector<JointVector> tighten_way(const WayJudge& judge, const std::vector<JointVector>& way);

}  // namespace calib
