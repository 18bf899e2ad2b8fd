// What a person at the cell asks for, while a run goes on and while none does.
#include <gtest/gtest.h>

#include <set>

#include "cs8_protocol/codec.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/relay.hpp"
#include "tests/end_to_end/stored_touches.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;

class Operator : public ::testing::Test {
 protected:
  void make_ready() {
    loop_.serve();
    loop_.launch();
    loop_.run_until(State::kIdle);
  }

  /// The cell with a run of which so many touches are made.
  std::int64_t start_and_make(int touches) {
    make_ready();
    const std::int64_t id = loop_.start();
    loop_.run_until_touches(touches);
    EXPECT_EQ(loop_.status().state, State::kExecute);
    return id;
  }

  LoopbackCell loop_;
};

TEST_F(Operator, APausedRunGoesOnWhereItWasAndMakesEveryTouchOnce) {
  const std::int64_t id = start_and_make(5);
  loop_.command(Command::kPause);
  loop_.run_until(State::kHeld);
  EXPECT_TRUE(loop_.fault_name().empty());
  const int held_at = loop_.status().touches_done;
  EXPECT_LT(held_at, kShortTouchCount);
  loop_.command(Command::kPause);  // once more changes nothing
  EXPECT_EQ(loop_.status().state, State::kHeld);
  loop_.command(Command::kResume);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
}

TEST_F(Operator, AStoppedRunKeepsItsTouchesAndANewOneNeedsAReset) {
  const std::int64_t id = start_and_make(9);
  loop_.command(Command::kStop);
  EXPECT_EQ(loop_.status().state, State::kStopping);
  loop_.run_until(State::kStopped);
  const cell::Status status = loop_.status();
  EXPECT_EQ(status.verdict, cell::Verdict::kIncomplete);
  EXPECT_TRUE(loop_.fault_name().empty());
  EXPECT_GE(status.touches_done, 9);
  expect_touches_once(loop_, id, status.touches_done);
  const auto stored = loop_.store().run(id).value();
  EXPECT_EQ(stored.outcome, cell::RunOutcome::kStopped);
  EXPECT_EQ(stored.verdict, cell::Verdict::kIncomplete);

  EXPECT_THROW(loop_.start(), std::runtime_error);
  loop_.command(Command::kReset);
  loop_.run_until(State::kIdle);
  const std::int64_t next = loop_.start();
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, next, kShortTouchCount);
}

TEST_F(Operator, AnAbortedRunIsLeftByClearAndReset) {
  const std::int64_t id = start_and_make(3);
  loop_.command(Command::kAbort);
  loop_.run_until(State::kAborted);
  EXPECT_EQ(loop_.store().run(id)->outcome, cell::RunOutcome::kAborted);
  EXPECT_EQ(loop_.status().verdict, cell::Verdict::kIncomplete);
  expect_touches_once(loop_, id, loop_.status().touches_done);
  EXPECT_TRUE(loop_.is_refused(Command::kReset));
  loop_.leave_aborted();
}

TEST_F(Operator, AStopInASearchIsFollowedByTheRestOfTheWayBehindAResetAndTheNextRunBeginsWithItsPlan) {
  // Twenty times as fast as an arm: a search takes several of the 20 ms between two reports of the state.
  loop_.serve({}, 20.0);
  std::optional<cell::CommandRefusal> refusal;
  bool stopped = false;
  std::vector<cs8::MessageType> asked;
  Relay relay(loop_.io(), loop_.port(), [&](const cs8::Message& message) {
    const auto* state = std::get_if<cs8::State>(&message.payload);
    if (state && state->phase == cs8::Phase::kSearch && !stopped) {
      stopped = true;
      refusal = loop_.operation().command(Command::kStop);
    }
    const cs8::MessageType type = cs8::type_of(message);
    const auto* permit = std::get_if<cs8::Permit>(&message.payload);
    const bool is_granted = permit && permit->state == cs8::PermitState::kGranted;
    if (type == cs8::MessageType::kTouch || type == cs8::MessageType::kTravel ||
        type == cs8::MessageType::kRetract || is_granted)
      asked.push_back(type);
  });
  loop_.launch(relay.port());
  loop_.run_until(State::kIdle);
  const std::int64_t id = loop_.start();
  loop_.run_until(State::kStopped);
  EXPECT_FALSE(refusal) << refusal->detail;
  EXPECT_EQ(loop_.store().run(id)->outcome, cell::RunOutcome::kStopped);
  expect_touches_once(loop_, id, loop_.status().touches_done);

  asked.clear();
  loop_.command(Command::kReset);
  loop_.run_until([](const cell::Status& status) { return status.waiting_for == "confirmation"; });
  EXPECT_EQ(loop_.status().state, State::kResetting);
  loop_.run_until(State::kIdle);
  using Types = std::vector<cs8::MessageType>;
  EXPECT_EQ(asked, (Types{cs8::MessageType::kPermit, cs8::MessageType::kRetract}));
  EXPECT_EQ(loop_.server().report().flags & cs8::kRetractDue, 0U) << "it stands clear of the face";
  asked.clear();
  const std::int64_t next = loop_.start();
  loop_.run_until_touches(1);
  expect_touches_once(loop_, next, 1);
  ASSERT_GE(asked.size(), 2U);
  asked.resize(2);
  EXPECT_EQ(asked, (Types{cs8::MessageType::kPermit, cs8::MessageType::kTouch}));
}

