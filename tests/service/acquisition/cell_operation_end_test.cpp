// How a run ends, on the disk and where the link is lost.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <algorithm>

#include "service/run/touch_command.hpp"
#include "service/store/refused_result.hpp"
#include "tests/service/acquisition/cell_operation_bench.hpp"

namespace cell {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

/// A run that a person ends while its first touch has been commanded and the link is lost: the controller is
/// there again soon, and has the answer still.
class EndedRunTest : public CellOperationTest {
 protected:
  EndedRunTest() {
    controller_->state->joints = to_wire(cell_of_owners().park_joints);
    controller_->state->permit = cs8::PermitState::kGranted;
    controller_->on_touch = [this](const cs8::Touch&) {
      controller_->is_connected = false;
      controller_->hooks.on_loss(ScriptedController::lost());
      EXPECT_FALSE(operation_.command(ends_by_));
      on_ended_();
      return ScriptedController::lost();
    };
    controller_->on_query = [](std::uint32_t) { return contact_of(0); };
    launch();
    controller_->on_connect = [this] {
      state_before_ = operation_.status().state;
      fault_before_ = fault();
      cs8::Welcome welcome;
      welcome.open_sequence = 1;
      return welcome;
    };
  }
  ~EndedRunTest() override { controller_->on_connect = ScriptedController::lost; }
  void run_until_asked(const std::string& what) {
    run_until([&] { return std::ranges::find(controller_->asked, what) != controller_->asked.end(); });
  }
  [[nodiscard]] std::string fault() const { return operation_.status().fault.value_or(Fault{}).message(); }

  Command ends_by_ = Command::kAbort;
  std::function<void()> on_ended_ = [] {};
  State state_before_ = State::kExecute;
  std::string fault_before_;
};

TEST_F(EndedRunTest, TakesTheAnswerThatTheControllerStillHasAndStaysAsItEnded) {
  const std::int64_t id = start_few();
  run_until_asked("acknowledge 1");
  EXPECT_EQ(state_before_, State::kAborted);
  EXPECT_EQ(operation_.status().state, State::kAborted);
  EXPECT_THAT(fault_before_, ::testing::HasSubstr("scripted"));
  EXPECT_EQ(fault(), fault_before_);
  EXPECT_EQ(store_.touches(id).size(), 1u);
  EXPECT_EQ(store_.run(id).value().outcome, RunOutcome::kAborted);
  EXPECT_EQ(operation_.status().verdict, Verdict::kIncomplete);
}

TEST_F(EndedRunTest, TakesItAlsoWhereItWasStopped) {
  ends_by_ = Command::kStop;
  const std::int64_t id = start_few();
  run_until_asked("acknowledge 1");
  EXPECT_EQ(operation_.status().state, State::kStopped);
  EXPECT_EQ(store_.touches(id).size(), 1u);
}

TEST_F(EndedRunTest, AnAnswerThatCannotBeStoredIsKeptByTheControllerUntilItCan) {
  on_ended_ = [this] {
    store_.database()->exec(
        "CREATE TRIGGER broken BEFORE INSERT ON touches BEGIN SELECT RAISE(ABORT, 'scripted'); END");
  };
  const std::int64_t id = start_few();
  run_until_asked("query 1");
  EXPECT_EQ(operation_.status().state, State::kAborted);
  EXPECT_EQ(fault(), fault_before_) << "why it ended stays to be read";
  EXPECT_EQ(operation_.status().warning.value().code, FaultCode::kStoreFailed);
  EXPECT_TRUE(store_.touches(id).empty());
  EXPECT_THAT(controller_->asked, ::testing::Not(Contains("acknowledge 1")));
  store_.database()->exec("DROP TRIGGER broken");
  EXPECT_FALSE(operation_.command(Command::kClear));
  run_until_asked("acknowledge 1");
  EXPECT_EQ(operation_.status().state, State::kStopped);
  EXPECT_EQ(store_.touches(id).size(), 1u);
}

TEST_F(EndedRunTest, AGuidedStartBesideItsAnswerTakesItForNoTouchOfItsOwn) {
  on_ended_ = [this] {
    store_.database()->exec(
        "CREATE TRIGGER broken BEFORE INSERT ON touches BEGIN SELECT RAISE(ABORT, 'scripted'); END");
  };
  const std::int64_t id = start_few();
  run_until_asked("query 1");
  EXPECT_FALSE(operation_.command(Command::kClear));
  run_until([&] { return operation_.status().state == State::kStopped; });
  store_.database()->exec("DROP TRIGGER broken");
  EXPECT_FALSE(operation_.command(Command::kAcknowledge));
  std::optional<std::variant<Started, CommandRefusal>> answer;
  controller_->on_query = [&](std::uint32_t) {
    boost::asio::co_spawn(io_, operation_.start({.recipe = "few", .guided = true}),
                          [&](const std::exception_ptr&, const std::variant<Started, CommandRefusal>& given) {
                            answer = given;
                          });
    return contact_of(0);
  };
  EXPECT_FALSE(operation_.command(Command::kReset));
  run_until([&] { return answer.has_value(); });
  const CommandRefusal refusal = std::get<CommandRefusal>(*answer);
  EXPECT_EQ(refusal.unmet.empty() ? "" : refusal.unmet.front().code, "");
  EXPECT_THAT(refusal.detail, ::testing::HasSubstr("still to be stored"));
  run_until_asked("acknowledge 1");
  EXPECT_EQ(store_.touches(id).size(), 1u) << "it is of the run that asked for it";
  EXPECT_EQ(store_.runs(10).size(), 1u);
}

TEST_F(EndedRunTest, ARunOnHoldTakesItTooAndTheTimeThatIsLeftIsThatOfItsWork) {
  ends_by_ = Command::kPause;
  start_few();
  run_until_asked("acknowledge 1");
  const double left_s = operation_.status().eta_s.value();
  time_.set_wall_clock(std::chrono::hours(1));
  time_.pass(std::chrono::hours(1));  // on hold
  controller_->state->flags &= ~static_cast<std::uint32_t>(cs8::kPowered);
  tell_state();
  ASSERT_EQ(operation_.status().controller.powered, false) << "the status is made anew";
  EXPECT_EQ(operation_.status().eta_s, left_s);
}

/// The daemon before ended its run while a touch was under way, and ended itself.
class AnswerLeftBehindTest : public CellOperationTest {};

TEST_F(AnswerLeftBehindTest, IsOnTheDiskBeforeTheControllerForgetsIt) {
  const std::int64_t id = store_.begin_run({.recipe = "few", .started_at = "start"});
  store_.set_open_command(id, {.session = 0, .sequence = 1, .touch_json = "{}"});
  store_.finish_run(id,
                    {.outcome = RunOutcome::kAborted, .verdict = Verdict::kIncomplete, .ended_at = "end"});
  const cs8::TouchResult left = contact_of(0);
  controller_->is_connected = false;
  controller_->on_query = [&](std::uint32_t) { return left; };
  controller_->on_connect = [] {
    cs8::Welcome welcome;
    welcome.open_sequence = 1;
    return welcome;
  };
  operation_.launch();
  run_until([&] { return operation_.status().state == State::kIdle; });
  controller_->on_connect = ScriptedController::lost;
  EXPECT_THAT(controller_->asked, Contains("acknowledge 1"));
  const std::vector<RefusedResult> kept = refused_results(store_, id);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].joints, left.contact);
  EXPECT_EQ(store_.run(id).value().outcome, RunOutcome::kAborted);
}

