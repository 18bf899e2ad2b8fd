#pragma once

#include <functional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"

namespace calib {

/// The criteria of a path: whether a straight joint move is clear, and its time.
struct MoveCriteria {
  std::function<bool(const JointVector& from, const JointVector& to)> is_clear;
  std::function<double(const JointVector& from, const JointVector& to)> seconds;
};

/// Shortens a path: each intermediate posture in turn is left out when the straight move between its
/// neighbours is clear, else moved towards that move as far as both adjacent moves stay clear. `path`
/// includes both ends and must be clear. The result has the same ends, is clear and takes no longer.
std::vector<JointVector> shortcut_path(const MoveCriteria& criteria, const std::vector<JointVector>& path);

}  // namespace calib
