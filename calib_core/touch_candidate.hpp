#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/touch_planning.hpp"

namespace calib {

/// Numbers in [0, 1) that are the same on every machine; the distributions of <random> are not.
class UniformChance {
 public:
  explicit UniformChance(std::uint64_t seed) : generator_(seed) {}
  double operator()() { return static_cast<double>(generator_() >> 11) * 0x1.0p-53; }

 private:
  std::mt19937_64 generator_;
};

/// Where R_7 is when the ball touches a face, and the angle of its z axis to the face's inward normal.
struct TouchPose {
  Eigen::Isometry3d block_from_tip;
  double tilt_rad = 0.0;
};

/// A point on the face, at least the nominal miss inside its rectangle, a tilt from 0 to the cell's limit in
/// any direction and a turn about the stylus, all evenly spread. With a `rim_share` so many of the places are
/// as far out as they may be, along either edge, and so many of the tilts nearer to the limit: what tells
/// most is found there.
TouchPose sample_touch_pose(const PlanningProblem& problem, const Face& face, UniformChance& chance,
                            double rim_share = 0.0);

/// The heights of a touch over its contact plane, along the outward normal; metres.
struct TouchHeights {
  double approach_m = 0.0;
  double clear_m = 0.0;
  double search_end_m = 0.0;  // negative: where a search that meets nothing would end
};
TouchHeights touch_heights(double nominal_miss_m, double standoff_min_m);

/// The face to touch and what stands around it.
struct TouchedFace {
  int face = 0;
  int touched = -1;             // the obstacle whose side the face is, -1 for none
  std::vector<bool> is_behind;  // an obstacle that the touched solid keeps a search from: itself, and those
                                // wholly behind the face's plane
};
TouchedFace find_touched(const PlanningProblem& problem, int face);

/// The whole touch in one posture of the pose, or in a few words why it cannot be made.
///
/// The orientation is kept on a straight line along the normal, from `clear` to the search end; on it, every
/// 10 mm at most, the joints are in range (less one degree) and away from singular postures, and
/// - everything keeps the nominal miss (and its own margin) to every obstacle, as the true arm may be that
/// far
///   from the nominal one;
/// - the probe's bodies need not keep it to the obstacles of TouchedFace::is_behind, as the contact ends the
///   search before the face: it is enough that each stays over the face's plane by kOrientationMiss times its
///   distance from the ball, which the ball's place does not change, and if it does not (beside an edge),
///   that it keeps the nominal miss;
/// - behind the contact the obstacles of TouchedFace::is_behind do not count: the true ball is stopped before
///   any body gets nearer to them than at the contact.
std::variant<PlannedTouch, std::string> make_touch(const PlanningProblem& problem, const TouchedFace& around,
                                                   const TouchPose& pose, const JointVector& joints);

/// How far the true arm's tip may turn away from the nominal one, radians (Table III: 0.016).
inline constexpr double kOrientationMiss = 0.03;

/// A posture with faster joints than this, for any straight motion of the tip, is too near a singular one:
/// radians per metre.
inline constexpr double kJointRateMax = 12.0;

}  // namespace calib
