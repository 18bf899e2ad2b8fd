#include "tests/val3/cabinet.hpp"

#include <algorithm>
#include <cmath>

namespace val3 {
namespace {

Joint between(const Joint& from, const Joint& to, double part) {
  Joint result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = from[i] + part * (to[i] - from[i]);
  return result;
}

}  // namespace

bool Socket::connect() {
  if (link != Link::kNone) return false;
  link = Link::kOpen;
  to_controller.clear();
  to_host.clear();
  ++connections;
  return true;
}

void Socket::close_by_host() {
  if (link == Link::kOpen) link = Link::kClosedByHost;
}

Joint Cabinet::last_queued() const { return queue_.empty() ? joints_deg : queue_.back().to; }

double Cabinet::queue_move(const Joint& to, const Mdesc& mdesc, const Eigen::Isometry3d& flange_from_tool) {
  const Joint from = last_queued();
  double duration_s = kTickSeconds;
  for (std::size_t i = 0; i < to.size(); ++i)
    duration_s =
        std::max(duration_s, std::abs(to[i] - from[i]) / (arm.speeds_deg_s()[i] * mdesc.vel / 100.0));
  const Eigen::Vector3d way_m = (arm.world_from_flange(to) * flange_from_tool).translation() -
                                (arm.world_from_flange(from) * flange_from_tool).translation();
  duration_s = std::max(duration_s, way_m.norm() * 1000.0 / mdesc.tvel);
  if (queue_.empty()) {
    from_ = joints_deg;
    progress_ = 0;
    move_id_ = moves_queued_;
    queued_by_ = caller;
  }
  queue_.push_back({to, duration_s});
  dropped_.reset();
  return ++moves_queued_;
}

void Cabinet::reset_motion() {
  if (!queue_.empty()) dropped_ = queue_.front();
  queue_.clear();
  stopped = false;
  moves_queued_ = 0;
  move_id_ = 0;
}

void Cabinet::arm_latch(const std::string& link) {
  armed_ = link;
  armed_input_ = inputs.at(link);
  latched.reset();
}

void Cabinet::advance_motion() {
  const bool moving = !queue_.empty() && can_move();
  const double goal = moving ? monitor_speed / 100.0 : 0.0;
  const double most = kStepSeconds / ramp_s;
  rate_ += std::clamp(goal - rate_, -most, most);
  if (rate_ < 1e-9) rate_ = 0;
  still_s_ = rate_ == 0 ? still_s_ + kStepSeconds : 0;
  if (rate_ == 0) {
    if (queue_.empty()) progress_ = 0;
    return;
  }
  const Move& move = queue_.empty() ? *dropped_ : queue_.front();
  progress_ = std::min(1.0, progress_ + rate_ * kStepSeconds / move.duration_s);
  joints_deg = between(from_, move.to, progress_);
  if (progress_ < 1.0) return;
  from_ = move.to;
  progress_ = 0;
  if (queue_.empty() || queue_.size() == 1) rate_ = 0;
  if (!queue_.empty()) {
    queue_.pop_front();
    ++move_id_;
  }
}

void Cabinet::step() {
  queued_by_ = nullptr;
  advance_motion();
  if (world) world(*this);
  if (armed_.empty()) return;
  const bool input = inputs.at(armed_);
  if (input && !armed_input_ && !latch_blind) {
    latched = joints_deg;
    armed_.clear();
  }
  armed_input_ = input;
}

}  // namespace val3
