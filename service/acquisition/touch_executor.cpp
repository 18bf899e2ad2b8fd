// The touches of the plan; those beside it are in touch_executor_beside_plan.cpp, how answers are taken in
// touch_executor_answers.cpp. Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/touch_executor.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <boost/asio/experimental/awaitable_operators.hpp>
#include <exception>
#include <utility>

#include "service/acquisition/commanded_touch.hpp"
#include "service/acquisition/touch_ways.hpp"
#include "service/base/utc_time.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

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

/// What was stored of a command, of the store's thread until its write is over.
struct StoredCommand {
  std::size_t changes = 0;  // of the plan: what is stored before one fails is not stored again
  bool whole = false;
};

/// Stores what is needed to know the answer of a command again after a restart. `stored` must outlive it.
std::function<void(RunStore&)> storing_of(const ActiveRun& active, const OpenTouch& open,
                                          const std::vector<calib::JointVector>& path,
                                          StoredCommand& stored) {
  OpenCommand command{.session = open.session,
                      .sequence = open.sequence,
                      .aimed_with = open.aimed_with,
                      .touch_json = command_text(open.planned, path)};
  return [id = open.run_id, changes = active.changes_to_store(), command = std::move(command),
          &stored](RunStore& store) {
    for (; stored.changes < changes.size(); ++stored.changes)
      store.append_plan_change(id, changes[stored.changes]);
    store.set_open_command(id, command);
    stored.whole = true;
  };
}

}  // namespace

TouchExecutor::TouchExecutor(const Cell& cell, RunComputation& computation, StoreQueue& store,
                             ControllerSession& session, TouchPreparation& preparation, BlockMove& block_move,
                             PublishedStatus& status, Wake& wake, Clocks clocks)
    : cell_(cell),
      computation_(computation),
      store_(store),
      session_(session),
      preparation_(preparation),
      block_move_(block_move),
      status_(status),
      wake_(wake),
      clocks_(std::move(clocks)),
      refused_(store, session, clocks_) {}

void TouchExecutor::begin_run(const ActiveRun& active) {
  held_by_ = HeldBy::kNothing;
  history_ = {};
  outlier_.begin_run();
  beside_plan_.reset();  // of a run that ended before it could be stored: the controller has it until it is
  stored_ahead_.reset();
  reference_ahead_.reset();
  total_is_due_ = false;
  leaves_out_.reset();
  takes_block_word_ = has_moved_block_ = false;
  stylus_allowed_ = false;
  reference_.begin_run(active.run.recipe().reference_every);
  false_trigger_count_ = 0;
}

asio::awaitable<void> TouchExecutor::recall(ActiveRun& active) {
  const auto recall_last = [](TouchPreparation& preparation, Run& run) {
    preparation.recall(run);
    return preparation.next().has_value();
  };
  co_await computation_.prepared(preparation_, active.run, recall_last);
}

asio::awaitable<void> TouchExecutor::make_next_touch(ActiveRun& active) {
  held_by_ = HeldBy::kNothing;
  Run& run = active.run;
  if (run.moving_to()) {
    co_await ask_for_block(active);
    co_return;
  }
  const bool is_stored = take_stored_ahead(run);
  if (!is_stored) tell_kept();
  if (outlier_.is_due()) {
    co_await retest_outlier(active);
    co_return;
  }
  if (reference_.is_due(run.touches_done(), !run.next_here())) {
    co_await touch_reference(active);
    co_return;
  }
  if (!run.next_here()) {
    co_await end_touches(active);
    co_return;
  }
  const bool ready = co_await prepare(active);
  if (!ready) co_return;
  const OutgoingTouch outgoing = preparation_.send_next();
  const OpenTouch open{session_.number(), session_.next_sequence(), outgoing.touch, outgoing.aimed_with,
                       active.run.id()};
  if (is_stored) {
    session_.set_open_touch(open);
  } else {
    const bool kept = co_await keep_open_command(active, open);
    if (!kept) co_return;
  }
  session_.forget_standing();
  auto answer = session_.touch(touch_command(cell_, outgoing.touch, outgoing.via));
  using asio::experimental::awaitable_operators::operator&&;  // both at once
  auto answered = std::move(answer) && work_ahead(active);
  const cs8::TouchReply reply = co_await std::move(answered);
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    session_.drop_open_touch();
    forget_stored_command(run.id());
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
  session_.set_standing(*from);  // a State that tells otherwise meanwhile forgets it
  const auto find_way = [from = *from](TouchPreparation& preparation, Run& run) {
    return find_way_of_plan(preparation, run, from);
  };
  const WayOfPlan way = co_await computation_.prepared(preparation_, active.run, find_way);
  if (status_.state() != State::kExecute || !session_.standing()) co_return false;
  if (way.is_there) co_return true;
  const Run& run = active.run;
  const int plane = run.next()->face + 1;
  hold_without_way(way.can_leave, fmt::format("to touch {} on plane {}", run.touches_done() + 1, plane),
                   HeldBy::kTouch);
  co_return false;
}

