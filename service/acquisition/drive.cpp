// What the states of an Operation do: one coroutine, one step at a time. The link is met in link.cpp.
// Each co_await stands alone in its statement and takes named values: GCC 12 miscompiles it inside conditions
// and destroys braced temporaries twice.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/aimed_transfer.hpp"
#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/acquisition/operation.hpp"
#include "service/run/decision_rule.hpp"
#include "service/run/planning_problem.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

asio::awaitable<void> Operation::wait_for_wake(std::chrono::milliseconds at_most) {
  wake_.expires_after(at_most);
  boost::system::error_code ignored;
  co_await wake_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
}

asio::awaitable<void> Operation::drive() {
  while (!shutting_down_ || (is_active(status_.state) && !interrupted_)) {
    if (status_.state != State::kExecute) identify();
    switch (status_.state) {
      case State::kResetting:
        co_await reset();
        break;
      case State::kStarting:
        if (passing_) {
          co_await pass_block();
        } else {
          co_await start_run();
        }
        break;
      case State::kExecute:
        if (guided_) {
          co_await await_guided_touch();
        } else {
          co_await make_next_touch();
        }
        break;
      case State::kCompleting:
        co_await complete_run();
        break;
      case State::kSuspending:
        apply(Event::kDone);
        break;
      case State::kSuspended:
        co_await outlast_suspension();
        break;
      case State::kUnsuspending:
        co_await resume_run();
        break;
      case State::kStopping:
        if (shutting_down_) co_await leave_face();
        client_.finish();
        close_run(RunOutcome::kStopped);
        apply(Event::kDone);
        break;
      case State::kAborting:
        client_.finish();
        close_run(RunOutcome::kAborted);
        apply(Event::kDone);
        break;
      case State::kHolding:
        apply(Event::kDone);
        break;
      case State::kUnholding:
        co_await resume_run();
        break;
      case State::kClearing:
        // Whatever stopped the arm, the controller is met anew before the next run.
        client_.close();
        apply(Event::kDone);
        break;
      case State::kComplete:
      case State::kStopped:
      case State::kAborted:
      case State::kHeld:
        // A finished or interrupted run stays to be read while the link comes and goes.
        if (client_.connected() || (status_.state == State::kHeld && !interrupted_)) {
          co_await wait_for_wake(1h);
        } else {
          co_await connect();
        }
        break;
      default:
        co_await wait_for_wake(1h);
    }
  }
}

asio::awaitable<bool> Operation::plan() {
  planning_ = planning_problem(cell_, run_->recipe());
  const std::string recipe = run_->recipe().name;
  const State state = status_.state;
  // A stop does not wait for the planner: its answer comes, to be used another time.
  if (!planned(recipe)) asio::co_spawn(executor_, plan_recipe(recipe), [this](auto&&...) { wake_.cancel(); });
  while (!planned(recipe) && status_.state == state) co_await wait_for_wake(1h);
  if (status_.state != state) co_return false;
  const PlanOutcome outcome = *planned(recipe);
  if (const auto* refusal = std::get_if<PlanRefusal>(&outcome)) {
    raise({FaultCode::kRecipeUnreachable, refusal->message}, Event::kAbortFault);
    co_return false;
  }
  const Plan& plan = *std::get<std::shared_ptr<const Plan>>(outcome);
  if (const auto invalid = plan_fault(plan.touches.touches)) {
    raise(*invalid, Event::kAbortFault);
    co_return false;
  }
  run_->set_plan(plan.touches);
  try {
    store_.set_plan(run_->id(), run_->touches_total(), plan.id, plan.document);
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
    co_return false;
  }
  begin_aim();
  publish();
  co_return true;
}

asio::awaitable<void> Operation::start_run() {
  standing_.reset();
  const bool planned = co_await plan();
  if (!planned || status_.state != State::kStarting) co_return;
  const bool permitted = co_await get_permission();
  run_began_ = clock_();
  if (permitted) apply(Event::kDone);
}

asio::awaitable<void> Operation::resume_run() {
  standing_.reset();  // on hold the arm may have been moved by hand
  const bool resumable = co_await make_resumable();
  const bool goes_on = status_.state == State::kUnholding || status_.state == State::kUnsuspending;
  if (!resumable || !goes_on) co_return;
  const bool permitted = co_await get_permission();
  if (permitted) apply(Event::kDone);
}

/// Until what keeps the arm waiting has passed; nothing moves here.
asio::awaitable<void> Operation::outlast_suspension() {
  const auto is_back = [this] {
    const auto state = client_.latest_state();
    return state && state->monitor_speed_percent == 100;
  };
  while (status_.state == State::kSuspended && !is_back()) co_await wait_for_wake(1s);  // each state wakes
  if (status_.state != State::kSuspended) co_return;
  status_.fault.reset();
  apply(Event::kDone);
}

