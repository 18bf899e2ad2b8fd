// The touches of the plan, and how any touch is judged; those beside the plan are in
// touch_executor_beside_plan.cpp. Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/touch_executor.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/acquisition/commanded_touch.hpp"
#include "service/base/utc_time.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// This many false triggers in a run indicate a fault.
constexpr int kFalseTriggersMany = 3;

/// For the list of runs; the changes of the plan say the same, so that a failure is only tried again.
bool store_total(RunStore& store, std::int64_t run_id, int touches_total) {
  try {
    store.set_touches_total(run_id, touches_total);
    return true;
  } catch (const std::exception& error) {
    spdlog::warn("run {}: its number of touches could not be stored: {}", run_id, error.what());
    return false;
  }
}

}  // namespace

TouchExecutor::TouchExecutor(const Cell& cell, const TipRegions& regions, StoreQueue& store,
                             ControllerSession& session, TouchPreparation& preparation,
                             PublishedStatus& status, Wake& wake, Clocks clocks)
    : cell_(cell),
      regions_(regions),
      store_(store),
      session_(session),
      preparation_(preparation),
      status_(status),
      wake_(wake),
      clocks_(std::move(clocks)) {}

void TouchExecutor::begin_run(const ActiveRun& active) {
  held_by_ = HeldBy::kNothing;
  history_ = {};
  outlier_.settle();
  if (beside_plan_) settle_beside_plan();  // of a run that was stopped before it could be stored
  total_is_due_ = false;
  leaves_out_.reset();
  stylus_allowed_ = false;
  reference_.begin_run(active.run.recipe().reference_every);
  false_trigger_count_ = 0;
}

asio::awaitable<void> TouchExecutor::restore_reference(ActiveRun& active) {
  Run& run = active.run;
  reference_.begin_run(run.recipe().reference_every);
  const std::vector<StoredTouch>& made = run.touches();
  const auto first = std::ranges::find(made, calib::TouchRole::kFit, &StoredTouch::role);
  if (first == made.end() || run.recipe().reference_every == 0) co_return;
  const calib::PlannedTouch* planned = run.planned(static_cast<std::size_t>(first->number - 1));
  if (!planned) co_return;
  const auto read = [id = run.id()](RunStore& store) { return store.references(id); };
  const std::vector<ReferenceTouch> there = co_await store_.run(read);
  run.note_references(there);
  const auto reference = there.empty() ? std::nullopt : std::optional(from_wire(there.front().joints));
  reference_.restore(*planned, from_wire(first->joints), reference, there.empty() ? 0 : there.back().number);
}

void TouchExecutor::suspect_last(const ActiveRun& active) {
  const Run& run = active.run;
  const calib::PlannedTouch* planned = run.touches_made() > 0 ? run.planned(run.touches_made() - 1) : nullptr;
  if (!planned) return;
  calib::OnlineArmEstimate with = preparation_.aim();
  if (!with.add(run.problem().touches.back()).contradicts) return;
  auto made = preparation_.aim_or_nominal(*planned);
  if (auto* aimed = std::get_if<calib::AimedTouch>(&made))
    outlier_.begin(std::move(*aimed), preparation_.aim());
}

asio::awaitable<void> TouchExecutor::make_next_touch(ActiveRun& active) {
  held_by_ = HeldBy::kNothing;
  Run& run = active.run;
  if (outlier_.is_due()) {
    co_await retest_outlier(active);
    co_return;
  }
  if (reference_.is_due(run.touches_done(), !run.next())) {
    co_await touch_reference(active);
    co_return;
  }
  if (!run.next()) {
    status_.apply(Event::kDone);
    co_return;
  }
  const bool ready = co_await prepare(active);
  if (!ready) co_return;
  const OutgoingTouch outgoing = preparation_.send_next();
  const OpenTouch open{session_.number(), session_.next_sequence(), outgoing.touch, outgoing.aimed_with,
                       active.run.id()};
  const bool kept = co_await keep_open_command(active, open);
  if (!kept) co_return;
  session_.forget_standing();
  auto answer = session_.touch(touch_command(cell_, outgoing.touch, outgoing.via));
  work_ahead(active);
  const cs8::TouchReply reply = co_await std::move(answer);
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    session_.drop_open_touch();
    take_rejection(*rejected, HeldBy::kTouch);
  } else if (const auto* result = std::get_if<cs8::TouchResult>(&reply.answer)) {
    co_await take_contact(active, open, *result);
  }  // a lost link was reported by the controller's hook
}