/// A person can jog the arm to where there is a way, or leave the touch out.
void TouchExecutor::hold_without_way(bool can_leave, const std::string& to, HeldBy held_by) {
  held_by_ = held_by;
  session_.forget_standing();  // somebody is about to jog it
  const char* stuck = can_leave ? "" : "; where it stands it has no room to leave";
  status_.raise({FaultCode::kNoSafeWay, to + stuck}, Event::kHoldFault);
}

/// What is needed to know the answer again after a restart, kept before the command leaves. False when it
/// cannot be kept, or the state has changed meanwhile, or the arm has been moved: then the command must not
/// leave.
asio::awaitable<bool> TouchExecutor::keep_open_command(ActiveRun& active, OpenTouch open) {
  session_.set_open_touch(open);
  const bool stood = session_.standing().has_value();
  StoredCommand stored;
  const auto write = storing_of(active, open, preparation_.made_path(), stored);
  const auto failure = co_await store_.write(write);
  active.stored_changes += stored.changes;
  const bool has_moved = stood && !session_.standing();
  if (!failure && status_.state() == State::kExecute && !has_moved) co_return true;
  session_.drop_open_touch();
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kHoldFault);
  } else {
    forget_stored_command(open.run_id);
  }
  co_return false;
}

/// The command that follows a contact which is being stored; nothing where something else comes first, or
/// where it is not ready.
std::optional<OpenTouch> TouchExecutor::command_behind(const ActiveRun& active, bool contradicted) const {
  const Run& run = active.run;
  const bool all_made = !run.planned_here(run.touches_made() + 1);
  if (contradicted || all_made || reference_.is_due(run.touches_done() + 1, all_made)) return std::nullopt;
  if (status_.state() != State::kExecute || !session_.connected()) return std::nullopt;
  if (!preparation_.is_ready_from(preparation_.made()->touch.clear_joints)) return std::nullopt;
  const PreparedTouch& next = *preparation_.next();
  return OpenTouch{session_.number(), session_.next_sequence(), next.aimed.touch, next.aimed_with, run.id()};
}

/// True when the next touch was stored with the contact before it and nothing has come between.
bool TouchExecutor::take_stored_ahead(const Run& run) {
  const std::optional<OpenTouch> ahead = std::exchange(stored_ahead_, std::nullopt);
  if (!ahead) return false;
  const bool comes_next = !outlier_.is_due() && !reference_.is_due(run.touches_done(), !run.next_here());
  const bool is_its_number =
      ahead->session == session_.number() && ahead->sequence == session_.next_sequence();
  if (comes_next && is_its_number && session_.standing() && preparation_.is_ready_from(*session_.standing()))
    return true;
  forget_stored_command(run.id());
  return false;
}

/// While the arm moves.
asio::awaitable<void> TouchExecutor::work_ahead(ActiveRun& active) {
  // Where the answer fails, this is not broken off on the thread of the arithmetic.
  co_await asio::this_coro::reset_cancellation_state(asio::disable_cancellation());
  tell_kept();
  store_.behind([id = active.run.id()](RunStore& store) { store.make_durable(id); });
  co_await identify(active);
  const auto look = [reference = reference_](TouchPreparation& preparation, Run& run) {
    return look_ahead(preparation, run, reference);
  };
  LookAhead ahead = co_await computation_.prepared(preparation_, active.run, look);
  reference_ahead_ = std::move(ahead.to_reference);
  tell_left_out(active.run, ahead.dropped);
}

asio::awaitable<void> TouchExecutor::identify(ActiveRun& active) {
  if (!active.run.identification_is_due()) co_return;
  const Run identified = co_await computation_.identified(active.run.copy_to_identify());
  if (active.run.take_latest(identified)) status_.publish();
}