/// One touch. The arm does not wait for arithmetic: what the touch before tells and the way to the touch
/// behind are worked out while it moves.
asio::awaitable<void> Operation::make_next_touch() {
  held_by_ = HeldBy::kNothing;
  if (misfit_) {
    co_await touch_misfit_again();
    co_return;
  }
  if (reference_due()) {
    co_await touch_reference();
    co_return;
  }
  if (!run_->next()) {
    apply(Event::kDone);
    co_return;
  }
  const bool ready = co_await prepare_touch();
  if (!ready) co_return;
  const std::vector<calib::JointVector> via = std::move(ahead_->via);
  before_ = std::move(made_);
  made_ = std::move(ahead_->aimed);
  const int aimed_with = ahead_->aimed_with;
  const calib::PlannedTouch touch = made_->touch;
  made_way_ = calib::whole_path(ahead_->from, via, touch.clear_joints);
  made_way_.insert(made_way_.end(), {touch.approach_joints, touch.search_end_joints});
  ahead_.reset();
  standing_.reset();
  open_touch_ = OpenTouch{session_, client_.next_sequence(), touch, aimed_with};
  if (!keep_open_command()) co_return;
  auto answer = client_.touch(touch_command(cell_, touch, via));
  store_.make_durable(run_->id());
  identify();
  learn();
  look_ahead();
  const cs8::TouchReply reply = co_await std::move(answer);
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    open_touch_.reset();
    const OutcomeFault refused = fault_of(*rejected);
    held_by_ = HeldBy::kTouch;
    raise(refused.fault, refused.event());
  } else if (const auto* result = std::get_if<cs8::TouchResult>(&reply.answer)) {
    take_contact(touch, reply, *result);
  }  // a lost link has been told by lose()
}

/// The result of all touches so far, unless it is there.
void Operation::identify() {
  if (!run_ || !run_->identify()) return;
  publish();
}

/// A contact counts once it is stored; only then may the controller forget it.
void Operation::take_contact(const calib::PlannedTouch& planned, const cs8::TouchReply& reply,
                             const cs8::TouchResult& result) {
  if (!accept(planned, reply.sequence, result, HeldBy::kTouch)) return;
  const calib::PlannedTouch* of_plan = run_->next();
  if (of_plan) note_reference_place(*of_plan, result);
  if (!keep_touch(planned, result)) return;
  acknowledge(reply.sequence);
  missed_ = false;
  standing_ = planned.clear_joints;
  check_place(run_->problem().touches.back());
  // What comes next was aimed before this was known; it is aimed again first.
  if (is_surprise(from_wire(result.contact))) ahead_.reset();
  watch_fit();
}

/// A command that came neither to its end nor to a fault was stopped, as somebody asked; nobody else may.
void Operation::expect_stop(cs8::Outcome outcome) {
  const bool asked = status_.state == State::kStopping || status_.state == State::kAborting;
  if (outcome == cs8::Outcome::kStopped && asked) return;
  raise({FaultCode::kProtocolError,
         fmt::format("a command was answered with '{}', which nobody asked for", cs8::name(outcome))},
        Event::kAbortFault);
}

/// A contact of a run that is over: its stored result follows, its verdict does not change.
bool Operation::keep_late_touch(const calib::PlannedTouch& planned, const cs8::TouchResult& result) {
  if (!keep_touch(planned, result)) return false;
  identify();
  try {
    if (const auto document = result_json()) store_.set_result_json(run_->id(), *document);
  } catch (const std::exception& error) {
    spdlog::error("run {}: its result could not be stored: {}", run_->id(), error.what());
  }
  publish();
  return true;
}

/// Stores and counts a contact; false when it could not be stored, which ends the run.
bool Operation::keep_touch(const calib::PlannedTouch& planned, const cs8::TouchResult& result) {
  const OpenTouch answered = open_touch_.value_or(OpenTouch{});
  try {
    run_->add(store_, {.number = run_->touches_done() + 1,
                       .plane = planned.face + 1,
                       .role = planned.role,
                       .joints = result.contact,
                       .source = result.source,
                       .overtravel_dmm = result.overtravel_dmm,
                       .captured_at = now_text(),
                       .session = answered.session,
                       .sequence = answered.sequence,
                       .aimed_with = answered.aimed_with});
    const bool polled = result.source == cs8::CaptureSource::kPolled;
    spdlog::log(polled ? spdlog::level::warn : spdlog::level::info,
                "run {} touch {} on plane {}: {}{}, {} edge(s), overtravel {:.3f} mm", run_->id(),
                run_->touches_done(), planned.face + 1, cs8::name(result.source),
                polled ? ", late by up to 4 ms of its speed: check the latch" : "", result.edges,
                cs8::metres_from_dmm(result.overtravel_dmm) * 1e3);
    return true;
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, interrupted_ ? Event::kNotReadyFault : Event::kAbortFault);
    return false;
  }
}

