#include "tests/val3/cabinet.hpp"

#include <algorithm>
#include <cmath>

#include "sim_controller/val3/machine/geometry.hpp"

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

std::optional<int> Cabinet::find_digital(std::string_view link) {
  if (!inputs.contains(link) && !outputs.contains(link)) return std::nullopt;
  signals_.emplace_back(link);
  return static_cast<int>(signals_.size()) - 1;
}

bool Cabinet::digital(int id) const {
  const std::string& link = signals_.at(static_cast<std::size_t>(id));
  const auto input = inputs.find(link);
  return input != inputs.end() ? input->second : outputs.at(link);
}

RunError Cabinet::set_digital(int id, bool on) {
  const std::string& link = signals_.at(static_cast<std::size_t>(id));
  if (inputs.contains(link)) return kErrorWriteToInput;
  outputs[link] = on;
  return kErrorNone;
}

std::optional<int> Cabinet::find_analogue(std::string_view link) {
  if (!analogues.contains(link)) return std::nullopt;
  signals_.emplace_back(link);
  return static_cast<int>(signals_.size()) - 1;
}

double Cabinet::analogue(int id) const { return analogues.at(signals_.at(static_cast<std::size_t>(id))); }

RunError Cabinet::set_analogue(int id, double value) {
  analogues.at(signals_.at(static_cast<std::size_t>(id))) = value;
  return kErrorNone;
}

std::optional<int> Cabinet::find_channel(std::string_view link) {
  sockets[std::string(link)];
  channels_.emplace_back(link);
  return static_cast<int>(channels_.size()) - 1;
}

const Socket& Cabinet::socket(int channel) const {
  return sockets.at(channels_.at(static_cast<std::size_t>(channel)));
}
Socket& Cabinet::socket(int channel) { return sockets.at(channels_.at(static_cast<std::size_t>(channel))); }

bool Cabinet::connect(int channel) { return socket(channel).link == Socket::Link::kOpen; }

std::size_t Cabinet::waiting(int channel) const { return socket(channel).to_controller.size(); }

std::size_t Cabinet::receive(int channel, std::span<std::uint8_t> bytes) {
  auto& from = socket(channel).to_controller;
  const std::size_t count = std::min(bytes.size(), from.size());
  std::copy_n(from.begin(), count, bytes.begin());
  from.erase(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

std::size_t Cabinet::send(int channel, std::span<const std::uint8_t> bytes) {
  Socket& to = socket(channel);
  const std::size_t count = std::min(bytes.size(), to.room);
  if (to.room != SIZE_MAX) to.room -= count;
  to.to_host.insert(to.to_host.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

bool Cabinet::close(int channel) {
  Socket& closed = socket(channel);
  closed.to_controller.clear();
  if (closed.link == Socket::Link::kClosedByHost || clear_buffer_closes) closed.link = Socket::Link::kNone;
  return true;
}

int Cabinet::set_channel(int channel, std::string_view name, std::optional<double> number,
                         std::optional<bool> truth, const std::string*) {
  if (const auto refuses = socket_refuses.find(name); refuses != socket_refuses.end())
    return static_cast<int>(refuses->second);
  Socket& set = socket(channel);
  if (set.link == Socket::Link::kOpen) return -4;  // busy
  constexpr int kWrongType = -2;
  if (name == "nagle") {
    if (!truth) return kWrongType;
    set.nagle = *truth;
    return 0;
  }
  if (name != "timeout" && name != "clients") return -1;
  if (!number) return kWrongType;
  (name == "timeout" ? set.timeout_s : set.clients) = *number;
  return 0;
}

Trsf Cabinet::flange_at(const Joint& joints) const {
  return scaled(trsf_of(arm.world_from_flange(joints)), 1000.0);
}

std::optional<Joint> Cabinet::solve(const Trsf& flange, const Config&, const Joint& near) const {
  return arm.solve(isometry(scaled(flange, 0.001)), near);
}

RunError Cabinet::store(const MoveOrder& order) {
  if (moves_until_error && (*moves_until_error)-- == 0) {
    moves_until_error.reset();
    return kErrorImpossibleMove;
  }
  if (!order.reachable || !arm.in_range(order.to)) return kErrorImpossibleMove;
  const Joint from = last_stored();
  double duration_s = kTickSeconds;
  for (std::size_t i = 0; i < order.to.size(); ++i)
    duration_s = std::max(
        duration_s, std::abs(order.to[i] - from[i]) / (arm.speeds_deg_s()[i] * order.descriptor.vel / 100.0));
  const double way_mm =
      distance(composed(flange_at(order.to), order.tool), composed(flange_at(from), order.tool));
  duration_s = std::max(duration_s, way_mm / order.descriptor.tvel);
  if (queue_.empty()) {
    from_ = joints_deg;
    progress_ = 0;
    move_id_ = moves_queued_;
    queued_in_this_tick_ = true;
  }
  queue_.push_back({order.to, duration_s});
  dropped_.reset();
  ++moves_queued_;
  return kErrorNone;
}

void Cabinet::reset_motion(const std::optional<Joint>&) {
  if (!queue_.empty()) dropped_ = queue_.front();
  queue_.clear();
  stopped = false;
  moves_queued_ = 0;
  move_id_ = 0;
}

RunError Cabinet::arm_latch(int digital) {
  const std::string& link = signals_.at(static_cast<std::size_t>(digital));
  if (!latch_inputs.contains(link)) return kErrorParameter;
  armed_ = link;
  armed_input_ = inputs.at(link);
  latched_joints.reset();
  return kErrorNone;
}

int Cabinet::mode_status() const {
  constexpr int kHoldInLocalAndRemote = 2;
  return held ? kHoldInLocalAndRemote : 0;
}

void Cabinet::enable_power() {
  if (mode == 4 && es_status == 0) powered = true;
}

std::string Cabinet::version(std::string_view item) const {
  if (item == "ArmType") return arm_type;
  if (item == "ArmSN") return "F09_9EF3A1_A_01";
  return item == "VAL3" || item == "System" ? val3_version : "";
}

void Cabinet::advance_motion() {
  const bool moving = !queue_.empty() && can_move();
  const double goal = moving ? monitor_speed_percent / 100.0 : 0.0;
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
  queued_in_this_tick_ = false;
  advance_motion();
  if (world) world(*this);
  if (armed_.empty()) return;
  const bool input = inputs.at(armed_);
  if (input && !armed_input_ && !latch_blind) {
    latched_joints = joints_deg;
    armed_.clear();
  }
  armed_input_ = input;
}

}  // namespace val3
