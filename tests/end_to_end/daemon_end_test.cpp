// What a daemon that is told to end leaves behind: an arm clear of the face, and a run on hold for the next
// daemon, unless a person has ended it.
#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <functional>
#include <string>
#include <tuple>

#include "cs8_protocol/names.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/stored_touches.hpp"

namespace touchcal::testing {
namespace {

namespace asio = boost::asio;
using cell::Command;
using cell::RunOutcome;
using cell::State;
using cell::Status;

/// Fast enough not to be waited for, slow enough that the arm is met in the middle of a touch.
constexpr double kSpeed = 4.0;

/// As the daemon at a signal; `meanwhile` is called until it has ended.
void end_daemon(
    LoopbackCell& loop, const std::function<void()>& meanwhile = [] {}) {
  bool ended = false;
  asio::co_spawn(loop.io(), loop.operation().shut_down(), [&](const std::exception_ptr&) { ended = true; });
  loop.run_until([&](const Status&) {
    meanwhile();
    return ended;
  });
}

void expect_clear_of_the_face(const cs8::State& left) {
  EXPECT_EQ(left.flags & cs8::kRetractDue, 0U) << "a stylus is left at the face";
  EXPECT_TRUE(cs8::probe_inputs(left.flags).free());
  EXPECT_EQ(left.active_sequence, 0U);
}

/// The next daemon has the run on hold with so many touches at least, and ends it as if nothing had been.
void expect_resumed_by_the_next_daemon(LoopbackCell& loop, std::int64_t id, int touches) {
  EXPECT_EQ(loop.store().run(id)->outcome, RunOutcome::kRunning);
  loop.relaunch();
  EXPECT_EQ(loop.status().state, State::kHeld);
  EXPECT_EQ(loop.fault_name(), "daemon_restarted");
  EXPECT_EQ(loop.status().run_id, id);
  EXPECT_GE(loop.status().touches_done, touches);
  loop.run_until([](const Status& status) { return status.controller.connected; });
  EXPECT_EQ(loop.status().state, State::kHeld) << "a start of the daemon moves nothing";
  loop.command(Command::kResume);
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  expect_touches_once(loop, id, kShortTouchCount);
  EXPECT_EQ(loop.store().runs(10).size(), 1U);
}

class DaemonEndInPhase : public ::testing::TestWithParam<cs8::Phase> {};

TEST_P(DaemonEndInPhase, LeavesTheArmClearOfTheFaceAndTheRunOnHold) {
  LoopbackCell loop;
  const sim::Server server(loop.io(), "127.0.0.1", 0, loop.true_plant(), {.controller = {.speed = kSpeed}});
  loop.launch(server.port());
  loop.run_until(State::kIdle);
  const std::int64_t id = loop.start();
  loop.run_until([&](const Status&) { return server.report().phase == GetParam(); });
  end_daemon(loop);
  EXPECT_EQ(loop.status().state, State::kHeld);
  EXPECT_TRUE(loop.fault_name().empty());
  EXPECT_EQ(loop.store().run(id)->outcome, RunOutcome::kRunning);
  expect_clear_of_the_face(server.report());
}

INSTANTIATE_TEST_SUITE_P(Phases, DaemonEndInPhase,
                         ::testing::Values(cs8::Phase::kTravel, cs8::Phase::kApproach, cs8::Phase::kSearch,
                                           cs8::Phase::kRetract),
                         [](const auto& phase) { return std::string(cs8::name(phase.param)); });

class DaemonEndIn : public ::testing::Test {
 protected:
  DaemonEndIn() {
    loop_.serve();
    loop_.launch();
    loop_.run_until(State::kIdle);
  }
  std::int64_t start_and_make(int touches) {
    const std::int64_t id = loop_.start();
    loop_.run_until_touches(touches);
    return id;
  }

