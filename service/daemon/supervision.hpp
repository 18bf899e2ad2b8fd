#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <string>

namespace cell {

/// What systemd is told of a service of Type=notify (sd_notify(3)). A process that systemd did not start has
/// nobody to tell: then nothing happens.
class Supervision {
 public:
  /// `executor` is the daemon's thread: as long as it turns, the watchdog (WatchdogSec) is kept quiet.
  explicit Supervision(const boost::asio::any_io_executor& executor);
  Supervision(const Supervision&) = delete;
  Supervision& operator=(const Supervision&) = delete;

  /// The daemon serves; `status` is what `systemctl status` shows. Begins the sign of life.
  void tell_ready(const std::string& status);
  void tell_stopping();

 private:
  void beat();

  boost::asio::steady_timer timer_;
  std::chrono::microseconds period_{};  // zero: nobody waits for a sign of life
};

}  // namespace cell
