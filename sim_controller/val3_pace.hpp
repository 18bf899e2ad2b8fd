#pragma once

#include <chrono>

namespace sim {

/// How simulated time goes under a VAL3 application. While nothing is under way it is wall time; else it goes
/// by `speed`. Faster than wall time, it runs ahead of the host at most until a heartbeat is due: then it
/// waits for bytes, or until the host has been silent for the heartbeat time-out in wall time.
class Val3Pace {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Simulated seconds per wall second; kSpeedMax: as many as there are.
  Val3Pace(double speed, TimePoint now) : speed_(speed), next_tick_(now) {}

  void host_connected(double clock_s, TimePoint now);
  void host_left() { connected_ = false; }
  void host_heard(double clock_s, TimePoint now);
  void set_heartbeat_timeout(std::chrono::milliseconds timeout) { timeout_ = timeout; }

  /// True when the next tick is due; then it counts as made.
  bool tick(bool is_busy, double clock_s, TimePoint now);
  /// When it is to be asked again, if no bytes come before; right behind a tick(false).
  [[nodiscard]] TimePoint wake_at() const { return wake_at_; }

  /// Simulated time from the last bytes of the host to where it waits for the next.
  static constexpr double kHeartbeatSeconds = 0.1;

 private:
  [[nodiscard]] bool waits_for_host(double clock_s, TimePoint now) const;

  double speed_;
  TimePoint next_tick_;
  TimePoint wake_at_{};
  bool connected_ = false;
  double heard_s_ = 0.0;
  TimePoint heard_at_{};
  std::chrono::milliseconds timeout_{};
};

}  // namespace sim
