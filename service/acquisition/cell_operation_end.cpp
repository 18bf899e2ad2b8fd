// The end of a CellOperation with its daemon. Each co_await stands alone in its statement, see
// cs8_controller.cpp.
#include <spdlog/spdlog.h>

#include <utility>

#include "service/acquisition/cell_operation.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

/// How long the end waits for the controller's last answer, and for what that leaves to be stored.
constexpr std::chrono::milliseconds kStopPatience{3000};
constexpr std::chrono::milliseconds kRetractPatience{10'000};  // as long as the arm still moves then
constexpr std::chrono::milliseconds kClosePatience{1000};

}  // namespace

asio::awaitable<void> CellOperation::shut_down() {
  status_.end();
  break_off_for_end();
  wake_.wake();
  if (is_starting_) {
    co_await loop_.ended.wait(kStopPatience);  // it is refused now, and leaves no run behind
    break_off_for_end();
    wake_.wake();
  }
  co_await wait_for_end(kStopPatience);
  const auto told = session_.latest_state();
  if (told && told->active_sequence != 0) co_await wait_for_end(kRetractPatience);
  session_.close();  // what still waits for the controller ends now
  co_await wait_for_end(kClosePatience);
}

/// The end of the daemon is nobody's word about the run: it stays open, on hold. Only a stop or an abort that
/// came before, or comes meanwhile, ends it. The way around the block has nothing to keep; on the way back
/// from a face the arm stays where it is.
void CellOperation::break_off_for_end() {
  const State state = status_.state();
  if (way_back_.is_under_way()) return status_.enter(State::kStopping);
  if (!is_active(state) || state == State::kStopping || state == State::kAborting) return;
  if (!run_) {
    loop_.ends_pass = true;
    status_.enter(State::kStopping);
  } else if (state != State::kHeld) {
    session_.stop_motion();  // a pause lets the touch under way end, the end of the daemon does not
    if (state != State::kHolding) status_.enter(State::kHolding);  // whatever it waits for, or its resumption
  }
}

/// Where the permit is still there for it. A stop that came before, or on this way, is the last word.
asio::awaitable<void> CellOperation::leave_face_once() {
  const bool is_tried = std::exchange(loop_.left_face, true);
  if (is_tried || (run_ && run_->guided)) co_return;  // by hand: the person does
  co_await session_.leave_face();
}

asio::awaitable<void> CellOperation::leave_for_next_daemon() {
  co_await leave_face_once();
  session_.give_permit_back();
  spdlog::info("run {} is left on hold after {} of {} touches: the next daemon offers to resume it",
               run_->run.id(), run_->run.touches_done(), run_->run.touches_total());
}

asio::awaitable<void> CellOperation::wait_for_end(std::chrono::milliseconds at_most) {
  if (loop_.runs) co_await loop_.ended.wait(at_most);
}

}  // namespace cell
