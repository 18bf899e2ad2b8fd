#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "service/acquisition/alarm.hpp"
#include "service/acquisition/wake.hpp"
#include "service/base/clocks.hpp"

namespace cell {

/// A clock that only a test moves.
class MadeUpTime {
 public:
  [[nodiscard]] Clocks clocks();
  void pass(std::chrono::milliseconds time) { since_begin_ += time; }
  /// Somebody sets the machine's clock; nothing passes.
  void set_wall_clock(std::chrono::milliseconds ahead) { wall_ahead_ = ahead; }
  [[nodiscard]] std::chrono::milliseconds since_begin() const { return since_begin_; }
  /// Its clock of deadlines throws, once: what nobody foresaw happens in whoever reads it next.
  bool throws_once = false;

 private:
  std::chrono::milliseconds since_begin_{0};
  std::chrono::milliseconds wall_ahead_{0};
};

/// Whoever waits waits no time: the made-up one passes. `on_wait` may let something happen meanwhile.
class MadeUpWake : public Wake {
 public:
  explicit MadeUpWake(MadeUpTime& time) : time_(time) {}

  boost::asio::awaitable<void> wait(std::chrono::milliseconds at_most) override;
  void wake() override { ++wake_count; }

  std::function<void()> on_wait;
  int wait_count = 0;
  int wake_count = 0;

 private:
  MadeUpTime& time_;
};

/// Rings when the test says so.
class MadeUpAlarm : public Alarm {
 public:
  void set(std::chrono::milliseconds after, std::function<void()> call) override {
    set_for = after;
    call_ = std::move(call);
  }
  void cancel() override { call_ = nullptr; }
  [[nodiscard]] bool is_set() const { return call_ != nullptr; }
  void ring() { std::exchange(call_, nullptr)(); }

  std::chrono::milliseconds set_for{0};

 private:
  std::function<void()> call_;
};

}  // namespace cell
