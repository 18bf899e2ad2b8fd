#include "sim_controller/drives.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sim {
namespace {

/// A path followed again has to begin this near to the arm, or the arm would jump.
constexpr double kJumpMaxRadians = 1e-9;
/// What is left of a move, in progress, that is not worth another tick.
constexpr double kProgressSmall = 1e-12;

calib::JointVector end_of(const Drives& drives) {
  if (drives.queue.empty()) return drives.joints;
  const Move& last = drives.queue.back();
  return posture(*last.path, last.to);
}

void push(const Plant& plant, Drives& drives, Stretch stretch, double tip_speed_m_s, bool ends_in_error) {
  const PathSlope slope = path_slope(plant, stretch);
  // A move without length takes its tick or two all the same.
  double top_rate = 1.0 / kTickSeconds;
  top_rate = std::min(top_rate, tip_speed_m_s / slope.tip_m);
  top_rate = std::min(top_rate, 1.0 / slope.joint_seconds);
  double acceleration = 1.0 / (kTickSeconds * kTickSeconds);
  acceleration = std::min(acceleration, kAccelerationMetresPerSecond2 / slope.tip_m);
  acceleration = std::min(acceleration, 1.0 / (slope.joint_seconds * kJointRampSeconds));
  drives.queue.push_back({std::make_shared<const Path>(std::move(stretch.path)), stretch.from, stretch.to,
                          top_rate, acceleration, ends_in_error});
}

void drop_queue(Drives& drives) {
  drives.queue.clear();
  drives.progress = 0.0;
  drives.rate = 0.0;
}

void finish_reset(Drives& drives) {
  drop_queue(drives);
  drives.braking = false;
  drives.moves_done = 0;
}

void finish_move(Drives& drives) {
  const bool failed = drives.queue.front().ends_in_error;
  drives.queue.pop_front();
  drives.progress = 0.0;
  drives.rate = 0.0;
  ++drives.moves_done;
  if (!failed) return;
  drives.error = kImpossibleMoveError;
  drop_queue(drives);
}

/// Deceleration of a stop: of a hold the move's own, of a reset a harder one.
double stop_deceleration(const Drives& drives) {
  const Move& move = drives.queue.front();
  if (!drives.braking) return move.acceleration;
  const double harder = kResetDecelerationMetresPerSecond2 / kAccelerationMetresPerSecond2;
  return std::max(harder * move.acceleration, move.top_rate / kResetSeconds);
}

/// The rate after a tick that does not end in standstill: as near to the wanted one as the ramps allow, and
/// no faster than what can still stop at the move's end.
double next_rate(const Drives& drives, double wanted_rate, double remaining) {
  const double dt = kTickSeconds;
  const double v = drives.rate;
  const double a = drives.queue.front().acceleration;
  const double ramped = std::clamp(wanted_rate, v - stop_deceleration(drives) * dt, v + a * dt);
  // (v + v1) dt / 2 + v1^2 / 2a = remaining, solved for v1.
  const double stoppable = a * (std::sqrt(dt * dt / 4.0 + (2.0 * remaining - v * dt) / a) - dt / 2.0);
  return std::max(0.0, std::min(ramped, stoppable));
}

}  // namespace

double TickMotion::along_path(double share) const {
  const double sum = rate_from + rate_to;
  if (sum <= 0.0) return path_to;
  const double u = std::clamp(share / moving_share, 0.0, 1.0);
  const double travelled = u * (2.0 * rate_from + (rate_to - rate_from) * u) / sum;
  return path_from + (path_to - path_from) * travelled;
}

calib::JointVector TickMotion::at(double share) const {
  return path ? posture(*path, along_path(share)) : to;
}

void movej(const Plant& plant, Drives& drives, const calib::JointVector& target, double tip_speed_m_s) {
  if (drives.braking) return;
  const calib::JointVector from = end_of(drives);
  const bool possible = plant.joint_ranges.contains(target);
  push(plant, drives, {{from, possible ? target : from}}, tip_speed_m_s, !possible);
}

void movel(const Plant& plant, Drives& drives, const calib::JointVector& target, double tip_speed_m_s) {
  if (drives.braking) return;
  StraightLine line = straight_line(plant, end_of(drives), target);
  push(plant, drives, {std::move(line.path)}, tip_speed_m_s, !line.complete);
}

void follow(const Plant& plant, Drives& drives, Stretch stretch, double tip_speed_m_s) {
  if (drives.braking) return;
  if ((stretch.at(0.0) - end_of(drives)).cwiseAbs().maxCoeff() > kJumpMaxRadians)
    throw std::logic_error("a path is to be followed that does not begin where the arm is");
  push(plant, drives, std::move(stretch), tip_speed_m_s, false);
}

void reset_motion(Drives& drives) {
  drives.error = 0;
  drives.braking = true;
  if (drives.rate == 0.0) finish_reset(drives);
}

TickMotion tick(Drives& drives, double monitor_speed_percent, bool permitted) {
  const bool goes_on = permitted && monitor_speed_percent > 0.0 && !drives.braking;
  TickMotion motion{.from = drives.joints, .to = drives.joints};
  if (drives.queue.empty() || (drives.rate == 0.0 && !goes_on)) {
    drives.standing_ticks = std::min(drives.standing_ticks + 1, kSettledTicks);
    return motion;
  }

  const Move& move = drives.queue.front();
  const double remaining = 1.0 - drives.progress;
  const double stop_s = drives.rate / stop_deceleration(drives);
  const double slowing = drives.rate * kTickSeconds / 2.0;  // way of a whole tick that ends in standstill
  bool arrives = false;
  motion.rate_from = drives.rate;
  if (!goes_on && stop_s <= kTickSeconds) {
    motion.moving_share = stop_s / kTickSeconds;
  } else if (remaining <= slowing + kProgressSmall) {
    arrives = true;
    if (slowing > 0.0) motion.moving_share = std::min(1.0, remaining / slowing);
  } else {
    motion.rate_to =
        next_rate(drives, goes_on ? move.top_rate * monitor_speed_percent / 100.0 : 0.0, remaining);
  }
  const double way = (motion.rate_from + motion.rate_to) / 2.0 * motion.moving_share * kTickSeconds;

  motion.path = move.path;
  motion.path_from = move.along_path(drives.progress);
  drives.progress = arrives ? 1.0 : std::min(1.0, drives.progress + way);
  drives.rate = motion.rate_to;
  drives.standing_ticks = 0;
  motion.path_to = move.along_path(drives.progress);
  motion.to = posture(*move.path, motion.path_to);
  drives.joints = motion.to;

  if (drives.braking && drives.rate == 0.0) {
    finish_reset(drives);
  } else if (arrives) {
    finish_move(drives);
  }
  return motion;
}

double move_id(const Drives& drives) { return drives.moves_done + drives.progress; }

bool is_empty(const Drives& drives) { return drives.queue.empty() || drives.braking; }

bool is_settled(const Drives& drives) { return drives.standing_ticks >= kSettledTicks; }

}  // namespace sim
