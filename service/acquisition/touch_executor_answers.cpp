// How a TouchExecutor takes answers: judged, refused, late, or a no. Each co_await stands alone in its
// statement, see cs8_controller.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "service/acquisition/touch_executor.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

/// This many false triggers in a run indicate a fault.
constexpr int kFalseTriggersMany = 3;

/// The run with which an answer is kept that is no measurement; nothing where this daemon has none: a run
/// that the one before ended has left its answer with the controller.
std::optional<std::int64_t> asker_of_answer(const ActiveRun* active, const std::optional<OpenTouch>& open) {
  if (open) return open->run_id;
  return active ? std::optional(active->run.id()) : std::nullopt;
}

}  // namespace

/// True when the answer is a measurement, which the caller keeps and acknowledges; else the answer is dealt
/// with.
asio::awaitable<bool> TouchExecutor::accept(ActiveRun& active, calib::PlannedTouch touch,
                                            std::uint32_t sequence, cs8::TouchResult result, HeldBy held_by) {
  TouchJudgement judged = judge_touch(cell_, touch, result, history_);
  // An arm that must not move touches nothing: this is no measurement of it.
  if (auto lost = session_.lost_permission(); judged.next == TouchJudgement::Next::kKeep && !lost.empty())
    judged = {.next = TouchJudgement::Next::kFault,
              .fault = {FaultCode::kPermissionLost, std::move(lost)},
              .event = Event::kHoldFault,
              .warnings = {}};
  for (const Fault& warning : judged.warnings) status_.warn(warning);
  if (judged.next == TouchJudgement::Next::kKeep) {
    history_ = {.attempts = 0, .spread_m = {}, .last_contact = result.contact};
    co_return true;
  }
  const bool is_again = deal_with(active, touch, judged, result, held_by);
  const std::string reason =
      judged.next == TouchJudgement::Next::kStopped ? "the arm was stopped" : judged.fault.message();
  const bool refused = co_await refuse(active.run.id(), {session_.number(), sequence}, result, reason);
  if (!refused && is_again) held_by_ = held_by;
  co_return false;
}

/// An answer that is no measurement. True when the touch is made again by itself.
bool TouchExecutor::deal_with(const ActiveRun& active, const calib::PlannedTouch& touch,
                              const TouchJudgement& judged, const cs8::TouchResult& result, HeldBy held_by) {
  preparation_.drop_next();
  if (judged.next == TouchJudgement::Next::kStopped) {
    if (result.phase == cs8::Phase::kSearch) status_.warn({FaultCode::kStoppedInSearch, {}});
    session_.expect_stop(result.outcome);
    return false;
  }
  const bool is_again = judged.next == TouchJudgement::Next::kAgain;
  if (is_again) {
    ++history_.attempts;
    history_.spread_m = contact_spread_m(cell_, result);
    status_.warn(judged.fault);
  } else {
    take_no_measurement(active, touch, judged, held_by);
  }
  // Behind the warning of this one: the newest is what a person sees.
  if (judged.fault.code == FaultCode::kFalseTrigger && ++false_trigger_count_ == kFalseTriggersMany)
    status_.warn({FaultCode::kFalseTriggersMany, fmt::format("{} in this run", false_trigger_count_)});
  return is_again;
}

/// A touch that is not made again by itself.
void TouchExecutor::take_no_measurement(const ActiveRun& active, const calib::PlannedTouch& touch,
                                        const TouchJudgement& judged, HeldBy held_by) {
  const FaultCode code = judged.fault.code;
  history_.attempts = 0;  // a person's answer resets the count
  history_.spread_m.reset();
  preparation_.set_missed(code == FaultCode::kNoContact || code == FaultCode::kEarlyContact);
  if (code == FaultCode::kCollision) preparation_.forget_made();  // what was known of the arm may be wrong
  held_by_ = held_by;
  const bool of_plan = held_by == HeldBy::kTouch;
  const Fault told = session_.with_permission_told(judged.fault);
  status_.raise(of_plan && active.place_check ? active.place_check->explain(told, touch.face) : told,
                judged.event);
}

/// A contact that is no measurement is stored with the reason before the controller may forget it. False when
/// that could not be: the controller keeps it, and it is settled when the run goes on or, after its end, at
/// the reset. What holds or ends the run stays to be read.
asio::awaitable<bool> TouchExecutor::refuse(std::optional<std::int64_t> run_id, AnsweredCommand command,
                                            cs8::TouchResult result, std::string reason) {
  const auto failure = co_await refused_.settle(run_id, command, result, std::move(reason));
  if (!failure) co_return true;
  if (status_.fault() && status_.state() != State::kExecute) {
    status_.warn({FaultCode::kStoreFailed, *failure});
  } else {
    tell_unstored(*failure);
  }
  co_return false;
}

void TouchExecutor::take_rejection(const cs8::Rejected& rejected, HeldBy held_by) {
  const OutcomeFault refused = fault_of(rejected);
  held_by_ = held_by;
  status_.raise(session_.with_permission_told(refused.fault), refused.event());
  session_.meet_anew_after(rejected);
}

