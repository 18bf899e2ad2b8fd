// What a TouchExecutor touches beside the plan: the reference place, and a touch that does not fit the
// others; and a person's word on them. Each co_await stands alone in its
// statement, see cs8_controller.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <cmath>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "service/acquisition/touch_executor.hpp"
#include "service/acquisition/touch_ways.hpp"
#include "service/base/utc_time.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

asio::awaitable<void> TouchExecutor::restore_reference(ActiveRun& active) {
  Run& run = active.run;
  reference_.begin_run(run.recipe().reference_every);
  const std::vector<StoredTouch>& made = run.touches();
  const auto first = std::ranges::find_if(made, [&](const StoredTouch& touch) {
    return touch.role == calib::TouchRole::kFit && run.place_of(touch.plane - 1) == run.place();
  });
  if (run.recipe().reference_every == 0) co_return;
  const auto read = [id = run.id()](RunStore& store) { return store.references(id); };
  const std::vector<ReferenceTouch> all = co_await store_.run(read);
  run.note_references(all);
  if (run.moving_to() || first == made.end()) {
    reference_.begin_place(static_cast<int>(all.size()));
    co_return;
  }
  const calib::PlannedTouch* planned = run.planned(static_cast<std::size_t>(first->number - 1));
  if (!planned) co_return;
  const auto here = std::ranges::find_if(
      all, [&](const ReferenceTouch& touch) { return touch.touches_done >= first->number; });
  const auto reference = here == all.end() ? std::nullopt : std::optional(from_wire(here->joints));
  reference_.restore(*planned, from_wire(first->joints), reference, static_cast<int>(here - all.begin()),
                     static_cast<int>(all.end() - here));
}

/// Makes a touch as it is given, unless the contact of the last one is still to be stored; false when there
/// is no measurement. The controller keeps the contact until settle_beside_plan().
asio::awaitable<bool> TouchExecutor::touch_beside_plan(ActiveRun& active, calib::AimedTouch aimed,
                                                       HeldBy held_by) {
  if (beside_plan_ && beside_plan_->refused) {
    const bool stored = co_await refuse_beside_plan(active.run.id());
    if (!stored) co_return false;
  }
  if (beside_plan_) co_return true;
  std::optional<PreparedTouch> ready = co_await prepare_beside_plan(active, std::move(aimed), held_by);
  if (!ready) co_return false;
  const OutgoingTouch outgoing = preparation_.send(*std::move(ready));
  session_.forget_standing();
  history_.last_contact.reset();  // this touch repeats an earlier place on purpose
  auto answer = session_.touch(touch_command(cell_, outgoing.touch, outgoing.via));
  const calib::JointVector& leaves_from = outgoing.touch.clear_joints;
  using asio::experimental::awaitable_operators::operator&&;  // both at once
  auto answered = std::move(answer) && work_beside_plan(active, held_by, leaves_from);
  const cs8::TouchReply reply = co_await std::move(answered);
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    take_rejection(*rejected, held_by);
    co_return false;
  }
  const auto* result = std::get_if<cs8::TouchResult>(&reply.answer);
  if (!result) co_return false;  // a lost link was reported by the controller's hook
  const bool is_accepted = co_await accept(active, outgoing.touch, reply.sequence, *result, held_by);
  if (!is_accepted) co_return false;
  beside_plan_ = {session_.number(), reply.sequence, *result, format_utc(clocks_.system())};
  session_.note_unsettled(reply.sequence);
  preparation_.set_missed(false);
  session_.set_standing(outgoing.touch.clear_joints);
  co_return true;
}

