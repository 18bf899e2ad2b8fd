#include "sim_controller/val3_pace.hpp"

#include <algorithm>
#include <cmath>

#include "sim_controller/controller.hpp"
#include "sim_controller/planned_move.hpp"

namespace sim {
namespace {

/// A program that was held up does not catch up with more than this.
constexpr std::chrono::milliseconds kLagMax{100};

std::chrono::steady_clock::duration tick_at(double speed) {
  if (std::isinf(speed)) return {};
  return std::chrono::ceil<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(kTickSeconds / speed));
}

}  // namespace

void Val3Pace::host_connected(double clock_s, TimePoint now) {
  connected_ = true;
  timeout_ = kHelloTimeout;
  host_heard(clock_s, now);
}

void Val3Pace::host_heard(double clock_s, TimePoint now) {
  heard_s_ = clock_s;
  heard_at_ = now;
}

bool Val3Pace::waits_for_host(double clock_s, TimePoint now) const {
  return connected_ && clock_s - heard_s_ >= kHeartbeatSeconds && now < heard_at_ + timeout_;
}

bool Val3Pace::tick(bool is_busy, double clock_s, TimePoint now) {
  const double speed = is_busy ? speed_ : std::min(speed_, 1.0);
  const auto period = tick_at(speed);
  next_tick_ = std::clamp(next_tick_, now - kLagMax, now + period);
  if (next_tick_ > now) {
    wake_at_ = next_tick_;
    return false;
  }
  if (speed > 1.0 && waits_for_host(clock_s, now)) {
    next_tick_ = now;
    wake_at_ = heard_at_ + timeout_;
    return false;
  }
  next_tick_ += period;
  return true;
}

}  // namespace sim