/// True when the next touch is ready to be commanded; false when there is none or another state was entered.
asio::awaitable<bool> TouchExecutor::prepare(ActiveRun& active) {
  if (session_.standing() && preparation_.is_ready_from(*session_.standing())) co_return true;
  const auto from = co_await session_.standing_joints();
  if (status_.state() != State::kExecute) co_return false;
  if (!from) {
    co_await wake_.wait(20ms);  // the link is lost; its hook is about to report it
    co_return false;
  }
  Run& run = active.run;
  // An aimed touch is kept after a hold or a restart; only the path to it is planned again.
  if (preparation_.reroute_from(*from, *run.next())) co_return true;
  identify(active);
  preparation_.add_contacts(run);
  if (preparation_.prepare_next(run, *from)) co_return true;
  const int plane = run.next()->face + 1;
  hold_without_way(*from, fmt::format("to touch {} on plane {}", run.touches_done() + 1, plane),
                   HeldBy::kTouch);
  co_return false;
}

/// A person can jog the arm to where there is a way, or leave the touch out.
void TouchExecutor::hold_without_way(const calib::JointVector& from, const std::string& to, HeldBy held_by) {
  held_by_ = held_by;
  const char* stuck = preparation_.can_leave(from) ? "" : "; where it stands it has no room to leave";
  status_.raise({FaultCode::kNoSafeWay, to + stuck}, Event::kHoldFault);
}

/// What is needed to know the answer again after a restart, kept before the command leaves. False when it
/// cannot be kept, or the state has changed meanwhile, or the arm has been moved: then the command must not
/// leave.
asio::awaitable<bool> TouchExecutor::keep_open_command(ActiveRun& active, OpenTouch open) {
  const Run& run = active.run;
  session_.set_open_touch(open);
  const bool stood = session_.standing().has_value();
  const OpenCommand command{.session = open.session,
                            .sequence = open.sequence,
                            .aimed_with = open.aimed_with,
                            .touch_json = command_text(open.planned, preparation_.made_path())};
  std::size_t stored = 0;  // of the changes: what is stored before one fails is not stored again
  const auto write = [id = run.id(), changes = active.changes_to_store(), command, &stored](RunStore& store) {
    for (; stored < changes.size(); ++stored) store.append_plan_change(id, changes[stored]);
    store.set_open_command(id, command);
  };
  const auto failure = co_await store_.write(write);
  active.stored_changes += stored;
  const bool has_moved = stood && !session_.standing();
  if (!failure && status_.state() == State::kExecute && !has_moved) co_return true;
  session_.drop_open_touch();
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kHoldFault);
  } else {  // its sequence number belongs to the command that leaves next
    store_.behind([id = run.id()](RunStore& store) { store.forget_open_command(id); });
  }
  co_return false;
}

/// While the arm moves.
void TouchExecutor::work_ahead(ActiveRun& active) {
  store_.behind([id = active.run.id()](RunStore& store) { store.make_durable(id); });
  identify(active);
  preparation_.add_contacts(active.run);
  const std::size_t behind = active.run.touches_made() + 1;
  stop_when_good_enough(active, behind);
  preparation_.look_ahead(active.run, behind);
}

void TouchExecutor::identify(ActiveRun& active) {
  if (active.run.identify()) status_.publish();
}

/// A run that reached the accuracy it was asked for leaves out the touches that it would still fit.
void TouchExecutor::stop_when_good_enough(ActiveRun& active, std::size_t first) {
  Run& run = active.run;
  if (!run.meets_accuracy_goal()) return;
  const int dropped = run.drop_fit_touches(first);
  if (dropped == 0) return;
  spdlog::info("run {} is accurate enough: {} touches are left out", run.id(), dropped);
  total_is_due_ = true;
  status_.publish();
}

asio::awaitable<void> TouchExecutor::take_contact(ActiveRun& active, OpenTouch open,
                                                  cs8::TouchResult result) {
  const calib::PlannedTouch& touch = open.planned;
  if (!accept(active, touch, open.sequence, result, HeldBy::kTouch)) co_return;
  const calib::JointVector contact = from_wire(result.contact);
  if (const calib::PlannedTouch* of_plan = active.run.next()) reference_.note_fitted(*of_plan, contact);
  const bool kept = co_await keep(active, touch, result, open);
  if (!kept) co_return;
  session_.acknowledge(open.sequence);
  preparation_.set_missed(false);
  session_.set_standing(touch.clear_joints);
  if (active.place_check) {
    if (const auto moved = active.place_check->check(active.run.problem().touches.back()))
      status_.raise(*moved, Event::kHoldFault);
  }
  // What comes next was aimed before this was known; it is aimed again first.
  if (preparation_.is_surprise(contact)) preparation_.drop_next();
  watch_fit(active);
}

