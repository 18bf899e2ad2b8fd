#pragma once

#include <Eigen/Geometry>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/touch_planning.hpp"

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

/// What kept a touch from being made.
struct Refusal {
  enum class Cause { kJointRanges, kSingular, kOutOfReach, kNearObstacle, kHitsItself, kNoWay };
  Cause cause = Cause::kJointRanges;
  std::size_t body = 0;   // of the scene, for the two that name one
  std::size_t other = 0;  // obstacle or body
  auto operator<=>(const Refusal&) const = default;
};

/// In a few words: "joint ranges", "the forearm is within 12 mm of the table".
std::string describe(const PlanningProblem& problem, const Refusal& refusal);

/// Makes the touches of one problem, which must outlive it. Holds what no touch changes.
class TouchMaker {
 public:
  explicit TouchMaker(const PlanningProblem& problem);

  /// The whole touch in one posture of the pose.
  ///
  /// The orientation is kept. The touch and the search are on a straight line along the normal, from
  /// `approach` to the search end; from `approach` a straight joint move leads to `clear`, which lies at
  /// least kSlowZoneMetres farther out and from there away from all that the probe would have in its slow
  /// zone. On the whole way, every 10 mm at most, the joints are in range (less one degree) and away from
  /// singular postures, and
  /// - everything keeps the nominal miss (and its own margin) to every obstacle, as the true arm may be that
  ///   far from the nominal one;
  /// - the probe's bodies need not keep it to the obstacles of TouchedFace::is_behind, as the contact ends
  /// the
  ///   search before the face: it is enough that each stays over the face's plane by kOrientationMiss times
  ///   its distance from the ball, which the ball's place does not change, and if it does not (beside an
  ///   edge), that it keeps the nominal miss;
  /// - behind the contact the obstacles of TouchedFace::is_behind do not count: the true ball is stopped
  /// before
  ///   any body gets nearer to them than at the contact.
  /// From `clear` a way leads to the park posture: see is_near_park.
  [[nodiscard]] std::variant<PlannedTouch, Refusal> make(const TouchedFace& around, const TouchPose& pose,
                                                         const JointVector& joints) const;

  [[nodiscard]] const InverseKinematics& inverse() const { return inverse_; }

 private:
  class LineOfTouch;

  const PlanningProblem& problem_;
  PreparedModel prepared_;
  InverseKinematics inverse_;
  JointRanges ranges_;
  CollisionScene travel_scene_;
  TransferSpace space_;
};

/// TouchMaker for a single touch; a text where it cannot be made.
std::variant<PlannedTouch, std::string> make_touch(const PlanningProblem& problem, const TouchedFace& around,
                                                   const TouchPose& pose, const JointVector& joints);

/// How far the true arm's tip may turn away from the nominal one, radians (Table III: 0.016).
inline constexpr double kOrientationMiss = 0.03;

/// A posture with faster joints than this, for any straight motion of the tip, is too near a singular one:
/// radians per metre.
inline constexpr double kJointRateMax = 12.0;

}  // namespace calib
