#include "service/acquisition/late_warning.hpp"

#include <spdlog/fmt/fmt.h>

namespace cell {

void LateWarning::begin(std::string what) {
  if (waits_++ > 0) return;
  alarm_->set(untold_max_, [this, what = std::move(what)] {
    status_.warn({code_, fmt::format("{}, for {} s now", what, untold_max_.count())});
  });
}

void LateWarning::end() {
  if (--waits_ > 0) return;
  alarm_->cancel();
  status_.end_warning(code_);
}

}  // namespace cell
