#pragma once

#include <cstdint>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "sim_controller/plant.hpp"

namespace sim {

/// Joint vectors joined by straight joint moves, evenly spaced in progress 0 to 1; at least two.
using Path = std::vector<calib::JointVector>;

/// The posture at a progress from 0 to 1.
calib::JointVector posture(const Path& path, double progress);

/// A piece of a path, travelled from one progress to another; back when `to` is less than `from`.
struct Stretch {
  Path path;
  double from = 0.0;
  double to = 1.0;

  /// The posture after a share (0 to 1) of the stretch.
  [[nodiscard]] calib::JointVector at(double share) const { return posture(path, progress(share)); }
  [[nodiscard]] double progress(double share) const { return from + (to - from) * share; }
};

/// Number of the run-time error when a motion leaves the arm's reach or ranges.
inline constexpr std::int32_t kImpossibleMoveError = 150;

/// Spacing of the postures on a straight line; joint moves between them leave the line by 0.1 um at most.
inline constexpr double kLineSpacingMetres = 0.5e-3;

/// A straight line of the nominal tool centre.
struct StraightLine {
  Path path;
  double length_m = 0.0;  // of `path`
  bool complete = true;   // false: `path` ends where the arm cannot follow (range, reach, singular posture)
};

/// From one posture's nominal tool pose to the other's; the orientation turns evenly between both ends.
StraightLine straight_line(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to);

/// How far the nominal tool centre is between two postures.
double tip_distance_m(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to);

/// The steepest place of a stretch, per unit of its share.
struct PathSlope {
  double tip_m = 0.0;          // way of the nominal tool centre
  double joint_seconds = 0.0;  // what the slowest joint would need at its full speed
};

PathSlope path_slope(const Plant& plant, const Stretch& stretch);

/// Bound on the way of any point of the arm, out to the stylus ball and the bodies around it, on a straight
/// joint move between two postures; of either model.
double sweep_bound_m(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to);

}  // namespace sim
