#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <memory>

namespace cell {

/// Calls once when a time has passed, unless it is cancelled before. One call at a time; one thread.
class Alarm {
 public:
  virtual ~Alarm() = default;

  /// In place of the call that was set before.
  virtual void set(std::chrono::milliseconds after, std::function<void()> call) = 0;
  /// What was set is not called any more.
  virtual void cancel() = 0;
};

/// Over a timer of the executor, on which it calls.
class TimerAlarm : public Alarm {
 public:
  explicit TimerAlarm(const boost::asio::any_io_executor& executor) : timer_(executor) {}
  ~TimerAlarm() override { cancel(); }
  TimerAlarm(const TimerAlarm&) = delete;
  TimerAlarm& operator=(const TimerAlarm&) = delete;

  void set(std::chrono::milliseconds after, std::function<void()> call) override;
  void cancel() final;

 private:
  boost::asio::steady_timer timer_;
  std::shared_ptr<std::function<void()>> call_;  // gone: a timer that has run out already calls nothing
};

}  // namespace cell