/// A pause lets the touch under way end; nobody promised that of the end of the daemon.
TEST_F(Operator, ASearchBehindAPauseIsBrokenOffByTheEndOfTheDaemon) {
  loop_.serve({}, 20.0);
  bool searched = false;
  std::set<cs8::MessageType> asked;
  Relay relay(loop_.io(), loop_.port(), [&](const cs8::Message& message) {
    const auto* state = std::get_if<cs8::State>(&message.payload);
    if (state && state->phase == cs8::Phase::kSearch) searched = true;
    asked.insert(cs8::type_of(message));
  });
  loop_.launch(relay.port());
  loop_.run_until(State::kIdle);
  const std::int64_t id = loop_.start();
  loop_.run_until([&](const cell::Status&) { return searched; });
  loop_.command(Command::kPause);
  loop_.relaunch();
  EXPECT_TRUE(asked.contains(cs8::MessageType::kStop));
  loop_.run_until(State::kHeld);
  expect_touches_once(loop_, id, 0);
}

TEST_F(Operator, AStopWhileTheTouchesArePlannedEndsTheRunWithoutAny) {
  make_ready();
  const std::int64_t id = loop_.start();
  EXPECT_EQ(loop_.status().state, State::kStarting);
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
  EXPECT_EQ(loop_.store().run(id)->outcome, cell::RunOutcome::kStopped);
  expect_touches_once(loop_, id, 0);
}

TEST_F(Operator, StopIsTakenInEveryStateThatARunGoesThrough) {
  make_ready();
  std::set<State> stopped_in;
  const auto stop_in = [&](State state) {
    loop_.run_until(state);
    loop_.command(Command::kStop);
    stopped_in.insert(state);
    loop_.run_until([](const cell::Status& status) {
      return status.state == State::kStopped || status.state == State::kAborted;
    });
    if (loop_.status().state == State::kAborted) {
      loop_.command(Command::kClear);
      loop_.run_until(State::kStopped);
    }
    loop_.command(Command::kStop);  // where it already is
    loop_.command(Command::kReset);
    loop_.run_until(State::kIdle);
  };
  stop_in(State::kIdle);
  for (const State state : {State::kStarting, State::kExecute, State::kCompleting, State::kComplete}) {
    loop_.start();
    stop_in(state);
  }
  for (const State state : {State::kHolding, State::kHeld}) {
    loop_.start();
    loop_.run_until(State::kExecute);
    loop_.command(Command::kPause);
    stop_in(state);
  }
  loop_.start();
  loop_.run_until(State::kExecute);
  loop_.command(Command::kPause);
  loop_.run_until(State::kHeld);
  loop_.command(Command::kResume);
  stop_in(State::kUnholding);
  loop_.start();
  loop_.run_until(State::kExecute);
  loop_.command(Command::kAbort);
  stop_in(State::kAborting);
  EXPECT_EQ(stopped_in.size(), 9U) << "a state was left out";
}

TEST_F(Operator, CommandsInStatesThatDoNotHaveThemAreRefusedAndChangeNothing) {
  make_ready();
  const auto refused = [&](std::initializer_list<Command> commands) {
    const cell::Status before = loop_.status();
    for (const Command command : commands) {
      EXPECT_TRUE(loop_.is_refused(command))
          << cell::command_name(command) << " in " << cell::state_name(before.state);
    }
    EXPECT_EQ(loop_.status().state, before.state);
    EXPECT_EQ(loop_.status().sequence, before.sequence);
  };
  refused({Command::kPause, Command::kResume, Command::kClear});
  loop_.start();
  refused({Command::kPause, Command::kResume, Command::kClear, Command::kReset});
  loop_.run_until_touches(2);
  EXPECT_THROW(loop_.start(), std::runtime_error) << "two runs at once";
  refused({Command::kClear, Command::kReset});
  loop_.command(Command::kPause);
  loop_.run_until(State::kHeld);
  refused({Command::kClear, Command::kReset});
  loop_.command(Command::kAbort);
  loop_.run_until(State::kAborted);
  EXPECT_THROW(loop_.start(), std::runtime_error);
  refused({Command::kPause, Command::kResume, Command::kReset});
}

TEST_F(Operator, ACommandForARunThatIsOverIsRefused) {
  const std::int64_t id = start_and_make(1);
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
  loop_.command(Command::kReset);
  loop_.run_until(State::kIdle);
  loop_.start();
  loop_.run_until(State::kExecute);
  const auto refusal = loop_.operation().command(Command::kPause, id);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->kind, cell::CommandRefusal::Kind::kNotThisRun);
  EXPECT_EQ(loop_.status().state, State::kExecute);
}

}  // namespace
}  // namespace touchcal::testing
