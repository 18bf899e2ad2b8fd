// What a TouchExecutor touches beside the plan: the reference place, and a touch that does not fit the
// others; and a person's word on them. Each co_await stands alone in its statement, see cs8_controller.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "service/acquisition/touch_executor.hpp"
#include "service/base/utc_time.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

/// Makes a touch as it is given, unless the contact of the last one is still to be stored; false when there
/// is no measurement. The controller keeps the contact until settle_beside_plan().
asio::awaitable<bool> TouchExecutor::touch_beside_plan(ActiveRun& active, calib::AimedTouch aimed,
                                                       HeldBy held_by) {
  if (beside_plan_) co_return true;
  const auto from = co_await session_.standing_joints();
  if (status_.state() != State::kExecute) co_return false;
  if (!from) {
    co_await wake_.wait(20ms);  // the link is lost; its hook is about to report it
    co_return false;
  }
  auto ready = preparation_.prepare(std::move(aimed), *from);
  if (!ready) {
    hold_without_way(*from, "to a place that was touched before", held_by);
    co_return false;
  }
  const OutgoingTouch outgoing = preparation_.send(*std::move(ready));
  session_.forget_standing();
  history_.last_contact.reset();  // this touch repeats an earlier place on purpose
  auto answer = session_.touch(touch_command(cell_, outgoing.touch, outgoing.via));
  identify(active);
  const cs8::TouchReply reply = co_await std::move(answer);
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    take_rejection(*rejected, held_by);
    co_return false;
  }
  const auto* result = std::get_if<cs8::TouchResult>(&reply.answer);
  if (!result) co_return false;  // a lost link was reported by the controller's hook
  if (!accept(active, outgoing.touch, reply.sequence, *result, held_by)) co_return false;
  beside_plan_ = {session_.number(), reply.sequence, *result};
  preparation_.set_missed(false);
  session_.set_standing(outgoing.touch.clear_joints);
  co_return true;
}

/// What the contact says is stored, or there is nothing to store: the controller may forget it.
void TouchExecutor::settle_beside_plan() {
  if (beside_plan_->session == session_.number()) session_.acknowledge(beside_plan_->sequence);
  beside_plan_.reset();
}

bool TouchExecutor::aim_at_reference() {
  if (reference_.aimed()) return true;
  auto made = preparation_.aim_or_nominal(reference_.planned());
  if (const auto* why = std::get_if<std::string>(&made)) {
    held_by_ = HeldBy::kReference;
    status_.raise({FaultCode::kNoSafeWay, "to the reference place: " + *why}, Event::kHoldFault);
    return false;
  }
  reference_.set_aimed(std::get<calib::AimedTouch>(std::move(made)));
  return true;
}

asio::awaitable<void> TouchExecutor::touch_reference(ActiveRun& active) {
  if (!aim_at_reference()) co_return;
  const bool touched = co_await touch_beside_plan(active, *reference_.aimed(), HeldBy::kReference);
  if (!touched) co_return;
  const Run& run = active.run;
  const calib::JointVector contact = from_wire(beside_plan_->result.contact);
  const auto height_m = [this](const calib::JointVector& joints) {
    return preparation_.height_m(reference_.planned().face, joints);
  };
  ReferenceMonitor with_contact = reference_;
  const ReferenceMonitor::Reading reading = with_contact.add_contact(contact, run.touches_done(), height_m);
  const double drift_mm = calib::mm_from_metres(reading.drift_m);
  const ReferenceTouch made{.number = reading.number,
                            .touches_done = run.touches_done(),
                            .joints = beside_plan_->result.contact,
                            .drift_mm = reading.told_m ? std::optional(drift_mm) : std::nullopt,
                            .captured_at = format_utc(clocks_.system())};
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
  active.run.note_references(there);
  active.run.identify();
  status_.publish();
  judge_reference(active, contact);
}

