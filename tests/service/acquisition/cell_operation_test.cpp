#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <algorithm>
#include <memory>

#include "cs8_protocol/wire_units.hpp"
#include "service/documents/configuration_digest.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/cell_operation_bench.hpp"

namespace cell {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

TEST_F(CellOperationTest, FindsItsControllerAndIsIdleOnceNothingStandsInTheWay) {
  controller_->is_connected = false;
  controller_->state->mode = cs8::WorkingMode::kManual;
  launch();
  EXPECT_THAT(controller_->asked, Contains("connect"));
  EXPECT_EQ(operation_.status().state, State::kResetting);
  EXPECT_EQ(operation_.unmet_preconditions().size(), 1u);
  EXPECT_EQ(operation_.status().waiting_for, "remote_mode");
  controller_->state->mode = cs8::WorkingMode::kRemote;
  tell_state();
  EXPECT_EQ(operation_.status().state, State::kIdle);
  EXPECT_THAT(operation_.unmet_preconditions(), IsEmpty());
  EXPECT_EQ(operation_.status().waiting_for, std::nullopt);
  controller_->state->monitor_speed_percent = 50;
  tell_state();
  EXPECT_EQ(operation_.status().waiting_for, "monitor_speed");
}

TEST_F(CellOperationTest, AStartThatIsRefusedSaysWhy) {
  launch();
  const auto kind = [](const std::variant<Started, CommandRefusal>& answer) {
    return std::get<CommandRefusal>(answer).kind;
  };
  EXPECT_EQ(kind(start({.recipe = "none"})), CommandRefusal::Kind::kUnknownRecipe);
  EXPECT_EQ(kind(start({.kind = RunKind::kProof, .of_run = 99})), CommandRefusal::Kind::kUnknownRun);
  controller_->state->flags &= ~static_cast<std::uint32_t>(cs8::kPowered);
  EXPECT_EQ(kind(start({.recipe = "few"})), CommandRefusal::Kind::kPreconditions);
  EXPECT_THAT(store_.runs(10), IsEmpty());
}

TEST_F(CellOperationTest, ARunIsStartedOnceForOneKeyAndNoOtherBesideIt) {
  launch();
  const auto first = start({.recipe = "few", .idempotency_key = "key"});
  const auto again = start({.recipe = "few", .idempotency_key = "key"});
  EXPECT_EQ(std::get<Started>(first).run.id, std::get<Started>(again).run.id);
  EXPECT_TRUE(std::get<Started>(again).repeated);
  EXPECT_EQ(std::get<CommandRefusal>(start({.recipe = "few"})).code, FaultCode::kRunActive);
  EXPECT_EQ(operation_.status().state, State::kStarting);
}

TEST_F(CellOperationTest, AStopWhileTheStartIsStoredLeavesNoRunAndItsKeyIsNewAgain) {
  launch();
  sqlite3* const handle = store_.database()->getHandle();
  sqlite3_commit_hook(
      handle,
      [](void* operation) {
        static_cast<CellOperation*>(operation)->command(Command::kStop);
        return 0;
      },
      &operation_);
  const auto refused = start({.recipe = "few", .idempotency_key = "key"});
  sqlite3_commit_hook(handle, nullptr, nullptr);
  EXPECT_EQ(std::get<CommandRefusal>(refused).code, FaultCode::kNotInThisState);
  EXPECT_EQ(operation_.status().state, State::kStopped);
  EXPECT_THAT(store_.runs(10), IsEmpty());
  EXPECT_FALSE(operation_.command(Command::kReset));
  tell_state();
  const auto again = start({.recipe = "few", .idempotency_key = "key"});
  EXPECT_FALSE(std::get<Started>(again).repeated);
}

TEST_F(CellOperationTest, ACommandThatNamesAnotherRunIsRefused) {
  launch();
  EXPECT_EQ(operation_.command(Command::kStop, 99).value().kind, CommandRefusal::Kind::kNotThisRun);
  EXPECT_EQ(operation_.command(Command::kResume).value().code, FaultCode::kNotInThisState);
}

TEST_F(CellOperationTest, NoStateIsADeadEndAndNoExitIsRefused) {
  launch();
  EXPECT_THAT(operation_.exits(), IsSupersetOf({Command::kStart, Command::kStop}));
  EXPECT_FALSE(operation_.command(Command::kStop));
  EXPECT_EQ(operation_.status().state, State::kStopped);
  EXPECT_THAT(operation_.exits(), Contains(Command::kReset));
}

TEST_F(CellOperationTest, AStartIsNamedAsAnExitOnlyWhereItIsTaken) {
  launch();
  ASSERT_EQ(operation_.status().state, State::kIdle);
  controller_->state->flags &= ~static_cast<std::uint32_t>(cs8::kPowered);
  tell_state();
  ASSERT_EQ(operation_.status().state, State::kIdle);
  EXPECT_THAT(operation_.exits(), ::testing::Not(Contains(Command::kStart)));
  EXPECT_THAT(operation_.exits(), Contains(Command::kStop));
  controller_->state->flags |= cs8::kPowered;
  tell_state();
  EXPECT_THAT(operation_.exits(), Contains(Command::kStart));
}

TEST_F(CellOperationTest, EveryStopIsSentToTheControllerWhateverTheState) {
  launch();
  const auto sent_by = [this](Command command) {
    controller_->asked.clear();
    EXPECT_FALSE(operation_.command(command));
    return std::ranges::count(controller_->asked, "stop");
  };
  EXPECT_EQ(sent_by(Command::kStop), 1) << "IDLE";
  EXPECT_EQ(sent_by(Command::kStop), 1) << "STOPPED";
  EXPECT_FALSE(operation_.command(Command::kReset));
  tell_state();
  ASSERT_TRUE(std::holds_alternative<Started>(start({.recipe = "few"})));
  EXPECT_EQ(sent_by(Command::kStop), 1) << "STARTING";
  ASSERT_EQ(operation_.status().state, State::kStopping);
  EXPECT_EQ(sent_by(Command::kStop), 1) << "STOPPING";
  EXPECT_EQ(sent_by(Command::kAbort), 1);
  ASSERT_EQ(operation_.status().state, State::kAborting);
  EXPECT_THAT(operation_.exits(), ::testing::ElementsAre(Command::kStop));
  EXPECT_EQ(sent_by(Command::kStop), 1) << "ABORTING";
}

TEST_F(CellOperationTest, ALostLinkIsAFaultAndLookedForAgain) {
  launch();
  controller_->is_connected = false;
  controller_->asked.clear();
  controller_->hooks.on_loss({cs8::LinkErrorKind::kSilent, "nothing was heard"});
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kLinkLost);
  EXPECT_EQ(operation_.status().state, State::kResetting);
  io_.restart();
  io_.poll();
  EXPECT_THAT(controller_->asked, Contains("connect"));
  EXPECT_FALSE(operation_.status().fault) << "it ended with the link";
}

