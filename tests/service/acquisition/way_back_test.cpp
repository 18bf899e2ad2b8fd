// The way back from a face behind a run that is over: who begins it, and each way in which it ends.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/service/acquisition/operation_bench.hpp"

namespace cell {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// An operation whose arm stands at a face.
class WayBackTest : public ::testing::Test, protected OperationBench {
 protected:
  WayBackTest() {
    controller_->state->flags |= cs8::kRetractDue | cs8::kProbeTouched;
    controller_->state->permit = cs8::PermitState::kGranted;
    controller_->on_move = [this] { return back(); };
    launch();
    EXPECT_EQ(operation_.status().state, State::kIdle);
    EXPECT_EQ(operation_.status().controller.retract_due, true);
  }

  void reset_and_run_until(State state) {
    controller_->asked.clear();
    EXPECT_FALSE(operation_.command(Command::kReset));
    EXPECT_EQ(operation_.status().state, State::kResetting);
    run_until([&] { return operation_.status().state == state; });
  }
  /// RESETTING was left with this fault, or without one; the arm was not moved, and a person's commands lead
  /// to the way back.
  void expect_left(const std::string& fault) {
    const auto& there = operation_.status().fault;
    EXPECT_EQ(there ? describe(there->code).name : "", fault);
    EXPECT_EQ(operation_.status().waiting_for, std::nullopt);
    EXPECT_THAT(controller_->asked, Not(Contains(StartsWith("retract"))));
    expect_way_out();
  }
  void expect_way_out() {
    controller_->on_begin = ScriptedController().on_begin;
    controller_->on_move = [this] { return back(); };
    controller_->state->flags |= cs8::kRetractDue;
    controller_->state->permit = cs8::PermitState::kGranted;
    if (operation_.status().state == State::kAborted) {
      EXPECT_FALSE(operation_.command(Command::kClear));
      run_until([&] { return operation_.status().state == State::kStopped; });
    }
    EXPECT_THAT(operation_.exits(), Contains(Command::kReset));
    reset_and_run_until(State::kIdle);
    EXPECT_THAT(controller_->asked, Contains(StartsWith("retract")));
  }
  /// The arm is where the face does not hold the stylus any more.
  cs8::MoveResult back() {
    controller_->state->flags &= ~static_cast<std::uint32_t>(cs8::kProbeTouched);
    return ScriptedController::arrived();
  }
  static cs8::Permit not_given(cs8::PermitReason reason, cs8::RejectReason detail = {}) {
    return {.run = 0, .reason = reason, .detail = static_cast<std::int32_t>(detail)};
  }
  static cs8::MoveResult broken_off(cs8::Outcome outcome) {
    cs8::MoveResult result;
    result.outcome = outcome;
    return result;
  }
  void lose_link() {
    controller_->is_connected = false;
    controller_->hooks.on_loss(ScriptedController::lost());
  }
  /// The way back waits for a cell that is closed.
  void wait_for_closed_cell() {
    controller_->on_begin = [](std::uint32_t) {
      return not_given(cs8::PermitReason::kRefused, cs8::RejectReason::kCellOpen);
    };
    EXPECT_FALSE(operation_.command(Command::kReset));
    run_until([&] { return operation_.status().waiting_for == "cell_closed"; });
    controller_->asked.clear();
  }
};

TEST_F(WayBackTest, IsBegunByNobodyButAPerson) {
  EXPECT_THAT(controller_->asked, Not(Contains(StartsWith("begin")))) << "a daemon was started";
  lose_link();
  EXPECT_EQ(operation_.status().state, State::kResetting);
  run_until([&] { return operation_.status().state == State::kIdle; });
  EXPECT_THAT(controller_->asked, Not(Contains(StartsWith("begin")))) << "a link was found again";
  EXPECT_THAT(operation_.exits(), Contains(Command::kReset));
}

TEST_F(WayBackTest, IsMadeBehindAResetAndTheKeyAndLeadsToIdle) {
  EXPECT_FALSE(operation_.command(Command::kStop));
  std::optional<std::string> awaited;
  std::vector<Command> exits;
  controller_->on_begin = [&](std::uint32_t run) {
    controller_->hooks.on_permit({.run = run, .state = cs8::PermitState::kAwaited});
    awaited = operation_.status().waiting_for;
    exits = operation_.exits();
    EXPECT_FALSE(operation_.command(Command::kConfirm)) << "it says what to do";
    EXPECT_TRUE(operation_.command(Command::kLocate)) << "the arm is about to move";
    return ScriptedController().on_begin(run);
  };
  reset_and_run_until(State::kIdle);
  EXPECT_EQ(awaited, "confirmation");
  EXPECT_THAT(exits, ElementsAre(Command::kStop)) << "an abort names its run, and there is none";
  EXPECT_THAT(controller_->asked, ElementsAre("finish", "begin 0", "retract 1", "acknowledge 1", "finish"));
  EXPECT_EQ(operation_.status().controller.retract_due, false);
  EXPECT_FALSE(operation_.status().fault);
  controller_->asked.clear();
  EXPECT_FALSE(operation_.command(Command::kReset)) << "once more changes nothing";
  EXPECT_EQ(operation_.status().state, State::kIdle);
  EXPECT_THAT(controller_->asked, IsEmpty());
}

TEST_F(WayBackTest, IsMadeAlsoWhereStateDoesNotYetKnowThatTheTouchHasEnded) {
  controller_->state->active_sequence = 1;
  tell_state();
  EXPECT_FALSE(operation_.command(Command::kReset));
  controller_->asked.clear();
  tell_state();
  EXPECT_EQ(operation_.status().state, State::kResetting);
  EXPECT_THAT(controller_->asked, IsEmpty());
  controller_->state->active_sequence = 0;
  run_until([this] { return operation_.status().state == State::kIdle; });
  EXPECT_THAT(controller_->asked, Contains("retract 1"));
}

TEST_F(WayBackTest, EndsWhereNobodyConfirms) {
  controller_->on_begin = [](std::uint32_t) { return not_given(cs8::PermitReason::kNotConfirmed); };
  reset_and_run_until(State::kStopped);
  expect_left("not_confirmed");
}

TEST_F(WayBackTest, EndsWhereTheCellIsNotMadeReadyInTime) {
  controller_->on_begin = [this](std::uint32_t) {
    time_.pass(cell_of_owners().deadlines.ready);
    return not_given(cs8::PermitReason::kRefused, cs8::RejectReason::kCellOpen);
  };
  reset_and_run_until(State::kStopped);
  expect_left("cell_open");
}

TEST_F(WayBackTest, EndsWhereThePermitIsRefusedForWhatNobodyCanMendOnTheSpot) {
  controller_->on_begin = [](std::uint32_t) {
    return not_given(cs8::PermitReason::kRefused, cs8::RejectReason::kTaskFailed);
  };
  reset_and_run_until(State::kAborted);
  expect_left("task_failed");
}

TEST_F(WayBackTest, EndsWithTheLinkWhileItsPermitIsAwaited) {
  controller_->on_begin = [this](std::uint32_t) -> cs8::PermitReply {
    lose_link();
    return ScriptedController::lost();
  };
  reset_and_run_until(State::kAborted);
  run_until([this] { return controller_->is_connected; });
  expect_left("link_lost");
}

TEST_F(WayBackTest, EndsByAStopOrAnAbortWhileItsPermitIsAwaited) {
  for (const Command end : {Command::kStop, Command::kAbort}) {
    controller_->state->flags |= cs8::kRetractDue;
    tell_state();
    controller_->on_begin = [this, end](std::uint32_t run) {
      EXPECT_FALSE(operation_.command(end));
      EXPECT_EQ(controller_->asked.back(), "finish");
      return ScriptedController().on_begin(run);  // in that moment somebody pressed the key
    };
    reset_and_run_until(end == Command::kStop ? State::kStopped : State::kAborted);
    EXPECT_THAT(controller_->asked, Contains("stop"));
    expect_left("");
  }
}

TEST_F(WayBackTest, EndsWithTheDaemonWithoutAMotion) {
  wait_for_closed_cell();
  controller_->on_begin = ScriptedController().on_begin;
  controller_->state->flags &=
      ~static_cast<std::uint32_t>(cs8::kCellClosed);  // what it waits for has changed
  shut_down();
  EXPECT_EQ(operation_.status().state, State::kStopped);
  EXPECT_THAT(controller_->asked, Not(Contains(StartsWith("retract"))));
}

TEST_F(WayBackTest, IsNotMadeTwiceWhereAPersonHasJoggedTheArmMeanwhile) {
  wait_for_closed_cell();
  controller_->state->flags &=
      ~static_cast<std::uint32_t>(cs8::kRetractDue | cs8::kProbeTouched | cs8::kTouchTested);
  run_until([this] { return operation_.status().state == State::kIdle; });
  EXPECT_THAT(controller_->asked, Not(Contains(StartsWith("retract"))));
  EXPECT_FALSE(operation_.status().fault);
}

TEST_F(WayBackTest, IsNotBesideAGuidedRunThatIsStarted) {
  wait_for_closed_cell();
  EXPECT_EQ(std::get<CommandRefusal>(start({.recipe = "few", .guided = true})).code,
            FaultCode::kNotInThisState);
  EXPECT_THAT(store_.runs(1), IsEmpty());
}

TEST_F(WayBackTest, IsNotMadeInADialogueByHand) {
  EXPECT_FALSE(operation_.command(Command::kLocate));
  controller_->asked.clear();
  EXPECT_THAT(operation_.exits(), Not(Contains(Command::kReset)));
  EXPECT_FALSE(operation_.command(Command::kReset));
  EXPECT_FALSE(operation_.command(Command::kStop));
  EXPECT_THAT(controller_->asked, Not(Contains(StartsWith("begin"))));
}

TEST_F(WayBackTest, IsStoppedInTheMotionAndItsAnswerIsWaitedFor) {
  controller_->on_move = [this] {
    EXPECT_FALSE(operation_.command(Command::kStop));
    EXPECT_EQ(operation_.status().state, State::kStopping);
    EXPECT_TRUE(operation_.command(Command::kReset)) << "not before the arm stands";
    return broken_off(cs8::Outcome::kStopped);
  };
  reset_and_run_until(State::kStopped);
  EXPECT_EQ(std::ranges::count(controller_->asked, "stop"), 1);
  EXPECT_EQ(controller_->asked.back(), "finish");
  EXPECT_FALSE(operation_.status().fault);
  expect_way_out();
}

class WayBackAtTheEnd : public WayBackTest, public ::testing::WithParamInterface<bool> {};

TEST_P(WayBackAtTheEnd, IsStoppedAndNotGoneOnWithBehindAPersonsStopEither) {
  bool down = false;
  controller_->on_move = [&] {
    controller_->state->flags |= cs8::kRetractDue;
    if (GetParam()) {
      EXPECT_FALSE(operation_.command(Command::kStop));
    }
    boost::asio::co_spawn(io_, operation_.shut_down(), [&](const std::exception_ptr&) { down = true; });
    EXPECT_EQ(operation_.status().state, State::kStopping);
    return broken_off(cs8::Outcome::kStopped);
  };
  EXPECT_FALSE(operation_.command(Command::kReset));
  run_until([&] { return down; });
  EXPECT_EQ(operation_.status().state, State::kStopped);
  EXPECT_THAT(controller_->asked, Contains("retract 1"));
  EXPECT_THAT(controller_->asked, Not(Contains("retract 2")));
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutAStop, WayBackAtTheEnd, ::testing::Bool());

TEST_F(WayBackTest, EndsWithTheLinkInTheMotion) {
  controller_->on_move = [this] {
    lose_link();
    return ScriptedController::lost();
  };
  reset_and_run_until(State::kAborted);
  run_until([this] { return controller_->is_connected; });
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kLinkLost);
  expect_way_out();
}