asio::awaitable<void> TouchExecutor::take_contact(ActiveRun& active, OpenTouch open,
                                                  cs8::TouchResult result) {
  const calib::PlannedTouch& touch = open.planned;
  const bool is_accepted = co_await accept(active, touch, open.sequence, result, HeldBy::kTouch);
  if (!is_accepted) co_return;
  const calib::JointVector contact = from_wire(result.contact);
  if (const calib::PlannedTouch* of_plan = active.run.next()) reference_.note_fitted(*of_plan, contact);
  const Storing storing = begin_storing(active.run, touch, result, open);
  calib::OnlineArmEstimate without = preparation_.aim();
  bool contradicted = false;
  std::optional<OpenTouch> next;
  std::exception_ptr unforeseen;              // what is stored counts all the same
  session_.set_standing(touch.clear_joints);  // a State that tells otherwise meanwhile forgets it
  try {
    const bool does_not_fit = co_await aim_ahead(active, storing.touch);
    contradicted = does_not_fit;
    next = command_behind(active, contradicted);
  } catch (...) {
    unforeseen = std::current_exception();
  }
  StoredCommand stored;
  std::function<void(RunStore&)> behind;
  if (next) behind = storing_of(active, *next, path_of(*preparation_.next()), stored);
  const bool kept = co_await finish_storing(active, storing, result.edges, behind);
  active.stored_changes += stored.changes;
  if (!kept) {
    session_.forget_standing();
    preparation_.set_aim(std::move(without));
    co_return;
  }
  session_.acknowledge(open.sequence);
  if (active.place_check) {
    if (const auto moved = active.place_check->check(active.run.problem().touches.back()))
      status_.raise(*moved, Event::kHoldFault);
  }
  if (contradicted) outlier_.begin({storing.touch.number, *preparation_.made(), std::move(without)});
  if (unforeseen || !stored.whole) tell_kept();
  if (unforeseen) std::rethrow_exception(unforeseen);
  if (!stored.whole) co_return;
  if (status_.state() == State::kExecute) {
    stored_ahead_ = next;
  } else {
    forget_stored_command(active.run.id());
    tell_kept();
  }
}

/// While the contact is stored. True for one that the others contradict.
asio::awaitable<bool> TouchExecutor::aim_ahead(ActiveRun& active, StoredTouch touch) {
  const auto aim = [touch = to_touch(touch), reference = reference_](TouchPreparation& preparation,
                                                                     Run& run) {
    return aim_behind(preparation, run, touch, reference);
  };
  AimBehindContact aimed = co_await computation_.prepared(preparation_, active.run, aim);
  if (aimed.is_surprise) reference_ahead_ = std::move(aimed.to_reference);
  co_return aimed.contradicted;
}

asio::awaitable<bool> TouchExecutor::keep(ActiveRun& active, calib::PlannedTouch planned,
                                          cs8::TouchResult result, std::optional<OpenTouch> answered,
                                          std::optional<double> noise_um) {
  const Storing storing = begin_storing(active.run, planned, result, answered, noise_um);
  const bool kept = co_await finish_storing(active, storing, result.edges, {});
  tell_kept();
  co_return kept;
}

TouchExecutor::Storing TouchExecutor::begin_storing(const Run& run, const calib::PlannedTouch& planned,
                                                    const cs8::TouchResult& result,
                                                    const std::optional<OpenTouch>& answered,
                                                    std::optional<double> noise_um) {
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
                          .noise_um = noise_um,
                          .first = first_contact_in(result),
                          .again = {}};
  const std::optional<int> total = total_is_due_ ? std::optional(run.touches_total()) : std::nullopt;
  auto total_stored = std::make_shared<bool>(false);
  const auto write = [id = run.id(), touch, total, total_stored](RunStore& store) {
    store.append_touch(id, touch);
    *total_stored = total && store_total(store, id, *total);
  };
  return {touch, store_.begin(write), total_stored};
}

/// As keep(); `behind` is stored on the same way, unless the contact could not be.
asio::awaitable<bool> TouchExecutor::finish_storing(ActiveRun& active, Storing storing, std::uint32_t edges,
                                                    std::function<void(RunStore&)> behind) {
  Run& run = active.run;
  const StoredTouch& touch = storing.touch;
  const auto failure = co_await store_.finish(storing.begun, std::move(behind));
  if (*storing.total_stored) total_is_due_ = false;
  if (failure) {
    tell_unstored(*failure);
    co_return false;
  }
  run.add(touch);
  kept_ = KeptLine{run.id(), touch, edges};
  co_return true;
}

}  // namespace cell
