// The end of a run, and that of a CellOperation with its daemon. Each co_await stands alone in its statement,
// see cs8_controller.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "service/acquisition/cell_operation.hpp"
#include "service/base/utc_time.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

/// How long the end waits for the controller's last answer, and for what that leaves to be stored.
constexpr std::chrono::milliseconds kStopPatience{3000};
constexpr std::chrono::milliseconds kRetractPatience{10'000};  // as long as the arm still moves then
constexpr std::chrono::milliseconds kClosePatience{1000};

/// How often the end of a run that could not be stored is tried again, beside each change of the state.
constexpr std::chrono::seconds kEndAgain{5};

}  // namespace

asio::awaitable<void> CellOperation::shut_down() {
  status_.end();
  plans_.end();
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

std::string CellOperation::now_text() const { return format_utc(clocks_.system()); }

/// The run is over: its verdict and its latest result are stored with it.
asio::awaitable<void> CellOperation::close_run(RunOutcome outcome) {
  session_.forget_standing();
  if (!run_ || !run_->open) co_return;
  const Run& run = run_->run;
  run_->open = false;
  block_is_away_ = is_block_away(run.plan_changes()).value_or(block_is_away_);
  Conclusion concluded;
  try {
    concluded = co_await computation_.conclude(*run_, outcome);
  } catch (const std::exception& error) {  // its end is stored all the same
    status_.set_fault({FaultCode::kInternalError, error.what()});
  }
  RunEnd end{.outcome = run_->interruption ? RunOutcome::kInterrupted : outcome,
             .verdict = concluded.verdict,
             .ended_at = now_text(),
             .result_json = concluded.result_json,
             .arm_json = concluded.arm_json};
  if (const auto& fault = status_.fault()) {
    end.fault_code = std::string(describe(fault->code).name);
    end.fault_message = fault->message();
  }
  run_->interruption.reset();
  spdlog::info("run {} {}: {}, {} of {} touches", run.id(), run_outcome_name(outcome),
               verdict_name(end.verdict), run.touches_done(), run.touches_total());
  const UnstoredEnd closed{.run_id = run.id(),
                           .kind = run.kind(),
                           .end = end,
                           .finished = concluded.finished,
                           .ended_by = status_.fault(),
                           .told = {},
                           .try_at = {}};
  const auto failure = co_await store_end(closed);
  if (!failure) co_return;
  unstored_end_ = closed;
  unstored_end_->try_at = clocks_.steady() + kEndAgain;
  status_.set_verdict(Verdict::kIncomplete);
  status_.set_fault({FaultCode::kStoreFailed, *failure});
  unstored_end_->told = status_.fault()->message();
  spdlog::error("run {}: its end could not be stored: {}", closed.run_id, *failure);
}

/// Returns why it failed. What is not on the disk is not accepted.
asio::awaitable<std::optional<std::string>> CellOperation::store_end(UnstoredEnd closed) {
  const auto write = [id = closed.run_id, end = closed.end](RunStore& store) { store.finish_run(id, end); };
  const auto failure = co_await store_.write(write);
  if (failure) co_return failure;
  const Verdict verdict = closed.end.verdict;
  if (run_ && run_->run.id() == closed.run_id) {
    run_->finished = closed.finished;
    status_.set_verdict(verdict);
  }
  if (verdict == Verdict::kAccepted && closed.kind == RunKind::kCalibration)
    status_.set_last_accepted(closed.run_id, closed.end.ended_at);
  co_return std::nullopt;
}

/// The end of a run that the disk did not take. No run begins before: see unmet_by_unstored_end(). What ended
/// the run is shown again then, where nobody has read that it could not be stored.
asio::awaitable<void> CellOperation::store_end_again() {
  const UnstoredEnd closed = *unstored_end_;
  const auto failure = co_await store_end(closed);
  if (failure) {
    unstored_end_->try_at = clocks_.steady() + kEndAgain;
    co_return;
  }
  unstored_end_.reset();
  spdlog::info("run {}: its end is stored now: {}", closed.run_id, verdict_name(closed.end.verdict));
  const auto& fault = status_.fault();
  if (fault && fault->code == FaultCode::kStoreFailed && fault->message() == closed.told) {
    status_.clear_fault();
    if (closed.ended_by) status_.set_fault(*closed.ended_by);
  }
  status_.publish();
}

bool CellOperation::is_end_due() const { return unstored_end_ && clocks_.steady() >= unstored_end_->try_at; }

std::optional<Unmet> CellOperation::unmet_by_unstored_end() const {
  if (!unstored_end_) return std::nullopt;
  return Unmet{
      "store_not_writable",
      fmt::format("the end of run {} is not stored yet: free disk space or repair the state directory",
                  unstored_end_->run_id)};
}

/// How long there is nothing to do, unless something wakes.
std::chrono::milliseconds CellOperation::quiet_wait() const {
  return unstored_end_ ? std::chrono::milliseconds(kEndAgain) : std::chrono::hours(1);
}

}  // namespace cell
