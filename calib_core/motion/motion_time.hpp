#pragma once

#include <span>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// The speeds of a cell's arm that predicted times depend on.
struct MotionLimits {
  JointVector joint_speeds_max = JointVector::Ones();  // rad/s
  double travel_m_s = 0.25;                            // limits of the tool centre's speed
  double approach_m_s = 0.02;
  double search_m_s = 0.008;
  double second_m_s = 0.0;  // of the second, slow search; 0 for none
  double second_backoff_m = 0.0;
};

/// Values that the controller's application sets for every move (val3/, accel and decel): acceleration of the
/// tool centre, time for a joint to reach full speed, and settling time at the end of a move. The simulated
/// CS8 has the same values; a test compares them.
inline constexpr double kToolAccelerationMetresPerSecond2 = 0.5;
inline constexpr double kJointRampSeconds = 0.4;
inline constexpr double kSettlingSeconds = 0.052;
/// A search ends when the arm has settled and both probe inputs have been steady for this time
/// (cs8_protocol/PROTOCOL.md, section 6).
inline constexpr double kProbeSteadySeconds = 0.020;
/// From the probe's edge to the start of braking.
inline constexpr double kStopLatencySeconds = 0.008;

/// Stopping distance after a contact: v t + v^2 / 2a, t until braking starts.
constexpr double stop_distance_m(double speed_m_s) {
  return speed_m_s * kStopLatencySeconds + speed_m_s * speed_m_s / (2.0 * kToolAccelerationMetresPerSecond2);
}

/// Predicted time of a straight joint move from standstill to standstill: a trapezoidal profile with the tool
/// centre nowhere faster than `tool_m_s` and no joint faster than its limit. Without settling.
double move_time_s(const PreparedModel& model, const MotionLimits& limits, const JointVector& from,
                   const JointVector& to, double tool_m_s);

/// Predicted time of joint moves at travel speed through `postures`, starting at the first. The arm stops at
/// each (a CS8 with blending off) and settles at the last.
double path_time_s(const PreparedModel& model, const MotionLimits& limits,
                   std::span<const JointVector> postures);

/// The postures of a touch.
struct TouchPostures {
  JointVector clear;     // the touch begins and ends here
  JointVector approach;  // the search begins here
  JointVector contact;
};

/// Predicted time of a touch whose face is at its expected position: approach from `clear`, search, second
/// search if any, and back (cs8_protocol/PROTOCOL.md, section 6).
double touch_time_s(const PreparedModel& model, const MotionLimits& limits, const TouchPostures& touch);

}  // namespace calib
