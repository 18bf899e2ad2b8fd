#include "tests/service/acquisition/made_up_time.hpp"

#include <stdexcept>
#include <utility>

namespace cell {

Clocks MadeUpTime::clocks() {
  return {[this] { return std::chrono::system_clock::time_point{} + since_begin_ + wall_ahead_; },
          [this] {
            if (std::exchange(throws_once, false)) throw std::runtime_error("the clock is broken");
            return std::chrono::steady_clock::time_point{} + since_begin_;
          }};
}

boost::asio::awaitable<void> MadeUpWake::wait(std::chrono::milliseconds at_most) {
  constexpr int kWaitsMax = 10'000;
  if (++wait_count > kWaitsMax) throw std::runtime_error("somebody waits for ever");
  time_.pass(at_most);
  if (on_wait) on_wait();
  co_return;
}

}  // namespace cell
