#include "service/daemon/supervision.hpp"

#include <systemd/sd-daemon.h>

namespace cell {

namespace {

/// Share of the watchdog time between two notifications: one may be lost.
constexpr int kBeatsPerTimeout = 3;

}  // namespace

Supervision::Supervision(const boost::asio::any_io_executor& executor) : timer_(executor) {
  std::uint64_t timeout_us = 0;
  if (sd_watchdog_enabled(0, &timeout_us) > 0)
    period_ = std::chrono::microseconds(timeout_us / kBeatsPerTimeout);
}

void Supervision::notify_ready(const std::string& status) {
  sd_notify(0, ("READY=1\nSTATUS=" + status).c_str());
  if (period_.count() > 0) notify_watchdog();
}

void Supervision::notify_stopping() { sd_notify(0, "STOPPING=1\nSTATUS=stops the robot and closes"); }

void Supervision::notify_watchdog() {
  sd_notify(0, "WATCHDOG=1");
  timer_.expires_after(period_);
  timer_.async_wait([this](const boost::system::error_code& failure) {
    if (!failure) notify_watchdog();
  });
}

}  // namespace cell
