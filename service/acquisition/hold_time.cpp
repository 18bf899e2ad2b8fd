#include "service/acquisition/hold_time.hpp"

namespace cell {

void HoldTime::on_entered(State state, TimePoint now) {
  switch (state) {
    case State::kHolding:
    case State::kHeld:
    case State::kSuspending:
    case State::kSuspended:
      if (!since_) since_ = now;
      break;
    case State::kUnholding:
    case State::kUnsuspending:
      break;
    case State::kStopped:
    case State::kResetting:
    case State::kIdle:
    case State::kStarting:
    case State::kExecute:
    case State::kCompleting:
    case State::kComplete:
    case State::kStopping:
    case State::kAborting:
    case State::kAborted:
    case State::kClearing:
      since_.reset();
      break;
  }
}

}  // namespace cell
