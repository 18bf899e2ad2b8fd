#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <string>

namespace cell {

/// Notifications to systemd for a service of Type=notify (sd_notify(3)). Without systemd they do nothing.
class Supervision {
 public:
  /// `executor` is the daemon's thread: while it runs, the watchdog (WatchdogSec) is notified.
  explicit Supervision(const boost::asio::any_io_executor& executor);
  Supervision(const Supervision&) = delete;
  Supervision& operator=(const Supervision&) = delete;

  /// The daemon serves; `systemctl status` shows `status`. Starts the watchdog notifications.
  void notify_ready(const std::string& status);
  void notify_stopping();

 private:
  void notify_watchdog();

  boost::asio::steady_timer timer_;
  std::chrono::microseconds period_{};  // zero: no watchdog
};

}  // namespace cell