/// True when the arm is where it was sent.
bool Operation::take_move(const cs8::MoveReply& reply) {
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    const OutcomeFault refused = fault_of(*rejected);
    const bool holds = refused.holds && status_.state == State::kExecute;
    raise(refused.fault, holds ? Event::kHoldFault : Event::kAbortFault);
    return false;
  }
  const auto* result = std::get_if<cs8::MoveResult>(&reply.answer);
  if (!result) return false;  // a lost link, which lose() tells
  client_.acknowledge(reply.sequence);
  if (result->outcome == cs8::Outcome::kArrived) return true;
  if (const auto fault = fault_of(result->outcome, result->phase, result->error_number)) {
    raise(fault->fault, Event::kAbortFault);
  } else {
    expect_stop(result->outcome);
  }
  return false;
}

asio::awaitable<void> Operation::complete_run() {
  const bool parked = co_await park();
  if (status_.state != State::kCompleting) co_return;
  if (!parked) {
    co_await wait_for_wake(20ms);  // the link is gone, and its loss is about to be told
    co_return;
  }
  const calib::IdentificationResult& result = run_->latest();
  if (result.status != calib::IdentificationStatus::kConverged) {
    status_.fault = Fault{FaultCode::kNotIdentifiable, result.message};
  }
  if (const auto bias = face_warning(result, cell_.acceptance.lack_of_fit_p_min)) warn(*bias);
  if (run_->skipped_count() > 0)
    warn({FaultCode::kTouchesLeftOut, fmt::format("{} by a person", run_->skipped_count())});
  client_.finish();
  close_run(RunOutcome::kComplete);
  apply(Event::kDone);
}

asio::awaitable<bool> Operation::park() {
  if (guided_) co_return true;  // the person does
  const auto from = co_await standing_joints();
  if (!from || status_.state != State::kCompleting) co_return false;
  const auto via = calib::find_aimed_transfer(planning_, *aim_, leaving(*from),
                                              {cell_.park_joints, std::nullopt, nullptr});
  if (!via) {
    raise({FaultCode::kNoSafeWay, "to the park posture"}, Event::kAbortFault);
    co_return false;
  }
  standing_.reset();
  const cs8::MoveReply reply = co_await client_.travel(travel_command(cell_, cell_.park_joints, *via));
  co_return take_move(reply);
}

/// The run is over: its verdict and its latest result are stored with it.
void Operation::close_run(RunOutcome outcome) {
  standing_.reset();
  if (!run_open_) return;
  run_open_ = false;
  run_finished_ = outcome == RunOutcome::kComplete && run_->skipped_count() == 0 &&
                  run_->latest().status == calib::IdentificationStatus::kConverged;
  const Judgement judgement = judge_by_rule(run_->latest(), run_->recipe().identification, cell_,
                                            run_->predicted_tip_rms_m(), run_finished_);
  status_.verdict = !run_finished_       ? Verdict::kIncomplete
                    : judgement.accepted ? Verdict::kAccepted
                                         : Verdict::kRejected;
  RunEnd end{.outcome = interrupted_ ? RunOutcome::kInterrupted : outcome,
             .verdict = status_.verdict,
             .ended_at = now_text(),
             .result_json = result_json()};
  if (status_.fault) {
    end.fault_code = std::string(describe(status_.fault->code).name);
    end.fault_message = status_.fault->message();
  }
  interrupted_.reset();
  try {
    store_.finish_run(run_->id(), end);
    if (status_.verdict == Verdict::kAccepted) {
      status_.last_accepted_run_id = run_->id();
      status_.last_accepted_at = end.ended_at;
    }
  } catch (const std::exception& error) {
    run_finished_ = false;  // what is not on the disk is not accepted
    status_.verdict = Verdict::kIncomplete;
    status_.fault = Fault{FaultCode::kStoreFailed, error.what()};
    spdlog::error("run {}: its end could not be stored: {}", run_->id(), error.what());
  }
  spdlog::info("run {} {}: {}, {} of {} touches", run_->id(), run_outcome_name(outcome),
               verdict_name(end.verdict), run_->touches_done(), run_->touches_total());
}

}  // namespace cell
