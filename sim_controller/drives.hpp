#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "calib_core/geometry/joint_vector.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/planned_move.hpp"
#include "sim_controller/plant.hpp"

namespace sim {

/// The arm counts as settled after so many ticks at standstill: 50 ms (manual 6, page 161). Its following
/// error is taken as below 1 % of the allowed one at standstill and nowhere else.
inline constexpr int kSettledTicks = 13;
/// The tool's speed may leave the commanded one by this share, from joint moves between a line's knots.
inline constexpr double kToolSpeedErrorMax = 2e-3;
/// An arm that stands within this of where its path was left gets back by itself in remote mode; farther away
/// somebody has to agree (manual 6, page 161). The tolerance of a CS8 is not known.
inline constexpr double kDriftRadians = 2e-3;

/// The motion side of a CS8: a value.
struct Drives {
  calib::JointVector joints = calib::JointVector::Zero();  // commanded: what herej() gives
  std::deque<Move> queue;                                  // the first is being travelled
  double progress = 0.0;                                   // of the first move
  double rate = 0.0;                                       // of its progress, 1/s
  bool braking = false;                                    // a reset; the queue is dropped at standstill
  std::deque<Move> after_reset;                            // ... and these are the queue then
  bool stopped = false;                                    // by stop_move()
  std::int32_t error = 0;  // run-time error that stopped the last move; until reset_motion()
  std::string error_why;   // of an impossible move, as it was stored
  int standing_ticks = kSettledTicks;
  // Where a path was left, and how the arm gets back there.
  double left_at = 0.0;                         // progress of the move behind a connection move
  std::optional<calib::JointVector> begins_at;  // of the next move to be stored; else where the queue ends
  bool auto_connect = false;                    // connects from anywhere
  bool connect_agreed = false;                  // somebody lets it connect, once
  // Numbers of moves.
  double last_id = 0.0;   // of the last stored one
  double ended_id = 0.0;  // what getMoveId reads while nothing is stored
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

// ---- what the VAL3 runtime stores ----

/// Where the next move begins: at the end of what is stored; behind a reset, where the arm will stand.
calib::JointVector end_of_queue(const Drives& drives);
/// Stores a move that begins there, behind a reset too. Returns its number.
double store(Drives& drives, Move move);
/// The next move gets the number behind this one.
void set_move_id(Drives& drives, double id);

// ---- what the C++ twin queues ----

/// Queue a motion from the end of the queue; blend off. A speed is the cap of the nominal tool centre's, m/s,
/// above 0; joints keep their own. A target outside the joint ranges is not begun, a line the arm cannot
/// follow to its end is travelled as far as it can be; then `error` is set and the queue dropped. While a
/// reset brakes, new motions are swallowed: wait for is_settled().
void movej(const Plant& plant, Drives& drives, const calib::JointVector& target, double tip_speed_m_s);
/// Straight line of the nominal tool centre.
void movel(const Plant& plant, Drives& drives, const calib::JointVector& target, double tip_speed_m_s);
/// Over a path travelled before. Throws std::logic_error when the stretch does not begin where the queue
/// ends.
void follow(const Plant& plant, Drives& drives, Stretch stretch, double tip_speed_m_s);

// ---- both ----

/// resetMotion(): brakes along the path (begins with the next tick), then drops the queue and zeroes the move
/// id. Clears `error` and a stop. The next move begins at `start`, where it is given.
void reset_motion(Drives& drives, const std::optional<calib::JointVector>& start = std::nullopt);
/// The move under way cannot be completed: slows down on the path as a reset does, drops the queue and keeps
/// `error` until the next reset. Nothing where no move is under way.
void fail_motion(Drives& drives, std::int32_t error);
/// stopMove(): slows down on the path as the move does; the queue stays. Until restart_move() or a reset.
void stop_move(Drives& drives);
void restart_move(Drives& drives);
/// The arm is put elsewhere at standstill, by hand or by what it hit. The queue stays: a connection move goes
/// first.
void displace(Drives& drives, const calib::JointVector& joints);

/// One tick. Without permission (hold) the arm decelerates on its path and keeps the queue; with it, it goes
/// on. `is_slow`: no faster than manual mode allows.
TickMotion tick(Drives& drives, double monitor_speed_percent, bool permitted, bool is_slow = false);

/// getMoveId(): the number of the move that is travelled and its progress; behind the last one, the number
/// that follows.
double move_id(const Drives& drives);
/// isEmpty(): no motion is pending. True before the arm is settled, after a move's end and during a reset.
bool is_empty(const Drives& drives);
/// isSettled(): the arm stands. Still true for a tick after a motion is queued, and with a queue that is
/// held.
bool is_settled(const Drives& drives);
/// A connection move is travelled, or is wanted and nobody has agreed to it.
bool is_connecting(const Drives& drives);

}  // namespace sim
