#include "service/acquisition/alarm.hpp"

#include <utility>

namespace cell {

void TimerAlarm::set(std::chrono::milliseconds after, std::function<void()> call) {
  call_ = std::make_shared<std::function<void()>>(std::move(call));
  timer_.expires_after(after);
  timer_.async_wait([set = std::weak_ptr(call_)](const boost::system::error_code& failure) {
    if (const auto still = set.lock(); still && !failure) (*still)();
  });
}

void TimerAlarm::cancel() {
  call_.reset();
  timer_.cancel();
}

}  // namespace cell
