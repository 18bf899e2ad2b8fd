#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "calib_core/geometry/joint_vector.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"

namespace sim {

/// Period of motion and slow inputs on a CS8.
inline constexpr double kTickSeconds = 0.004;
/// A joint's ramp from standstill to its full speed.
inline constexpr double kJointRampSeconds = 0.4;
/// What reset_motion() brakes with: the tool centre at least this hard (joints harder by the same factor) ...
inline constexpr double kResetDecelerationMetresPerSecond2 = 2.0;
/// ... and harder where that would take longer than this from the move's top speed to standstill.
inline constexpr double kResetSeconds = 0.125;
/// The arm counts as settled after so many ticks at standstill.
inline constexpr int kSettledTicks = 3;
/// The tool's speed may leave the commanded one by this share, from joint moves between a line's knots.
inline constexpr double kToolSpeedErrorMax = 2e-3;

/// A queued motion: a trapezoid in progress (0 to 1, even along the stretch) that begins and ends at
/// standstill.
struct Move {
  std::shared_ptr<const Path> path;
  double from = 0.0;  // the stretch of the path that is travelled; back when `to` is less
  double to = 1.0;
  double top_rate = 0.0;       // progress per second, at monitor speed 100 %
  double acceleration = 0.0;   // progress per second^2; no monitor speed scales it
  bool ends_in_error = false;  // the arm cannot follow farther: kImpossibleMoveError when it is there

  /// Progress along the path after a share of the move.
  [[nodiscard]] double along_path(double progress) const { return from + (to - from) * progress; }
};

/// The motion side of a CS8: a value; to put the arm elsewhere at standstill (freed by hand,
/// held by its brakes after a collision) makes a new one, Drives{.joints = there}.
struct Drives {
  calib::JointVector joints = calib::JointVector::Zero();  // commanded: what herej() gives
  std::deque<Move> queue;                                  // the first is being travelled
  double progress = 0.0;                                   // of the first move
  double rate = 0.0;                                       // of its progress, 1/s
  bool braking = false;                                    // a reset; the queue is dropped at standstill
  std::int32_t error = 0;       // run-time error that stopped the last move; until reset_motion()
  std::int32_t moves_done = 0;  // since the last reset
  int standing_ticks = kSettledTicks;
};

/// Where the arm is during one tick.
struct TickMotion {
  calib::JointVector from;
  calib::JointVector to;
  std::shared_ptr<const Path> path;  // null when the arm stood; of the move travelled otherwise
  double path_from = 0.0;            // progress along `path` at the start of the tick
  double path_to = 0.0;              // ... and at its end: the way back is Stretch{*path, path_to, ...}
  double rate_from = 0.0;            // the move's rate at both ends of the motion
  double rate_to = 0.0;
  double moving_share = 1.0;  // of the tick; under 1 where a move ends inside it

  /// Progress along `path`, and the posture, after a share (0 to 1) of the tick.
  [[nodiscard]] double along_path(double share) const;
  [[nodiscard]] calib::JointVector at(double share) const;
};

/// Queue a motion from the end of the queue; blend off. A speed is the cap of the nominal tool centre's, m/s,
/// above 0; joints keep their own. What cannot be done (a target outside the joint ranges, a line the arm
/// cannot follow to its end) is travelled as far as it can be; then `error` is set and the queue dropped.
/// While a reset brakes, new motions are swallowed, as a CS8 does: wait for is_settled().
void movej(const Plant& plant, Drives& drives, const calib::JointVector& target, double tip_speed_m_s);
/// Straight line of the nominal tool centre.
void movel(const Plant& plant, Drives& drives, const calib::JointVector& target, double tip_speed_m_s);
/// Over a path travelled before. Throws std::logic_error when the stretch does not begin where the queue
/// ends.
void follow(const Plant& plant, Drives& drives, Stretch stretch, double tip_speed_m_s);

/// resetMotion(): brakes along the path (begins with the next tick), then drops the queue and zeroes the move
/// id. Clears `error`.
void reset_motion(Drives& drives);

/// One tick. Without permission (hold) the arm decelerates on its path and keeps the queue; with it, it goes
/// on.
TickMotion tick(Drives& drives, double monitor_speed_percent, bool permitted);

/// getMoveId(): moves done since the last reset and the progress of the present one.
double move_id(const Drives& drives);
/// isEmpty(): no motion is pending. True before the arm is settled, after a move's end and during a reset.
bool is_empty(const Drives& drives);
/// isSettled(): the arm stands. Still true for a tick after a motion is queued, and with a queue that is
/// held.
bool is_settled(const Drives& drives);

}  // namespace sim