/// The controller keeps its answer until it is acknowledged: a run on hold stores it when it goes on, one
/// that has ended with its own fault when the cell is reset.
void TouchExecutor::tell_unstored(const std::string& failure) {
  const Fault fault{FaultCode::kStoreFailed, failure};
  if (has_ended(status_.state())) return status_.warn(fault);
  status_.raise(fault, status_.state() == State::kExecute ? Event::kHoldFault : Event::kNotReadyFault);
}

/// It did not leave or was not taken: its sequence number belongs to the command that leaves next.
void TouchExecutor::forget_stored_command(std::int64_t run_id) {
  store_.behind([run_id](RunStore& store) { store.forget_open_command(run_id); });
}

/// What the controller has waits there until it can be stored.
void TouchExecutor::leave_unstored(const ActiveRun* active) {
  const bool is_left = has_ended(status_.state()) || status_.state() == State::kClearing;
  if (!(active && active->open) && !is_left) status_.enter(State::kStopped);
}

asio::awaitable<void> TouchExecutor::settle_open_command(ActiveRun* active, std::uint32_t sequence) {
  // The run has it and stores it when it goes on; before that the controller forgets nothing.
  if (is_beside_plan(sequence) && active && active->open) co_return;
  const cs8::QueryReply reply = co_await session_.query(sequence);
  if (std::holds_alternative<cs8::LinkError>(reply)) co_return;
  const auto* result = std::get_if<cs8::TouchResult>(&reply);
  const std::optional<OpenTouch> open = session_.open_touch();
  const bool ours = active && open && open->run_id == active->run.id() &&
                    open->session == session_.number() && open->sequence == sequence;
  std::optional<TouchJudgement> judged;
  if (result && ours) judged = judge_touch(cell_, open->planned, *result, {});
  if (judged && judged->next == TouchJudgement::Next::kKeep) {
    spdlog::info("run {}: touch {} had been made when the run was broken off", active->run.id(),
                 active->run.touches_done() + 1);
    const bool kept = co_await keep_late_touch(*active, *open, *result);
    if (!kept) {
      leave_unstored(active);
      co_return;
    }
  } else if (open) {
    forget_stored_command(open->run_id);
  }
  const bool is_kept = judged && judged->next == TouchJudgement::Next::kKeep;
  if (result && !is_kept) {
    const std::optional<std::int64_t> run_id = asker_of_answer(active, open);
    const std::string reason =
        judged ? judged->fault.message() : "it answers no touch of the run's plan that waits for one";
    const bool refused = co_await refuse(run_id, {session_.number(), sequence}, *result, reason);
    if (!refused) {
      leave_unstored(active);
      co_return;
    }
  } else {
    session_.acknowledge(sequence);
  }
  if (!judged && active && active->open) tell_end_of_unknown(reply);
  if (judged && judged->next == TouchJudgement::Next::kFault && judged->event == Event::kAbortFault &&
      active->open)
    status_.raise(judged->fault, judged->event);
}

/// Of a motion or a touch beside the plan that the link did not outlive nothing is known but how it ended:
/// what ends a run ends it also then.
void TouchExecutor::tell_end_of_unknown(const cs8::QueryReply& reply) {
  std::optional<OutcomeFault> fault;
  if (const auto* touch = std::get_if<cs8::TouchResult>(&reply))
    fault = fault_of(touch->outcome, touch->phase, touch->error_number);
  if (const auto* move = std::get_if<cs8::MoveResult>(&reply))
    fault = fault_of(move->outcome, move->phase, move->error_number);
  if (fault && !fault->holds) status_.raise(fault->fault, Event::kAbortFault);
}

/// A contact of a run that is over or on hold: its stored result follows, its verdict does not change.
asio::awaitable<bool> TouchExecutor::keep_late_touch(ActiveRun& active, OpenTouch open,
                                                     cs8::TouchResult result) {
  const calib::PlannedTouch* of_plan = active.run.next();
  const bool goes_on = active.open && !active.interruption && !active.guided;
  const calib::JointVector contact = from_wire(result.contact);
  if (goes_on && of_plan) reference_.note_fitted(*of_plan, contact);
  const bool kept = co_await keep(active, open.planned, result, open);
  if (!kept) co_return false;
  co_await identify(active);
  if (goes_on) aim_behind_late_touch(active, contact);
  const Conclusion told = co_await computation_.conclude(active, std::nullopt);
  if (told.result_json) {
    store_.behind([id = active.run.id(), json = *told.result_json, arm = told.arm_json](RunStore& store) {
      store.set_result_json(id, json, arm);
    });
  }
  status_.publish();
  co_return true;
}

void TouchExecutor::aim_behind_late_touch(const ActiveRun& active, const calib::JointVector& contact) {
  if (preparation_.made() && preparation_.is_surprise(contact)) preparation_.drop_next();
  suspect_last(active);
}

}  // namespace cell