  LoopbackCell loop_;
};

TEST_F(DaemonEndIn, StartingLeavesTheRunForTheNextDaemon) {
  const std::int64_t id = loop_.start();
  ASSERT_EQ(loop_.status().state, State::kStarting);
  end_daemon(loop_);
  expect_resumed_by_the_next_daemon(loop_, id, 0);
}

TEST_F(DaemonEndIn, ExecuteLeavesTheRunForTheNextDaemonWithItsTouches) {
  const std::int64_t id = start_and_make(9);
  end_daemon(loop_);
  expect_resumed_by_the_next_daemon(loop_, id, 9);
}

TEST_F(DaemonEndIn, CompletingLosesNothing) {
  const std::int64_t id = loop_.start();
  loop_.run_until(State::kCompleting);
  end_daemon(loop_);
  expect_resumed_by_the_next_daemon(loop_, id, kShortTouchCount);
}

TEST_F(DaemonEndIn, HeldLeavesTheRunForTheNextDaemonWithItsTouches) {
  const std::int64_t id = start_and_make(3);
  loop_.command(Command::kPause);
  loop_.run_until(State::kHeld);
  end_daemon(loop_);
  expect_resumed_by_the_next_daemon(loop_, id, 3);
}

TEST_F(DaemonEndIn, HeldByAFaultLeavesTheRunForTheNextDaemonWithItsTouches) {
  loop_.inject(R"({"fault":"probe_stuck","touch":5})");
  const std::int64_t id = loop_.start();
  loop_.run_until_over();
  ASSERT_EQ(loop_.status().state, State::kHeld);
  end_daemon(loop_);
  EXPECT_EQ(loop_.fault_name(), "probe_stuck") << "a person may still read it";
  loop_.inject(R"({"fault":"probe_mended"})");
  expect_resumed_by_the_next_daemon(loop_, id, 4);
}

TEST_F(DaemonEndIn, HoldingLeavesTheRunForTheNextDaemonWithItsTouches) {
  const std::int64_t id = start_and_make(3);
  loop_.command(Command::kPause);
  ASSERT_EQ(loop_.status().state, State::kHolding);
  end_daemon(loop_);
  EXPECT_EQ(loop_.status().state, State::kHeld);
  expect_resumed_by_the_next_daemon(loop_, id, 3);
}

TEST_F(DaemonEndIn, SuspendedLeavesTheRunForTheNextDaemonWithItsTouches) {
  loop_.inject(R"({"fault":"monitor_speed","touch":5,"phase":"retract","percent":50})");
  const std::int64_t id = loop_.start();
  loop_.run_until(State::kSuspended);
  end_daemon(loop_);
  EXPECT_EQ(loop_.status().state, State::kHeld);
  loop_.inject(R"({"fault":"monitor_speed","percent":100})");
  expect_resumed_by_the_next_daemon(loop_, id, 4);
}

TEST_F(DaemonEndIn, UnholdingLeavesTheRunForTheNextDaemonWithItsTouches) {
  const std::int64_t id = start_and_make(3);
  loop_.inject(R"({"fault":"close"})");
  loop_.run_until(State::kHeld);
  loop_.command(Command::kResume);
  ASSERT_EQ(loop_.status().state, State::kUnholding);
  end_daemon(loop_);
  EXPECT_EQ(loop_.status().state, State::kHeld);
  expect_resumed_by_the_next_daemon(loop_, id, 3);
}

TEST_F(DaemonEndIn, StoppingOrAbortingEndsTheRunAsThePersonSaid) {
  for (const auto& [command, state, outcome] :
       {std::tuple{Command::kStop, State::kStopped, RunOutcome::kStopped},
        std::tuple{Command::kAbort, State::kAborted, RunOutcome::kAborted}}) {
    const std::int64_t id = start_and_make(3);
    loop_.command(command);
    end_daemon(loop_);
    EXPECT_EQ(loop_.status().state, state);
    EXPECT_EQ(loop_.store().run(id)->outcome, outcome);
    loop_.relaunch();
    loop_.run_until(State::kIdle);
  }
}

TEST(DaemonEnd, AStopThatComesMeanwhileEndsTheRun) {
  LoopbackCell loop;
  loop.serve({}, kSpeed);  // a touch lasts
  loop.launch();
  loop.run_until(State::kIdle);
  const std::int64_t id = loop.start();
  loop.run_until([&](const Status&) { return loop.server().report().phase == cs8::Phase::kSearch; });
  bool stopped = false;
  end_daemon(loop, [&] {
    if (stopped || loop.status().state != State::kHolding) return;
    stopped = true;
    loop.command(Command::kStop);
  });
  EXPECT_TRUE(stopped);
  EXPECT_EQ(loop.status().state, State::kStopped);
  EXPECT_EQ(loop.store().run(id)->outcome, RunOutcome::kStopped);
  EXPECT_NE(loop.server().report().flags & cs8::kRetractDue, 0U) << "nothing moves behind a stop";
}

/// A person confirmed the way back, not the end; it is asked for again.
TEST(DaemonEnd, OnTheWayBackFromAFaceLeavesTheArmWhereItStands) {
  for (const bool stopped_before : {false, true}) {
    LoopbackCell loop;
    loop.serve({}, kSpeed);
    loop.launch();
    loop.run_until(State::kIdle);
    loop.start();
    loop.run_until([&](const Status&) { return loop.server().report().phase == cs8::Phase::kSearch; });
    loop.command(Command::kStop);
    loop.run_until(State::kStopped);
    loop.relaunch();  // a daemon that knows of no run
    loop.run_until(State::kIdle);
    loop.command(Command::kReset);
    loop.run_until([&](const Status&) { return loop.server().report().phase == cs8::Phase::kRetract; });
    EXPECT_EQ(loop.status().state, State::kResetting);
    if (stopped_before) loop.command(Command::kStop);
    end_daemon(loop);
    EXPECT_EQ(loop.status().state, State::kStopped);
    EXPECT_EQ(loop.server().report().active_sequence, 0U);
    EXPECT_NE(loop.server().report().flags & cs8::kRetractDue, 0U);
  }
}

}  // namespace
}  // namespace touchcal::testing
