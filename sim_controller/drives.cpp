#include "sim_controller/drives.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sim {
namespace {

/// A path followed again has to begin this near to the arm, or the arm would jump.
constexpr double kJumpMaxRadians = 1e-9;
/// An arm that stands this far from its path was displaced.
constexpr double kDisplacedRadians = 1e-7;
/// What is left of a move, in progress, that is not worth another tick.
constexpr double kProgressSmall = 1e-12;
constexpr double kFullSpeedPercent = 100.0;

calib::JointVector end_of(const Move& move) { return posture(*move.path, move.to); }

void drop_queue(Drives& drives) {
  drives.queue.clear();
  drives.progress = 0.0;
  drives.rate = 0.0;
  drives.left_at = 0.0;
}

void finish_reset(Drives& drives) {
  drop_queue(drives);
  drives.braking = false;
  drives.queue = std::exchange(drives.after_reset, {});
}

void fail(Drives& drives) {
  drives.error = kImpossibleMoveError;
  drives.error_why = drives.queue.front().why_impossible;
  drives.ended_id = drives.queue.front().id;
  drop_queue(drives);
}

void finish_move(Drives& drives) {
  const Move& ended = drives.queue.front();
  if (ended.ends_in_error) return fail(drives);
  const bool was_connection = ended.is_connection;
  if (!was_connection) drives.ended_id = ended.id + 1.0;
  drives.queue.pop_front();
  drives.progress = was_connection ? std::exchange(drives.left_at, 0.0) : 0.0;
  drives.rate = 0.0;
}

/// Deceleration of a stop: of a hold the move's own, of a reset a harder one.
double stop_deceleration(const Drives& drives) {
  const Move& move = drives.queue.front();
  return drives.braking ? move.reset_deceleration : move.deceleration;
}

/// The rate after a tick that does not end in standstill: as near to the wanted one as the ramps allow, and
/// no faster than what can still stop at the move's end.
double next_rate(const Drives& drives, double wanted_rate, double remaining) {
  const double dt = kTickSeconds;
  const double v = drives.rate;
  const double a = drives.queue.front().acceleration;
  const double ramped = std::clamp(wanted_rate, v - stop_deceleration(drives) * dt, v + a * dt);
  // (v + v1) dt / 2 + v1^2 / 2d = remaining, solved for v1.
  const double d = drives.queue.front().deceleration;
  const double stoppable = d * (std::sqrt(dt * dt / 4.0 + (2.0 * remaining - v * dt) / d) - dt / 2.0);
  return std::max(0.0, std::min(ramped, stoppable));
}

/// How far the arm stands from where its first move goes on; 0 while it is on its path.
double displacement_rad(const Drives& drives) {
  if (drives.queue.empty() || drives.rate != 0.0 || drives.braking) return 0.0;
  const Move& move = drives.queue.front();
  const double off_rad =
      (posture(*move.path, move.along_path(drives.progress)) - drives.joints).cwiseAbs().maxCoeff();
  return off_rad > kDisplacedRadians ? off_rad : 0.0;
}

/// Before the arm leaves standstill: an impossible move fails, a displaced arm gets its connection move
/// first. False when it stays where it is.
bool begin_motion(Drives& drives) {
  if (drives.queue.front().is_impossible) {
    fail(drives);
    return false;
  }
  const double off_rad = displacement_rad(drives);
  if (off_rad == 0.0) return true;
  if (off_rad > kDriftRadians && !drives.auto_connect && !drives.connect_agreed) return false;
  drives.connect_agreed = false;
  const Move& left = drives.queue.front();
  if (left.is_connection) {  // displaced once more on its way back
    drives.queue.pop_front();
  } else {
    drives.left_at = drives.progress;
  }
  const Move& next = drives.queue.front();
  drives.queue.push_front(
      connection_move(drives.joints, posture(*next.path, next.along_path(drives.left_at))));
  drives.progress = 0.0;
  return true;
}

/// Where braking ends: the same ticks, ahead of time.
calib::JointVector standstill_of(Drives ahead) {
  while (ahead.braking) tick(ahead, kFullSpeedPercent, true);
  return ahead.joints;
}

void queue_for_twin(const Plant& plant, Drives& drives, Stretch stretch, double tip_speed_m_s,
                    bool ends_in_error) {
  Move move = plan_move(plant, std::move(stretch), at_tip_speed(tip_speed_m_s));
  move.ends_in_error = ends_in_error;
  store(drives, std::move(move));
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

calib::JointVector end_of_queue(const Drives& drives) {
  const std::deque<Move>& stored = drives.braking ? drives.after_reset : drives.queue;
  if (!stored.empty()) return end_of(stored.back());
  if (drives.begins_at) return *drives.begins_at;
  return drives.braking ? standstill_of(drives) : drives.joints;
}

double store(Drives& drives, Move move) {
  move.id = ++drives.last_id;
  (drives.braking ? drives.after_reset : drives.queue).push_back(std::move(move));
  drives.begins_at.reset();
  return drives.last_id;
}

void set_move_id(Drives& drives, double id) { drives.last_id = id; }

void movej(const Plant& plant, Drives& drives, const calib::JointVector& target, double tip_speed_m_s) {
  if (drives.braking) return;
  const calib::JointVector from = end_of_queue(drives);
  if (!plant.joint_ranges.contains(target)) {
    store(drives, impossible_move(from));
  } else {
    queue_for_twin(plant, drives, {{from, target}}, tip_speed_m_s, false);
  }
}

void movel(const Plant& plant, Drives& drives, const calib::JointVector& target, double tip_speed_m_s) {
  if (drives.braking) return;
  ToolPath line = straight_line(plant, end_of_queue(drives), target);
  queue_for_twin(plant, drives, {std::move(line.path)}, tip_speed_m_s, !line.complete);
}

void follow(const Plant& plant, Drives& drives, Stretch stretch, double tip_speed_m_s) {
  if (drives.braking) return;
  if ((stretch.at(0.0) - end_of_queue(drives)).cwiseAbs().maxCoeff() > kJumpMaxRadians)
    throw std::logic_error("a path is to be followed that does not begin where the arm is");
  queue_for_twin(plant, drives, std::move(stretch), tip_speed_m_s, false);
}

void reset_motion(Drives& drives, const std::optional<calib::JointVector>& start) {
  drives.error = 0;
  drives.error_why.clear();
  drives.stopped = false;
  drives.last_id = 0.0;
  drives.ended_id = 0.0;
  drives.after_reset.clear();
  drives.begins_at = start;
  drives.braking = true;
  if (drives.rate == 0.0) finish_reset(drives);
}

void fail_motion(Drives& drives, std::int32_t error) {
  if (is_empty(drives)) return;
  reset_motion(drives);
  drives.error = error;
}

void stop_move(Drives& drives) { drives.stopped = true; }

void restart_move(Drives& drives) { drives.stopped = false; }

void displace(Drives& drives, const calib::JointVector& joints) {
  drives.joints = joints;
  drives.rate = 0.0;
  drives.standing_ticks = kSettledTicks;
  if (drives.braking) finish_reset(drives);
}

TickMotion tick(Drives& drives, double monitor_speed_percent, bool permitted, bool is_slow) {
  const bool may_go = permitted && !drives.stopped && monitor_speed_percent > 0.0 && !drives.braking;
  TickMotion motion{.from = drives.joints, .to = drives.joints};
  const bool stands = drives.queue.empty() || drives.rate == 0.0;
  if (drives.queue.empty() || (stands && !(may_go && begin_motion(drives)))) {
    drives.standing_ticks = std::min(drives.standing_ticks + 1, kSettledTicks);
    return motion;
  }

  const Move& move = drives.queue.front();
  const double remaining = 1.0 - drives.progress;
  const double stop_s = drives.rate / stop_deceleration(drives);
  const double slowing = drives.rate * kTickSeconds / 2.0;  // way of a whole tick that ends in standstill
  bool arrives = false;
  motion.rate_from = drives.rate;
  if (!may_go && stop_s <= kTickSeconds) {
    motion.moving_share = stop_s / kTickSeconds;
  } else if (remaining <= slowing + kProgressSmall) {
    arrives = true;
    if (slowing > 0.0) motion.moving_share = std::min(1.0, remaining / slowing);
  } else {
    const double full_rate = move.top_rate * monitor_speed_percent / kFullSpeedPercent;
    const double allowed_rate = is_slow ? std::min(full_rate, move.manual_rate) : full_rate;
    motion.rate_to = next_rate(drives, may_go ? allowed_rate : 0.0, remaining);
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

double move_id(const Drives& drives) {
  if (drives.queue.empty() || drives.braking) return drives.ended_id;
  const Move& first = drives.queue.front();
  if (!first.is_connection) return first.id + drives.progress;
  return drives.queue.size() > 1 ? drives.queue[1].id + drives.left_at : drives.ended_id;
}

bool is_empty(const Drives& drives) {
  return drives.braking ? drives.after_reset.empty() : drives.queue.empty();
}

bool is_settled(const Drives& drives) { return drives.standing_ticks >= kSettledTicks; }

bool is_connecting(const Drives& drives) {
  if (drives.queue.empty() || drives.braking) return false;
  return drives.queue.front().is_connection || displacement_rad(drives) > 0.0;
}

}  // namespace sim