/// The touch with its way; nothing where there is none, or where another state was entered or the arm moved.
asio::awaitable<std::optional<PreparedTouch>> TouchExecutor::prepare_beside_plan(ActiveRun& active,
                                                                                 calib::AimedTouch aimed,
                                                                                 HeldBy held_by) {
  const auto from = co_await session_.standing_joints();
  if (status_.state() != State::kExecute) co_return std::nullopt;
  if (!from) {
    co_await wake_.wait(20ms);  // the link is lost; its hook is about to report it
    co_return std::nullopt;
  }
  std::optional<PreparedTouch> ahead = std::exchange(reference_ahead_, std::nullopt);
  if (ahead && held_by == HeldBy::kReference && ahead->from == *from) co_return ahead;
  session_.set_standing(*from);  // a State that tells otherwise meanwhile forgets it
  const auto find_way = [from = *from, aimed = std::move(aimed)](const TouchPreparation& preparation,
                                                                 const Run&) {
    return find_way_beside_plan(preparation, aimed, from);
  };
  WayBesidePlan way = co_await computation_.prepared(preparation_, active.run, find_way);
  if (status_.state() != State::kExecute || !session_.standing()) co_return std::nullopt;
  if (!way.touch) hold_without_way(way.can_leave, "to a place that was touched before", held_by);
  co_return std::move(way.touch);
}

/// While the arm moves.
asio::awaitable<void> TouchExecutor::work_beside_plan(ActiveRun& active, HeldBy held_by,
                                                      calib::JointVector from) {
  co_await asio::this_coro::reset_cancellation_state(asio::disable_cancellation());  // as work_ahead()
  co_await identify(active);
  if (held_by != HeldBy::kReference) co_return;
  const auto look = [from](TouchPreparation& preparation, Run& run) {
    return look_ahead_from_reference(preparation, run, from);
  };
  co_await computation_.prepared(preparation_, active.run, look);
}

/// What the contact says is stored, or there is nothing to store: the controller may forget it.
void TouchExecutor::settle_beside_plan() {
  if (beside_plan_->session == session_.number()) session_.acknowledge(beside_plan_->sequence);
  beside_plan_.reset();
}

asio::awaitable<bool> TouchExecutor::aim_at_reference(ActiveRun& active) {
  if (reference_.aimed()) co_return true;
  const auto aim = [planned = reference_.planned()](const TouchPreparation& preparation, const Run&) {
    return preparation.aim_or_nominal(planned);
  };
  auto made = co_await computation_.prepared(preparation_, active.run, aim);
  if (status_.state() != State::kExecute) co_return false;
  if (const auto* why = std::get_if<std::string>(&made)) {
    held_by_ = HeldBy::kReference;
    status_.raise({FaultCode::kNoSafeWay, "to the reference place: " + *why}, Event::kHoldFault);
    co_return false;
  }
  reference_.set_aimed(std::get<calib::AimedTouch>(std::move(made)));
  co_return true;
}

asio::awaitable<void> TouchExecutor::touch_reference(ActiveRun& active) {
  const bool is_aimed = co_await aim_at_reference(active);
  if (!is_aimed) co_return;
  const bool touched = co_await touch_beside_plan(active, *reference_.aimed(), HeldBy::kReference);
  if (!touched) co_return;
  const Run& run = active.run;
  const calib::JointVector contact = from_wire(beside_plan_->result.contact);
  const auto height_m = [this](const calib::JointVector& joints) {
    return preparation_.height_m(reference_.planned().face, joints);
  };
  if (const auto doubt = reference_.doubt(contact, reference_drift_max_m(cell_), height_m)) {
    co_await doubt_reference(run.id(), *doubt);
    co_return;
  }
  ReferenceMonitor with_contact = reference_;
  const ReferenceMonitor::Reading reading = with_contact.add_contact(contact, run.touches_done(), height_m);
  const double drift_mm = calib::mm_from_metres(reading.drift_m);
  const ReferenceTouch made{.number = reading.number,
                            .touches_done = run.touches_done(),
                            .joints = beside_plan_->result.contact,
                            .drift_mm = reading.told_m ? std::optional(drift_mm) : std::nullopt,
                            .captured_at = beside_plan_->captured_at};
  std::vector<ReferenceTouch> there;
  const auto write = [id = run.id(), made, &there](RunStore& store) {
    store.append_reference(id, made);
    there = store.references(id);
  };
  const auto failure = co_await store_.write(write);
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kHoldFault);
    co_return;
  }
  settle_beside_plan();
  reference_ = std::move(with_contact);
  if (reading.told_m) status_.set_reference_drift(*reading.told_m);
  spdlog::info("run {} reference touch {}: drift {:.3f} mm", run.id(), reading.number, drift_mm);
  active.run.note_references(there);  // identified while the arm moves on
  status_.publish();
  judge_reference(active);
}

