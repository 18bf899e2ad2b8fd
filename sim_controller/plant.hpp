#pragma once

#include <string>

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

/// The simulated cell: what the controller believes (nominal) and what stands there (truth). SI, frames as in
/// calib_core.
struct Plant {
  std::string arm_name;
  calib::KinematicModel nominal;  // the controller moves with it
  calib::KinematicModel truth;    // where the arm really is; nothing but contact and collision looks at it
  calib::JointRanges joint_ranges;
  calib::JointVector joint_speeds_max;
  calib::JointVector start_joints;  // of the arm at the start, and after the operator freed it
  calib::CollisionScene scene;      // all bodies but the stylus ball: the ball may touch, the others collide
  double trip_distance_m = 0.0;     // of the ball's centre from the nearest obstacle: radius - pre-travel
                                    // along the stylus
  double overtravel_m = 0.0;        // what the stylus bends before it breaks
  double touch_noise_m = 0.0;       // one standard deviation of the trip distance in a search
  double stop_latency_s = kStopLatencySeconds;  // what it really takes; longer in tests of overtravel
  cell::Truth hidden;  // what differs from touch to touch or from tick to tick; the rest is in the above
};

/// The cell with everything that `truth` hides. ConfigError when the truth does not fit the cell.
Plant make_plant(const cell::Cell& cell, const cell::Truth& truth);
/// The cell with an arm that has `errors` on top of its nominal parameters, and nothing else.
Plant make_plant(const cell::Cell& cell, const calib::ErrorVector& errors);

/// Way from the edge to standstill at `speed_m_s`.
double stopping_distance_m(double speed_m_s, double latency_s);

/// The fastest search whose stopping distance is within half the probe's overtravel.
double search_speed_max_m_s(double overtravel_m);

}  // namespace sim