TEST_F(CellOperationTest, AnErrorThatNobodyForesawEndsTheRunAndNotTheDaemon) {
  launch();
  controller_->on_begin = [](std::uint32_t) -> cs8::PermitReply { throw std::runtime_error("scripted"); };
  ASSERT_TRUE(std::holds_alternative<Started>(start({.recipe = "few"})));
  io_.restart();
  while (operation_.status().state != State::kAborted) io_.run_one();
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kInternalError);
  EXPECT_THAT(controller_->asked, Contains("stop"));
  EXPECT_EQ(store_.runs(1).front().outcome, RunOutcome::kAborted);
  EXPECT_FALSE(operation_.command(Command::kClear));
}

/// A run that a daemon left open, which a person resumes and which waits then for its plan or its permit.
class ResumedOperationTest : public CellOperationTest {
 protected:
  ResumedOperationTest() {
    const Plan& plan = plan_of_owners();
    id_ = store_.begin_run({.recipe = "few",
                            .started_at = "start",
                            .config_digest = configuration_digest(cell_of_owners()),
                            .conditions_json = "{}"});
    store_.set_plan(id_, static_cast<int>(plan.touches.touches.size()), plan.id, plan.document);
    launch();
    EXPECT_EQ(operation_.status().state, State::kHeld);
    controller_->asked.clear();
  }
  void expect_left_for_the_next_daemon() {
    EXPECT_EQ(operation_.status().state, State::kHeld);
    EXPECT_EQ(store_.run(id_).value().outcome, RunOutcome::kRunning);
    EXPECT_THAT(controller_->asked, ::testing::Each(::testing::Not(::testing::StartsWith("touch"))));
  }