void TouchExecutor::judge_reference(const ActiveRun& active, const calib::JointVector& contact) {
  const auto height_m = [this](const calib::JointVector& joints) {
    return preparation_.height_m(reference_.planned().face, joints);
  };
  const ReferenceMonitor::Finding found = reference_.judge(contact, reference_drift_max_m(cell_), height_m);
  if (found.warning) status_.warn(*found.warning);
  if (found.hold) {
    held_by_ = HeldBy::kDrift;
    status_.raise(*found.hold, Event::kHoldFault);
    return;
  }
  if (stylus_allowed_) return;
  if (const auto other = stylus_fault(active.run.problem(), active.run.latest())) {
    held_by_ = HeldBy::kStylus;
    status_.raise(*other, Event::kHoldFault);
  }
}

asio::awaitable<void> TouchExecutor::retest_outlier(ActiveRun& active) {
  const bool touched = co_await touch_beside_plan(active, outlier_.aimed(), HeldBy::kOutlier);
  if (!touched) co_return;
  const cs8::TouchResult& result = beside_plan_->result;
  const int face = outlier_.aimed().touch.face;
  const StoredTouch& first = active.run.touches().back();
  StoredTouch again = first;
  again.joints = result.contact;
  again.source = result.source;
  again.overtravel_dmm = result.overtravel_dmm;
  again.captured_at = format_utc(clocks_.system());
  again.sequence = 0;  // no command of the plan
  const double apart_m = std::abs(preparation_.height_m(face, from_wire(again.joints)) -
                                  preparation_.height_m(face, from_wire(first.joints)));
  auto finding = outlier_.judge(first, again, apart_m, agreement_max_m(cell_));
  if (auto* replaced = std::get_if<OutlierRetest::Replaced>(&finding)) {
    const bool stored = co_await replace_last(active, std::move(*replaced));
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

asio::awaitable<bool> TouchExecutor::replace_last(ActiveRun& active, OutlierRetest::Replaced replaced) {
  const StoredTouch& again = replaced.again;
  const auto write = [id = active.run.id(), again](RunStore& store) {
    store.replace_touch(id, again, "it did not fit the others, its repetition does");
  };
  const auto failure = co_await store_.write(write);
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kHoldFault);
    co_return false;
  }
  active.run.replace_last(again);
  spdlog::warn("run {} touch {} is replaced by its repetition, which fits the others", active.run.id(),
               again.number);
  preparation_.set_aim(std::move(replaced.aim));
  outlier_.settle();
  status_.publish();
  co_return true;
}

void TouchExecutor::settle_hold(ActiveRun& active, Command command) {
  const bool retry = command == Command::kRetry, skip = command == Command::kSkip;
  if (skip && (held_by_ == HeldBy::kTouch || held_by_ == HeldBy::kOutlier)) leaves_out_ = held_by_;
  answer_ = command;
  const HeldBy held_by = std::exchange(held_by_, retry ? held_by_ : HeldBy::kNothing);
  if (held_by == HeldBy::kDrift && retry) reference_.look_again();
  if (held_by == HeldBy::kDrift && !retry) {
    reference_.allow_drift();
    status_.warn({FaultCode::kReferenceDrift, "a person lets the run go on"});
  }
  if (held_by == HeldBy::kReference && skip) reference_.skip(active.run.touches_done());
  if (held_by == HeldBy::kStylus) stylus_allowed_ = !retry;
  if (held_by == HeldBy::kOutlier && command == Command::kResume) {
    status_.warn({FaultCode::kTouchOutlier, fmt::format("touch {}", active.run.touches_done())});
    outlier_.settle();
  }
}

asio::awaitable<bool> TouchExecutor::store_answer(ActiveRun& active) {
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
    store.leave_out(id, changes, withdrawn);
  };
  const auto failure = co_await store_.write(write);
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kNotReadyFault);
    co_return false;
  }
  if (outlier) {
    run.withdraw_last();
    preparation_.set_aim(outlier_.without());
    outlier_.settle();
  }
  spdlog::warn("run {}: touch {} of the plan is left out, the run stays incomplete", run.id(), place + 1);
  run.skip_next();
  active.stored_changes = run.plan_changes().size();
  co_return true;
}

}  // namespace cell