/// True when the answer is a measurement, which the caller keeps and acknowledges; else the answer is dealt
/// with.
bool TouchExecutor::accept(ActiveRun& active, const calib::PlannedTouch& touch, std::uint32_t sequence,
                           const cs8::TouchResult& result, HeldBy held_by) {
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
    return true;
  }
  session_.acknowledge(sequence);
  preparation_.drop_next();
  if (judged.next == TouchJudgement::Next::kStopped) {
    if (result.phase == cs8::Phase::kSearch) status_.warn({FaultCode::kStoppedInSearch, {}});
    session_.expect_stop(result.outcome);
    return false;
  }
  if (judged.fault.code == FaultCode::kFalseTrigger && ++false_trigger_count_ == kFalseTriggersMany)
    status_.warn({FaultCode::kFalseTriggersMany, fmt::format("{} in this run", false_trigger_count_)});
  if (judged.next == TouchJudgement::Next::kAgain) {
    ++history_.attempts;
    history_.spread_m = contact_spread_m(cell_, result);
    status_.warn(judged.fault);
    return false;
  }
  take_no_measurement(active, touch, judged, held_by);
  return false;
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

void TouchExecutor::take_rejection(const cs8::Rejected& rejected, HeldBy held_by) {
  const OutcomeFault refused = fault_of(rejected);
  held_by_ = held_by;
  status_.raise(refused.fault, refused.event());
  session_.meet_anew_after(rejected);
}

asio::awaitable<bool> TouchExecutor::keep(ActiveRun& active, calib::PlannedTouch planned,
                                          cs8::TouchResult result, std::optional<OpenTouch> answered,
                                          std::optional<double> noise_um) {
  Run& run = active.run;
  const StoredTouch touch{.number = run.touches_done() + 1,
                          .plane = planned.face + 1,
                          .role = planned.role,
                          .joints = result.contact,
                          .source = result.source,
                          .overtravel_dmm = result.overtravel_dmm,
                          .captured_at = format_utc(clocks_.system()),
                          .session = answered ? answered->session : 0,
                          .sequence = answered ? answered->sequence : 0,
                          .aimed_with = answered ? answered->aimed_with : 0,
                          .noise_um = noise_um};
  const std::optional<int> total = total_is_due_ ? std::optional(run.touches_total()) : std::nullopt;
  bool total_stored = false;
  const auto write = [id = run.id(), touch, total, &total_stored](RunStore& store) {
    store.append_touch(id, touch);
    total_stored = total && store_total(store, id, *total);
  };
  const auto failure = co_await store_.write(write);
  if (total_stored) total_is_due_ = false;
  if (failure) {
    // The controller keeps its answer until it is acknowledged: a run on hold stores it when it goes on, one
    // that has ended with its own fault when the cell is reset.
    const Fault fault{FaultCode::kStoreFailed, *failure};
    if (has_ended(status_.state())) {
      status_.warn(fault);
    } else {
      status_.raise(fault, status_.state() == State::kExecute ? Event::kHoldFault : Event::kNotReadyFault);
    }
    co_return false;
  }
  run.add(touch);
  const bool polled = result.source == cs8::CaptureSource::kPolled;
  spdlog::log(polled ? spdlog::level::warn : spdlog::level::info,
              "run {} touch {} on plane {}: {}{}, {} edge(s), overtravel {:.3f} mm", run.id(),
              run.touches_done(), planned.face + 1, cs8::name(result.source),
              polled ? ", late by up to 4 ms of its speed: check the latch" : "", result.edges,
              cs8::metres_from_dmm(result.overtravel_dmm) * 1e3);
  co_return true;
}

/// The newest touch is known to the aim at once; one that the others contradict is made again while the arm
/// is there.
void TouchExecutor::watch_fit(const ActiveRun& active) {
  calib::OnlineArmEstimate without = preparation_.aim();
  if (preparation_.add_contacts(active.run)) outlier_.begin(*preparation_.made(), std::move(without));
}

asio::awaitable<void> TouchExecutor::settle_open_command(ActiveRun* active, std::uint32_t sequence) {
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
      // It waits there until it can be stored.
      if (!active->open && !has_ended(status_.state())) status_.enter(State::kStopped);
      co_return;
    }
  }
  session_.acknowledge(sequence);
  if (judged && judged->next == TouchJudgement::Next::kFault && judged->event == Event::kAbortFault &&
      active->open)
    status_.raise(judged->fault, judged->event);
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
  identify(active);
  if (goes_on) aim_behind_late_touch(active, contact);
  if (const auto document = result_json(active, regions_)) {
    store_.behind([id = active.run.id(), json = *document, arm = arm_json(active, cell_)](RunStore& store) {
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
