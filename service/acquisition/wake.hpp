#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>

namespace cell {

/// Where the cell's one loop waits until there is something to do. Who waits looks again at what it waits
/// for: a wait may end early. A wake-up while nobody waits is lost.
class Wake {
 public:
  virtual ~Wake() = default;

  virtual boost::asio::awaitable<void> wait(std::chrono::milliseconds at_most) = 0;
  virtual void wake() = 0;
};

/// Over a timer of the executor.
class TimerWake : public Wake {
 public:
  explicit TimerWake(const boost::asio::any_io_executor& executor) : timer_(executor) {}

  boost::asio::awaitable<void> wait(std::chrono::milliseconds at_most) override;
  void wake() override { timer_.cancel(); }

 private:
  boost::asio::steady_timer timer_;
};

}  // namespace cell
