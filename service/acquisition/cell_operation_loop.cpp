// What the states of a CellOperation do: one coroutine, one step at a time. Each co_await stands alone in its
// statement, see cs8_controller.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "config/touched_places.hpp"
#include "service/acquisition/cell_operation.hpp"
#include "service/acquisition/preconditions.hpp"
#include "service/acquisition/touch_judgement.hpp"
#include "service/documents/conditions_view.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// How often a run on hold looks whether its permit has lasted long enough.
constexpr std::chrono::milliseconds kPermitLook{10'000};

}  // namespace

void CellOperation::on_entered(State state) {
  session_.on_entered(state);
  way_back_.on_entered(state);
  const auto now = clocks_.steady();
  hold_time_.on_entered(state, run_ ? run_->run.touches_done() : 0, now);
  if (run_) run_->worked.on_entered(state, now);
  if (unstored_end_) unstored_end_->try_at = now;
}

asio::awaitable<void> CellOperation::act_on_states() {
  // At the end an interrupted run stays on hold: the next daemon takes it up.
  const auto is_left = [this] { return !is_active(status_.state()) || status_.state() == State::kHeld; };
  while (!status_.is_ending() || !is_left()) {
    const State state = status_.state();
    std::optional<std::string> failure;
    try {
      if (is_end_due()) {
        co_await store_end_again();
        continue;  // nobody waited for a command meanwhile: what there was is looked at now
      }
      if (state != State::kExecute && run_ && run_->run.identification_is_due()) {
        co_await identify_run();
        continue;  // as above
      }
      co_await act_on(state);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    if (failure) co_await break_off(state, *failure);
  }
  if (unstored_end_) co_await store_end_again();
}

/// Where a command begins another run meanwhile, the result is that of none.
asio::awaitable<void> CellOperation::identify_run() {
  const Run identified = co_await computation_.identified(run_->run.copy_to_identify());
  if (run_ && run_->run.take_latest(identified)) status_.publish();
}

/// What nobody foresaw ends the run, never the daemon with its STOP.
asio::awaitable<void> CellOperation::break_off(State state, std::string why) {
  if ((is_active(status_.state()) || way_back_.is_under_way()) && state != State::kAborting) {
    status_.raise({FaultCode::kInternalError, std::move(why)}, Event::kAbortFault);
    co_return;
  }
  // The end of the run itself failed, or what is done without one.
  spdlog::error("in the state {}: {}", state_name(state), why);
  if (run_) {
    run_->open = false;
    run_->interruption.reset();  // nobody goes on with it
  }
  status_.set_fault({FaultCode::kInternalError, std::move(why)});
  status_.enter(State::kAborted);
  co_await wake_.wait(1s);
}

asio::awaitable<void> CellOperation::act_on(State state) {
  switch (state) {
    case State::kResetting:
      co_await reset();
      break;
    case State::kStarting:
      if (location_.is_passing()) {
        co_await pass_block();
      } else {
        co_await start_run();
      }
      break;
    case State::kExecute:
      if (run_->guided) {
        co_await manual_.await_touch(*run_);
      } else {
        co_await touches_.make_next_touch(*run_);
      }
      break;
    case State::kCompleting:
      co_await complete_run();
      break;
    case State::kSuspended:
      co_await wait_out_suspension();
      break;
    case State::kUnsuspending:
    case State::kUnholding:
      co_await resume_run();
      break;
    case State::kStopping:
      if (loop_.ends_pass) co_await leave_face_once();
      session_.give_permit_back();
      co_await close_run(RunOutcome::kStopped);
      status_.apply(Event::kDone);
      break;
    case State::kAborting:
      session_.give_permit_back();
      co_await close_run(RunOutcome::kAborted);
      status_.apply(Event::kDone);
      break;
    case State::kSuspending:
    case State::kHolding:
      if (status_.is_ending()) co_await leave_for_next_daemon();
      if (status_.state() == state) status_.apply(Event::kDone);  // a person may have stopped it meanwhile
      break;
    case State::kClearing:
      // Whatever stopped the arm, the session starts again before the next run.
      session_.close();
      status_.apply(Event::kDone);
      break;
    case State::kComplete:
    case State::kStopped:
    case State::kAborted:
    case State::kHeld:
      // A run that is finished or on hold stays to be read while the link comes and goes.
      if (session_.connected()) {
        end_old_permit();
        co_await wake_.wait(state == State::kHeld ? kPermitLook : quiet_wait());
      } else {
        co_await connect();
      }
      break;
    case State::kIdle:
      co_await await_readiness();
      break;
  }
}

asio::awaitable<void> CellOperation::reset() {
  if (!session_.connected()) {
    co_await connect();
    co_return;
  }
  if (session_.open_touch() || session_.sequence_to_settle() != 0) {
    co_await settle(session_.sequence_to_settle());
  } else if (!unmet_preconditions().empty()) {
    co_await await_readiness();
  } else if (way_back_.is_asked() && is_way_back_due()) {
    if (session_.latest_state()->active_sequence == 0) {
      co_await way_back_.make();
    } else {
      co_await wake_.wait(1s);  // until State knows of the end that was answered: each wakes
    }
  } else {
    status_.apply(Event::kDone);
  }
}

/// Each state of the controller that changes it wakes. A dialogue asks for what it needs itself.
asio::awaitable<void> CellOperation::await_readiness() {
  const AwaitedAction* missing = nullptr;
  if (!location_.is_locating()) missing = awaited_before_start(unmet_preconditions());
  session_.wait_for(missing);
  co_await wake_.wait(quiet_wait());
}

asio::awaitable<void> CellOperation::connect() {
  const std::uint32_t sequence = co_await session_.connect(is_interrupted(), [this] { return is_end_due(); });
  // An answer to a run of other files stays with the controller: these say nothing of it.
  if (sequence != 0 && !waits_for_its_files()) co_await settle(sequence);
}

/// The result that the controller still has, in whatever state: where a run has ended it is kept with that
/// run, which stays as it ended.
asio::awaitable<void> CellOperation::settle(std::uint32_t sequence) {
  struct Settling {
    explicit Settling(bool& is_set) : flag(is_set) { flag = true; }
    ~Settling() { flag = false; }
    Settling(const Settling&) = delete;
    Settling& operator=(const Settling&) = delete;
    bool& flag;
  };
  const Settling settling(is_settling_);
  co_await touches_.settle_open_command(active(), sequence);
}

asio::awaitable<void> CellOperation::start_run() {
  session_.forget_standing();
  const bool planned = co_await planning_.plan(*run_);
  if (!planned || status_.state() != State::kStarting || !can_search()) co_return;
  const bool permitted = co_await obtain_permit();
  if (permitted) status_.apply(Event::kDone);
}

asio::awaitable<void> CellOperation::resume_run() {
  session_.forget_standing();  // on hold the arm may have been moved by hand
  if (is_interrupted() && !stood_at(run_->conditions, place())) {
    status_.raise({FaultCode::kDaemonRestarted,
                   "the block does not stand where it was found for this run; restore place.json of the "
                   "state directory, or stop the run"},
                  Event::kNotReadyFault);
    co_return;
  }
  const bool answer_stored = co_await touches_.store_answer(*run_);
  const bool is_held_again = !is_going_on(status_.state());
  if (!answer_stored || is_held_again) co_return;
  if (touches_.take_moved_block()) {
    preparation_.forget_made();
    planning_.begin_touches(*run_);
  }
  const bool resumable = co_await recovery_.make_resumable(*run_);
  const bool goes_on = is_going_on(status_.state());
  if (!resumable || !goes_on || !can_search()) co_return;
  end_old_permit();
  // Whatever took the permission may have moved something too, and an arm that stood still has cooled.
  const bool is_confirmed_anew = !has_permit();
  const bool looks = is_confirmed_anew || hold_time_.exceeds(HoldTime::kReferenceMax, clocks_.steady());
  if (looks) touches_.look_at_reference();
  const bool permitted = co_await obtain_permit();
  if (!permitted) co_return;
  if (is_confirmed_anew) hold_time_.on_confirmed(clocks_.steady());
  const std::string checked = resumption_text(looks);
  spdlog::info("{}", checked);
  if (is_confirmed_anew) status_.warn({FaultCode::kRunResumed, checked});
  status_.apply(Event::kDone);
}

namespace {

std::string block_words(const Run& run, const Cell& cell, bool is_located) {
  if (run.place() != 0) return fmt::format("at \"{}\"", place_name(cell.block, run.recipe(), run.place()));
  return is_located ? "where it was located" : "where the cell's file has it";
}

}  // namespace

/// What was checked before a run goes on; its drift is told with the reference touch.
std::string CellOperation::resumption_text(bool looks_at_reference) const {
  const Run& run = run_->run;
  const std::uint32_t before = run.touches().empty() ? 0 : run.touches().back().session;
  const char* session = before == 0 ? "" : before == session_.number() ? ", the same" : ", a new one";
  const auto told = session_.latest_state();
  const bool tested = told && (told->flags & cs8::kTouchTested) != 0;
  return fmt::format(
      "run {} goes on after {} of {} touches: controller session {}{}; files of the cell and plan as at its "
      "start; block {}; stylus {}; reference place {}",
      run.id(), run.touches_done(), run.touches_total(), session_.number(), session,
      block_words(run, cell(), place().has_value()), tested ? "touched by hand" : "not touched by hand",
      looks_at_reference ? "touched next where the recipe has one" : "not due");
}

/// False for a plan whose searches the controller will not make: a run that has begun stays on hold, for the
/// application may be set as it was.
bool CellOperation::can_search() {
  if (run_->guided) return true;  // nothing is commanded
  std::vector<calib::PlannedTouch> touches;
  for (std::size_t i = 0; const calib::PlannedTouch* planned = run_->run.planned(i); ++i)
    touches.push_back(*planned);
  auto fault = session_.search_fault(touches);
  const bool is_start = status_.state() == State::kStarting;
  if (fault) status_.raise(*std::move(fault), is_start ? Event::kAbortFault : Event::kNotReadyFault);
  return !fault;
}

asio::awaitable<bool> CellOperation::obtain_permit() {
  if (run_->guided) co_return true;  // nothing is commanded
  const bool permitted = co_await session_.obtain_permit(static_cast<std::uint32_t>(run_->run.id()));
  co_return permitted;
}

bool CellOperation::has_permit() const {
  return run_ && session_.has_permit(static_cast<std::uint32_t>(run_->run.id()));
}

/// Who confirmed a run long ago need not be at the cell any more: the key is asked for again.
void CellOperation::end_old_permit() {
  if (!has_permit() || !hold_time_.outlives_permit(cell().permit_lifetime, clocks_.steady())) return;
  spdlog::info("run {} was on hold for more than {} min: it is confirmed again when it goes on",
               run_->run.id(), cell().permit_lifetime.count());
  session_.end_permit();
}

/// Until what keeps the arm waiting has passed; nothing moves here.
asio::awaitable<void> CellOperation::wait_out_suspension() {
  const auto is_back = [this] {
    const auto state = session_.latest_state();
    return state && state->monitor_speed_percent == 100;
  };
  while (status_.state() == State::kSuspended && !is_back()) {
    end_old_permit();
    co_await wake_.wait(1s);  // each state of the controller wakes
  }
  if (status_.state() != State::kSuspended) co_return;
  status_.clear_fault();
  status_.apply(Event::kDone);
}

/// All that was planned or made ready where the block stood before.
void CellOperation::forget_plans() {
  run_.reset();
  plans_.clear();
  preparation_.forget_all();
}

asio::awaitable<void> CellOperation::pass_block() {
  const bool found = co_await location_.pass();
  if (!found) co_return;
  block_is_away_ = false;  // wherever it is, this is its first place now
  forget_plans();
  // A stop or a lost link may have come while the place was written.
  if (status_.state() == State::kStarting) status_.enter(State::kIdle);
}

asio::awaitable<void> CellOperation::complete_run() {
  const bool parked = co_await parking_.park(*run_);
  if (status_.state() != State::kCompleting) co_return;
  if (!parked) {
    co_await wake_.wait(20ms);  // the link is lost; its hook is about to report it
    co_return;
  }
  const Run& run = run_->run;
  const calib::IdentificationResult& result = run.latest();
  if (run.kind() == RunKind::kCalibration && result.status != calib::IdentificationStatus::kConverged)
    status_.set_fault({FaultCode::kNotIdentifiable, result.message});
  if (const auto bias = face_warning(result, cell().acceptance.lack_of_fit_p_min)) status_.warn(*bias);
  if (run.skipped_count() > 0)
    status_.warn({FaultCode::kTouchesLeftOut, fmt::format("{} by a person", run.skipped_count())});
  session_.give_permit_back();
  co_await close_run(RunOutcome::kComplete);
  // It is over, also where the link was lost while its end was stored.
  const State state = status_.state();
  if (state != State::kStopping && state != State::kAborting) status_.enter(State::kComplete);
}

}  // namespace cell
