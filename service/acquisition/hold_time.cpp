#include "service/acquisition/hold_time.hpp"

namespace cell {

void HoldTime::on_entered(State state, TimePoint now) {
  if (stands_still(state)) {
    if (!since_) since_ = now;
  } else if (!is_going_on(state)) {
    since_.reset();
  }
}

}  // namespace cell