  std::int64_t id_ = 0;
};

TEST_F(ResumedOperationTest, IsLeftWhereTheDaemonEndsWhileItIsPlanned) {
  EXPECT_FALSE(operation_.command(Command::kResume));
  ASSERT_EQ(operation_.status().state, State::kUnholding);
  shut_down();
  expect_left_for_the_next_daemon();
  EXPECT_THAT(controller_->asked, ::testing::Not(Contains(::testing::StartsWith("begin"))));
}

TEST_F(ResumedOperationTest, DoesNotMoveWhereTheDaemonEndsWhileItsPermitIsAwaited) {
  controller_->on_begin = [](std::uint32_t run) {
    cs8::Permit refused;
    refused.run = run;
    refused.reason = cs8::PermitReason::kRefused;
    refused.detail = static_cast<std::int32_t>(cs8::RejectReason::kCellOpen);
    return refused;
  };
  EXPECT_FALSE(operation_.command(Command::kResume));
  io_.restart();
  while (operation_.status().waiting_for != "cell_closed") io_.run_one();
  controller_->on_begin = [](std::uint32_t run) {
    return cs8::Permit{.run = run, .state = cs8::PermitState::kGranted};
  };
  controller_->state->flags &= ~static_cast<std::uint32_t>(cs8::kCellClosed);  // what it waits for
  shut_down();
  expect_left_for_the_next_daemon();
}

TEST_F(ResumedOperationTest, IsConfirmedAgainBehindALongHoldOnly) {
  const auto resume_and_pause = [this] {
    EXPECT_FALSE(operation_.command(Command::kResume));
    io_.restart();
    while (operation_.status().state != State::kExecute) io_.run_one();
    EXPECT_FALSE(operation_.command(Command::kPause));
    while (operation_.status().state != State::kHeld) io_.run_one();
    return std::ranges::count(controller_->asked, "begin " + std::to_string(id_));
  };
  EXPECT_EQ(resume_and_pause(), 1);
  time_.pass(cell_of_owners().permit_lifetime - std::chrono::minutes(1));
  EXPECT_EQ(resume_and_pause(), 1) << "a hold of 29 minutes";
  EXPECT_THAT(controller_->asked, ::testing::Not(Contains("finish")));
  time_.pass(cell_of_owners().permit_lifetime + std::chrono::minutes(1));
  EXPECT_EQ(resume_and_pause(), 2) << "of 31 minutes";
  EXPECT_THAT(controller_->asked, Contains("finish"));
}

TEST_F(ResumedOperationTest, KeepsTheReasonForItsHoldWhenThatIsAcknowledged) {
  const auto reason = [this] { return operation_.status().fault.value_or(Fault{}).message(); };
  const std::string before = reason();
  ASSERT_TRUE(operation_.status().fault);
  EXPECT_FALSE(operation_.command(Command::kAcknowledge));
  EXPECT_EQ(operation_.status().state, State::kHeld);
  EXPECT_EQ(reason(), before) << "until somebody answers it";
  EXPECT_FALSE(operation_.command(Command::kResume));
  EXPECT_NE(reason(), before);
}

