#include "service/acquisition/hold_time.hpp"

namespace cell {

void HoldTime::on_entered(State state, int touches_done, TimePoint now) {
  is_moving_ = state == State::kExecute || state == State::kCompleting;
  if (is_moving_) touches_done_ = touches_done;  // one may have been withdrawn in the hold
  if (stands_still(state)) {
    if (!since_ || touches_done > touches_done_) since_ = now;
    touches_done_ = touches_done;
  } else if (!is_moving_ && !is_going_on(state)) {
    *this = {};
  }
}

void WorkTime::on_entered(State state, TimePoint now) {
  const bool works = state == State::kExecute || state == State::kCompleting;
  if (works == since_.has_value()) return;
  before_ = until(now);
  since_ = works ? std::optional(now) : std::nullopt;
}

}  // namespace cell