TEST_F(WayBackTest, EndsByAMotionThatDoesNotArrive) {
  controller_->on_move = [] { return broken_off(cs8::Outcome::kCollision); };
  reset_and_run_until(State::kAborted);
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kCollision);
  EXPECT_EQ(controller_->asked.back(), "finish");
  expect_way_out();
}

TEST_F(WayBackTest, EndsWhereStateAloneSaysThatThePermitIsGone) {
  controller_->on_move = [this] {
    controller_->state->permit = cs8::PermitState::kNone;
    for (int i = 0; i < 30; ++i) {
      controller_->hooks.on_state(*controller_->state);
      time_.pass(std::chrono::milliseconds(20));
    }
    EXPECT_EQ(operation_.status().state, State::kAborting);
    EXPECT_THAT(controller_->asked, Contains("stop"));
    return broken_off(cs8::Outcome::kPermissionLost);
  };
  reset_and_run_until(State::kAborted);
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kPermissionLost);
  expect_way_out();
}

TEST_F(WayBackTest, EndsByAnErrorThatNobodyForesaw) {
  controller_->on_begin = [](std::uint32_t) -> cs8::PermitReply { throw std::runtime_error("scripted"); };
  reset_and_run_until(State::kAborted);
  EXPECT_EQ(controller_->asked.back(), "finish");
  expect_left("internal_error");
}

}  // namespace
}  // namespace cell
