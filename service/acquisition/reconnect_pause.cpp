#include "service/acquisition/reconnect_pause.hpp"

#include <algorithm>

namespace cell {

void ReconnectPause::on_try(TimePoint now, bool linked) {
  earliest_ = now + pause_;
  pause_ = std::min(2 * pause_, kLongest);
  linked_at_ = linked ? std::optional(now) : std::nullopt;
}

void ReconnectPause::on_link_end(TimePoint now) {
  if (!linked_at_) return;
  if (now - *linked_at_ >= kLasts) {
    pause_ = kFirst;
    short_links_ = 0;
  } else {
    ++short_links_;
  }
  linked_at_.reset();
  earliest_ = std::max(earliest_, now + kFirst);
}

}  // namespace cell
