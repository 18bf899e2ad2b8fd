#include "service/acquisition/late_warning.hpp"

#include <spdlog/fmt/fmt.h>

namespace cell {

void LateWarning::begin(std::string what) {
  if (waits_++ > 0) return;
  what_ = std::move(what);
  set_alarm();
}

void LateWarning::set_alarm() {
  alarm_->set(untold_max_, [this] {
    is_told_ = true;
    status_.warn({code_, fmt::format("{}, for {} s now", what_, untold_max_.count())});
  });
}

void LateWarning::end() {
  if (--waits_ > 0) {
    if (!is_told_) set_alarm();  // something was done: the time of the others begins anew
    return;
  }
  is_told_ = false;
  alarm_->cancel();
  status_.end_warning(code_);
}

}  // namespace cell
