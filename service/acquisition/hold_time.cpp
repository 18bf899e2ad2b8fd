#include "service/acquisition/hold_time.hpp"

namespace cell {

void HoldTime::on_entered(State state, TimePoint now) {
  if (stands_still(state)) {
    if (!since_) since_ = now;
  } else if (!is_going_on(state)) {
    since_.reset();
  }
}

void WorkTime::on_entered(State state, TimePoint now) {
  const bool works = state == State::kExecute || state == State::kCompleting;
  if (works == since_.has_value()) return;
  before_ = until(now);
  since_ = works ? std::optional(now) : std::nullopt;
}

}  // namespace cell
