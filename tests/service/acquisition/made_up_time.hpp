#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>

#include "service/acquisition/clocks.hpp"
#include "service/acquisition/wake.hpp"

namespace cell {

/// A clock that only a test moves.
class MadeUpTime {
 public:
  [[nodiscard]] Clocks clocks() {
    return {[this] { return std::chrono::system_clock::time_point{} + since_begin_; },
            [this] { return std::chrono::steady_clock::time_point{} + since_begin_; }};
  }
  void pass(std::chrono::milliseconds time) { since_begin_ += time; }
  [[nodiscard]] std::chrono::milliseconds since_begin() const { return since_begin_; }

 private:
  std::chrono::milliseconds since_begin_{0};
};

/// Whoever waits waits no time: the made-up one passes. `on_wait` may let something happen meanwhile.
class MadeUpWake : public Wake {
 public:
  explicit MadeUpWake(MadeUpTime& time) : time_(time) {}

  boost::asio::awaitable<void> wait(std::chrono::milliseconds at_most) override {
    constexpr int kWaitsMax = 10'000;
    if (++wait_count > kWaitsMax) throw std::runtime_error("somebody waits for ever");
    time_.pass(at_most);
    if (on_wait) on_wait();
    co_return;
  }
  void wake() override { ++wake_count; }

  std::function<void()> on_wait;
  int wait_count = 0;
  int wake_count = 0;

 private:
  MadeUpTime& time_;
};

}  // namespace cell
