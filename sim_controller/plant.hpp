#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"
#include "config/cell.hpp"
#include "config/truth.hpp"

namespace sim {

/// From the probe's edge to the first braking: what the controller promises, and what search limits are built
/// on.
inline constexpr double kStopLatencySeconds = 0.008;
/// Acceleration and deceleration of the tool centre.
inline constexpr double kAccelerationMetresPerSecond2 = 0.5;
/// Searches longer than this are refused.
inline constexpr double kSearchLengthMaxMetres = 0.06;

/// The ball of a further tip of a star stylus, which trips the probe as that of the first one does.
struct TipBall {
  Eigen::Vector3d center_m;      // in R_7 of the true arm
  double trip_distance_m = 0.0;  // as that of the first tip
};

/// The simulated cell: what the controller believes (nominal) and what stands there (truth). SI, frames as in
/// calib_core.
struct Plant {
  std::string arm_name;
  std::string arm_serial;  // of the cell's file; empty where it names none
  /// The controller moves with it, and knows nothing of the block: R_-1 is that of the block's first place.
  calib::KinematicModel nominal;
  /// Where the arm really is, in R_-1 where the block stands; nothing but contact and collision looks at it.
  calib::KinematicModel truth;
  calib::JointRanges joint_ranges;
  calib::JointVector joint_speeds_max;
  calib::JointVector start_joints;  // of the arm at the start, and after the operator freed it
  calib::CollisionScene scene;   // all bodies but the balls of the tips: balls may touch, the others collide
  double trip_distance_m = 0.0;  // of the ball's centre from the nearest obstacle: radius - pre-travel
                                 // along the stylus
  std::vector<TipBall> tips;     // of a star stylus, beside the first one, whose ball is the origin of R_7
  double overtravel_m = 0.0;     // what the stylus bends before it breaks
  double touch_noise_m = 0.0;    // one standard deviation of the trip distance in a search
  double stop_latency_s = kStopLatencySeconds;  // what it really takes; longer in tests of overtravel
  cell::Truth hidden;  // what differs from touch to touch or from tick to tick; the rest is in the above
};

/// The cell with everything that `truth` hides. ConfigError when the truth does not fit the cell.
Plant make_plant(const cell::Cell& cell, const cell::Truth& truth);
/// The cell with an arm that has `errors` on top of its nominal parameters, and nothing else.
Plant make_plant(const cell::Cell& cell, const calib::ErrorVector& errors);

/// By the name of the place, "first" with them.
using PlantByPlace = std::map<std::string, Plant, std::less<>>;

/// The cell with the block at each of its places, as far from where the block's file has them as the truth
/// says: what is on the block's first solid has moved with it, everything else stands where it did.
/// ConfigError as of make_plant(), and for a truth of places that the block does not have.
PlantByPlace make_plants(const cell::Cell& cell, const cell::Truth& truth);

/// Way from the edge to standstill at `speed_m_s`.
double stopping_distance_m(double speed_m_s, double latency_s);

/// The fastest search whose stopping distance is within half the probe's overtravel.
double search_speed_max_m_s(double overtravel_m);

}  // namespace sim