TEST_F(ResumedOperationTest, IsNotResumedByADaemonThatEnds) {
  shut_down();
  EXPECT_TRUE(operation_.command(Command::kResume));
  expect_left_for_the_next_daemon();
}

/// A run whose second touch is made while the result of the first is still being computed.
class SlowArithmeticTest : public CellOperationTest {
 protected:
  SlowArithmeticTest() : CellOperationTest(std::make_unique<boost::asio::io_context>(1)) {
    controller_->state->joints = to_wire(cell_of_owners().park_joints);
    controller_->state->permit = cs8::PermitState::kGranted;
    controller_->on_touch = [this](const cs8::Touch&) { return contact_of(touch_count_++); };
    launch();
    id_ = start_few();
    run_until([this] {
      compute_one();
      return touch_count_ == 2;
    });
    controller_->asked.clear();
  }
  void poll() {
    io_.restart();
    io_.poll();
  }
  void compute_one() {
    if (touch_count_ == 2) return;  // slow from here on
    arithmetic_->restart();
    arithmetic_->poll_one();
  }
  void compute_until(const std::function<bool()>& condition) {
    while (!condition()) {
      arithmetic_->restart();
      arithmetic_->poll();
      poll();
    }
  }

  std::size_t touch_count_ = 0;
  std::int64_t id_ = 0;
};

TEST_F(SlowArithmeticTest, IsNotWaitedForByAStop) {
  ASSERT_EQ(operation_.status().state, State::kExecute);
  EXPECT_FALSE(operation_.command(Command::kStop));
  EXPECT_THAT(controller_->asked, Contains("stop"));
  poll();
  EXPECT_EQ(operation_.status().state, State::kStopping) << "the end of the run is stored with its result";
  compute_until([this] { return operation_.status().state == State::kStopped; });
  EXPECT_EQ(store_.run(id_).value().outcome, RunOutcome::kStopped);
}

TEST_F(SlowArithmeticTest, IsNotWaitedForToStopTheArmWhereTheDaemonEnds) {
  bool down = false;
  boost::asio::co_spawn(io_, operation_.shut_down(), [&](const std::exception_ptr&) { down = true; });
  poll();
  EXPECT_THAT(controller_->asked, Contains("stop"));
  EXPECT_EQ(operation_.status().state, State::kHolding);
  compute_until([&] { return down; });
  EXPECT_EQ(operation_.status().state, State::kHeld);
  EXPECT_EQ(store_.run(id_).value().outcome, RunOutcome::kRunning) << "the next daemon takes it up";
  EXPECT_EQ(store_.touches(id_).size(), 2u) << "what was answered meanwhile is kept";
}

/// It left the link's loops, and the program ended in a run.
TEST_F(CellOperationTest, WhatIsThrownWhereTheControllerTellsSomethingEndsTheRunAndNotTheDaemon) {
  controller_->state->permit = cs8::PermitState::kGranted;
  controller_->on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  launch();
  start({.recipe = "few"});
  run_until([this] { return operation_.status().state == State::kExecute; });
  time_.throws_once = true;
  EXPECT_NO_THROW(controller_->hooks.on_state(*controller_->state));
  run_until([this] { return operation_.status().state == State::kAborted; });
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kInternalError);
  EXPECT_THAT(operation_.status().fault->detail, ::testing::HasSubstr("the clock is broken"));
}

TEST_F(CellOperationTest, ChangesAreToldAtOnceAndNumbered) {
  std::vector<std::uint64_t> told;
  operation_.on_change([&](const Status& status) { told.push_back(status.sequence); });
  launch();
  ASSERT_FALSE(told.empty());
  for (std::size_t i = 1; i < told.size(); ++i) EXPECT_EQ(told[i], told[i - 1] + 1);
  EXPECT_EQ(told.back(), operation_.sequence());
}

}  // namespace
}  // namespace cell