/// The contact is no reference, and no measurement.
asio::awaitable<void> TouchExecutor::doubt_reference(std::int64_t run_id, ReferenceMonitor::Doubt doubt) {
  const Fault& why = doubt.warning ? *doubt.warning : *doubt.hold;
  if (doubt.warning) {
    status_.warn(why);
  } else {
    held_by_ = HeldBy::kDrift;
    status_.raise(why, Event::kHoldFault);
  }
  beside_plan_->refused = why.message();
  co_await refuse_beside_plan(run_id);
}

/// Until it is stored the run has it, whatever becomes of the controller. False when it could not be, which
/// holds the run.
asio::awaitable<bool> TouchExecutor::refuse_beside_plan(std::int64_t run_id) {
  const BesidePlan contact = *beside_plan_;
  const bool stored =
      co_await refuse(run_id, {contact.session, contact.sequence}, contact.result, *contact.refused);
  if (stored) beside_plan_.reset();
  co_return stored;
}

void TouchExecutor::judge_reference(const ActiveRun& active) {
  if (const auto drifted = reference_.drift_fault(reference_drift_max_m(cell_))) {
    held_by_ = HeldBy::kDrift;
    status_.raise(*drifted, Event::kHoldFault);
    return;
  }
  if (stylus_allowed_) return;
  if (const auto other = stylus_fault(active.run.problem(), active.run.latest())) {
    held_by_ = HeldBy::kStylus;
    status_.raise(*other, Event::kHoldFault);
  }
}

asio::awaitable<void> TouchExecutor::retest_outlier(ActiveRun& active) {
  const bool touched = co_await touch_beside_plan(active, outlier_.suspect().aimed, HeldBy::kOutlier);
  if (!touched) co_return;
  const cs8::TouchResult& result = beside_plan_->result;
  const int face = outlier_.suspect().aimed.touch.face;
  const StoredTouch& first = active.run.touches().at(static_cast<std::size_t>(outlier_.suspect().number - 1));
  StoredTouch again = first;
  again.joints = result.contact;
  again.source = result.source;
  again.overtravel_dmm = result.overtravel_dmm;
  again.captured_at = beside_plan_->captured_at;  // once more where it could not be stored: it is the same
  again.sequence = 0;                             // no command of the plan
  again.first = first_contact_in(result);
  again.again.reset();
  const double apart_m = std::abs(preparation_.height_m(face, from_wire(again.joints)) -
                                  preparation_.height_m(face, from_wire(first.joints)));
  auto finding = outlier_.judge(first, again, apart_m, agreement_max_m(cell_));
  if (auto* replaced = std::get_if<OutlierRetest::Replaced>(&finding)) {
    const bool stored = co_await replace(active, std::move(*replaced));
    if (!stored) co_return;
  } else if (OutlierRetest::is_pair(first, again, apart_m, agreement_max_m(cell_))) {
    const bool stored = co_await confirm(active, again);
    if (!stored) co_return;
  }
  settle_beside_plan();
  if (const auto* confirmed = std::get_if<OutlierRetest::Confirmed>(&finding)) {
    status_.warn(confirmed->warning);
    outlier_.settle();
  } else if (const auto* held = std::get_if<OutlierRetest::Held>(&finding)) {
    held_by_ = HeldBy::kOutlier;
    status_.raise(held->fault, Event::kHoldFault);
  }
}

asio::awaitable<bool> TouchExecutor::replace(ActiveRun& active, OutlierRetest::Replaced replaced) {
  const StoredTouch& again = replaced.again;
  const auto write = [id = active.run.id(), again](RunStore& store) {
    store.replace_touch(id, again, "it did not fit the others, its repetition does");
  };
  const auto failure = co_await store_.write(write);
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kHoldFault);
    co_return false;
  }
  active.run.replace(again);
  spdlog::warn("run {} touch {} is replaced by its repetition, which fits the others", active.run.id(),
               again.number);
  preparation_.set_aim(std::move(replaced.aim));
  outlier_.settle();
  status_.publish();
  co_return true;
}