class UnstoredEndTest : public CellOperationTest {};

TEST_F(UnstoredEndTest, TheEndOfARunThatTheDiskDidNotTakeIsStoredWhenItDoes) {
  controller_->state->permit = cs8::PermitState::kGranted;
  controller_->on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  launch();
  const std::int64_t id = start_few();
  run_until([this] { return operation_.status().state == State::kExecute; });
  sqlite3* const handle = store_.database()->getHandle();
  sqlite3_commit_hook(
      handle, [](void*) { return 1; }, nullptr);
  EXPECT_FALSE(operation_.command(Command::kStop));
  run_until([this] { return operation_.status().state == State::kStopped; });
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kStoreFailed);
  EXPECT_EQ(store_.run(id).value().outcome, RunOutcome::kRunning);
  EXPECT_FALSE(operation_.command(Command::kReset));
  run_until([this] { return operation_.status().state == State::kIdle; });
  EXPECT_EQ(operation_.unmet_before_start().at(0).code, "store_not_writable");
  const auto exits = operation_.exits();
  EXPECT_EQ(std::ranges::count(exits, Command::kStart), 0);
  sqlite3_commit_hook(handle, nullptr, nullptr);
  EXPECT_EQ(std::get<CommandRefusal>(start({.recipe = "few"})).unmet.at(0).code, "store_not_writable");
  look_again_in(std::chrono::seconds(5));
  EXPECT_EQ(store_.run(id).value().outcome, RunOutcome::kStopped);
  EXPECT_THAT(operation_.unmet_before_start(), IsEmpty());
}

TEST_F(UnstoredEndTest, WhatEndedARunIsShownAgainOnceItsEndIsStored) {
  controller_->state->permit = cs8::PermitState::kGranted;
  sqlite3* const handle = store_.database()->getHandle();
  controller_->on_touch = [handle](const cs8::Touch&) {
    sqlite3_commit_hook(
        handle, [](void*) { return 1; }, nullptr);
    cs8::TouchResult collided;
    collided.outcome = cs8::Outcome::kCollision;
    return collided;
  };
  launch();
  const std::int64_t id = start_few();
  run_until([this] { return operation_.status().state == State::kAborted; });
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kStoreFailed);
  sqlite3_commit_hook(handle, nullptr, nullptr);
  look_again_in(std::chrono::seconds(5));
  EXPECT_EQ(store_.run(id).value().outcome, RunOutcome::kAborted);
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kCollision);
}

}  // namespace
}  // namespace cell
