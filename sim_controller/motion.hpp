#pragma once

#include <Eigen/Geometry>
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

/// ... and turn the tool between two postures by no more than this.
inline constexpr double kLineTurnRadians = 2e-3;

/// Why a way ends before its end.
enum class WayEnd {
  kAtTarget,
  kNoPosture,   // no posture near the one before brings the tool on
  kJointRange,  // it is outside the joint ranges
  kJump,        // it is one of another branch
  kNoCircle,    // of an arc: there is none through its points
};

/// A way of a tool's centre as postures of the nominal arm. A tool is given by its pose in the nominal arm's
/// frame 7, whose origin is the nominal tool centre.
struct ToolPath {
  Path path;
  double length_m = 0.0;  // of `path`
  bool complete = true;   // false: `path` ends where the arm cannot follow (range, reach, singular posture)
  WayEnd end = WayEnd::kAtTarget;
  double share = 1.0;                                         // of the way that `path` is
  Eigen::Isometry3d refused = Eigen::Isometry3d::Identity();  // frame 7 in R_-1, where kNoPosture
  calib::JointVector beyond = calib::JointVector::Zero();     // the joints that are refused otherwise
};

/// A straight line from one posture's nominal tool pose to the other's; the orientation turns evenly between
/// both ends.
ToolPath straight_line(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to);
/// A straight line of the tool to a pose in R_-1, in whatever posture the arm comes to there.
ToolPath line_to_pose(const Plant& plant, const calib::JointVector& from,
                      const Eigen::Isometry3d& block_from_target,
                      const Eigen::Isometry3d& tip_from_tool = Eigen::Isometry3d::Identity());
/// An arc through a pose to another, both of the tool in R_-1; the orientation turns evenly to the via pose
/// and on from there. Not complete, and without a way, when the three points give no circle or one of them is
/// half a turn or more from the start (manual of VAL3, version 6, pages 141 to 149).
ToolPath arc_to_pose(const Plant& plant, const calib::JointVector& from,
                     const Eigen::Isometry3d& block_from_via, const Eigen::Isometry3d& block_from_target,
                     const Eigen::Isometry3d& tip_from_tool = Eigen::Isometry3d::Identity());

/// How far the nominal tool centre is between two postures.
double tip_distance_m(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to);

/// The steepest place of a stretch, per unit of its share.
struct PathSlope {
  double tip_m = 0.0;          // way of the tool centre
  double turn_rad = 0.0;       // turn of the tool
  double joint_seconds = 0.0;  // what the slowest joint would need at its full speed
  double joint_rad = 0.0;      // turn of the joint that turns farthest
};

PathSlope path_slope(const Plant& plant, const Stretch& stretch,
                     const Eigen::Isometry3d& tip_from_tool = Eigen::Isometry3d::Identity());

/// Bound on the way of any point of the arm, out to the stylus ball and the bodies around it, on a straight
/// joint move between two postures; of either model.
double sweep_bound_m(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to);

}  // namespace sim
