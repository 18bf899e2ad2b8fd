#pragma once

#include <span>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// How fast a cell's arm moves: what a predicted time needs to know.
struct MotionLimits {
  JointVector joint_speeds_max = JointVector::Ones();  // rad/s
  double travel_m_s = 0.25;                            // caps of the tool centre's speed
  double approach_m_s = 0.02;
  double search_m_s = 0.008;
  double second_m_s = 0.0;  // of the second, slow touch; 0 for none
  double second_backoff_m = 0.0;
};

/// What the controller's application sets for every move (val3/, accel and decel), not the cell: the tool
/// centre's ramps, a joint's ramp from standstill to its full speed, and how long the arm stands before a
/// move counts as done. The simulated CS8 has the same; a test compares them.
inline constexpr double kToolAccelerationMetresPerSecond2 = 0.5;
inline constexpr double kJointRampSeconds = 0.4;
inline constexpr double kSettlingSeconds = 0.012;
/// From the probe's edge until the stop of a search is done: both probe inputs have to stand for so long
/// (cs8_protocol/PROTOCOL.md, section 6).
inline constexpr double kProbeSteadySeconds = 0.020;
/// From the probe's edge to the first braking.
inline constexpr double kStopLatencySeconds = 0.008;

/// How far an arm that a contact stops goes on: v t + v^2 / 2a, t until it begins to brake.
constexpr double stop_distance_m(double speed_m_s) {
  return speed_m_s * kStopLatencySeconds + speed_m_s * speed_m_s / (2.0 * kToolAccelerationMetresPerSecond2);
}

/// Predicted time of a straight joint move from standstill to standstill: a trapezoid in which the tool
/// centre is nowhere faster than `tool_m_s` and no joint faster than its own limit. Without settling.
double move_time_s(const PreparedModel& model, const MotionLimits& limits, const JointVector& from,
                   const JointVector& to, double tool_m_s);

/// Predicted time of joint moves at travel speed through `postures`, the first being where the arm stands.
/// The arm stops at each (a CS8 with blending off) and settles at the last.
double way_time_s(const PreparedModel& model, const MotionLimits& limits,
                  std::span<const JointVector> postures);

/// The postures of a touch.
struct TouchPostures {
  JointVector clear;     // begins and ends here
  JointVector approach;  // the search begins here
  JointVector contact;
};

/// Predicted time of a touch whose face is where it is expected: clear, approach, search, the second touch if
/// there is one, and back (cs8_protocol/PROTOCOL.md, section 6), to the touch's result.
double touch_time_s(const PreparedModel& model, const MotionLimits& limits, const TouchPostures& touch);

}  // namespace calib