/// The repetition is kept with the touch, which stays: their difference is noise of a touch.
asio::awaitable<bool> TouchExecutor::confirm(ActiveRun& active, StoredTouch again) {
  const auto write = [id = active.run.id(), number = again.number, joints = again.joints](RunStore& store) {
    store.confirm_touch(id, number, joints);
  };
  const auto failure = co_await store_.write(write);
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kHoldFault);
    co_return false;
  }
  active.run.confirm(again.number, again.joints);
  co_return true;
}

void TouchExecutor::settle_hold(ActiveRun& active, Command command) {
  const bool retry = command == Command::kRetry, skip = command == Command::kSkip;
  // One that is made again at the end stays as it was: the result leaves it out.
  const bool only_again = held_by_ == HeldBy::kOutlier && outlier_.is_due() && outlier_.suspect().at_end;
  if (skip && !only_again && (held_by_ == HeldBy::kTouch || held_by_ == HeldBy::kOutlier))
    leaves_out_ = held_by_;
  answer_ = command;
  const HeldBy held_by = std::exchange(held_by_, retry ? held_by_ : HeldBy::kNothing);
  if (held_by == HeldBy::kDrift && retry) reference_.look_again();
  if (held_by == HeldBy::kDrift && !retry) {
    reference_.allow_drift();
    status_.warn({FaultCode::kReferenceDrift, "a person lets the run go on"});
  }
  if (held_by == HeldBy::kReference && skip) reference_.skip(active.run.touches_done());
  if (held_by == HeldBy::kStylus) stylus_allowed_ = !retry;
  if (held_by == HeldBy::kBlock) takes_block_word_ = true;
  if (only_again && skip) outlier_.settle();
  if (held_by == HeldBy::kOutlier && command == Command::kResume) {
    status_.warn(outlier_.warning_of({outlier_.suspect().number}));
    outlier_.settle();
  }
}

asio::awaitable<bool> TouchExecutor::store_answer(ActiveRun& active) {
  if (takes_block_word_) {
    takes_block_word_ = false;
    has_moved_block_ = co_await block_move_.take_word(active);
    if (!has_moved_block_) held_by_ = HeldBy::kBlock;
    co_return has_moved_block_;
  }
  if (!leaves_out_) co_return true;
  const bool stored = co_await leave_out(active, *leaves_out_ == HeldBy::kOutlier);
  if (!stored) held_by_ = *leaves_out_;
  leaves_out_.reset();
  co_return stored;
}

/// The touch that holds the run, with the contact that does not fit where it is an `outlier`. Stored in one
/// piece before it counts; false when that could not be.
asio::awaitable<bool> TouchExecutor::leave_out(ActiveRun& active, bool outlier) {
  Run& run = active.run;
  std::vector<PlanChange> changes = active.changes_to_store();
  const int place = static_cast<int>(run.touches_made()) - (outlier ? 1 : 0);
  changes.push_back({PlanChange::Kind::kSkip, place});
  std::optional<Withdrawal> withdrawn;
  if (outlier)
    withdrawn = Withdrawal{.number = run.touches().back().number,
                           .reason = "it did not fit the others, and a person left it out"};
  const auto write = [id = run.id(), changes, withdrawn](RunStore& store) {
    store.change_plan(id, changes, withdrawn);
  };
  const auto failure = co_await store_.write(write);
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kNotReadyFault);
    co_return false;
  }
  if (outlier) {
    run.withdraw_last();
    reference_.forget_untouched();
    preparation_.set_aim(outlier_.suspect().without);
    outlier_.settle();
  }
  spdlog::warn("run {}: touch {} of the plan is left out, the run stays incomplete", run.id(), place + 1);
  run.skip_next();
  active.stored_changes = run.plan_changes().size();
  co_return true;
}

}  // namespace cell
