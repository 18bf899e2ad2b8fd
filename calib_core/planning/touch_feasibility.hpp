#pragma once

#include <Eigen/Geometry>
#include <compare>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/planning/touch_plan.hpp"
#include "calib_core/planning/touch_pose.hpp"

namespace calib {

/// Heights of a touch above its contact plane along the outward normal; metres.
struct TouchHeights {
  double approach_m = 0.0;
  double clear_m = 0.0;
  double search_end_m = 0.0;  // negative: end of a search without contact
};
TouchHeights touch_heights(double nominal_position_error_m, double standoff_min_m);
/// The largest nominal position error with which the search of a touch of a flat face is no longer than this.
double position_error_max_m(double search_length_m);

/// The face to touch and the obstacles around it.
struct TouchTarget {
  int face = 0;
  int solid = -1;               // the obstacle that the face is a side of, -1 for none
  std::vector<bool> is_behind;  // one per obstacle: the touched solid, and those entirely behind the
                                // plane of the face; of a sphere, behind that of its pole, of a
                                // bore, behind the plane that touches its wall
};
TouchTarget find_target(const PlanningProblem& problem, int face);

/// Why a touch is infeasible.
struct TouchInfeasibility {
  enum class Cause {
    kJointRanges,
    kSingular,
    kOutOfReach,
    kNearObstacle,
    kHitsItself,
    kSmallSphere,
    kNarrowBore,
    kShallowBore,
    kNoPath
  };
  Cause cause = Cause::kJointRanges;
  std::size_t body = 0;   // index into the scene; for kNearObstacle and kHitsItself
  std::size_t other = 0;  // obstacle or body
  auto operator<=>(const TouchInfeasibility&) const = default;
};

/// A short text: "joint ranges", "the forearm is within 12 mm of the table".
std::string describe(const PlanningProblem& problem, const TouchInfeasibility& infeasibility);

/// Computes the touches of one problem; keeps a reference to it.
class TouchMaker {
 public:
  explicit TouchMaker(const PlanningProblem& problem);

  /// The complete touch in one posture of the pose, or why it is infeasible.
  ///
  /// The orientation is constant. Approach, contact and search end lie on the normal of the face, of a sphere
  /// or bore on that at the contact, whose tangent plane is then the plane of the face. A straight
  /// joint move leads from `approach` to `clear`, which lies at least kSlowZoneMetres farther out, of a bore
  /// along its axis out of the mouth, moved away from everything that would be in the slow zone of the probe.
  /// At most every 10 mm on these lines the joints are within their limits (minus one degree) and not near a
  /// singular posture, and
  /// - every body keeps the nominal position error and its own margin to every obstacle, as the actual arm
  /// may be
  ///   that far from the nominal one;
  /// - exception before the contact: the probe need not keep it to the obstacles of TouchTarget::is_behind,
  /// as the
  ///   contact ends the search. It is enough that each of its bodies stays above the plane of the face by
  ///   kOrientationErrorMaxRadians times its distance from the ball; in a bore, off its wall all around by as
  ///   much, wherever the ball meets it. The approach itself keeps the position error to the wall;
  /// - exception after the contact: the obstacles of TouchTarget::is_behind are ignored, as the contact stops
  /// the
  ///   actual arm before any body gets closer to them.
  /// From `clear` a path leads to the park posture: see can_reach_park.
  [[nodiscard]] std::variant<PlannedTouch, TouchInfeasibility> make(const TouchTarget& target,
                                                                    const TouchPose& pose,
                                                                    const JointVector& joints) const;

  [[nodiscard]] const InverseKinematics& inverse() const { return inverse_; }

 private:
  class TouchLine;

  const PlanningProblem& problem_;
  PreparedModel prepared_;
  InverseKinematics inverse_;
  JointRanges ranges_;
  CollisionScene travel_scene_;
  TransferSpace space_;
};

/// TouchMaker for a single touch; a text when it is infeasible.
std::variant<PlannedTouch, std::string> make_touch(const PlanningProblem& problem, const TouchTarget& target,
                                                   const TouchPose& pose, const JointVector& joints);

/// A posture is too close to a singular one when some straight motion of the tip needs faster joints than
/// this: radians per metre.
inline constexpr double kJointRateMax = 12.0;

}  // namespace calib
