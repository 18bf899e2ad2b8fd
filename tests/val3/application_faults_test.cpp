// What goes wrong at the cell, in the controller and in time, and what the application makes of it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cs8_protocol/names.hpp"
#include "tests/val3/bench.hpp"

namespace val3 {
namespace {

using namespace cs8;

constexpr double kFaceMm = 8.0;

/// Ready, with a face, touch 1 taken and the tip that deep.
void into_touch(Bench& bench, double mm) {
  bench.make_ready();
  bench.face_mm = kFaceMm;
  bench.send(1, bench.touch());
  bench.expect<Accepted>(1);
  for (int left = 5000; bench.depth_mm() < mm && left > 0; --left) bench.ticks(1);
  EXPECT_GE(bench.depth_mm(), mm);
}

TEST(ApplicationFaults, VariablesLeftFromBeforeChangeNothing) {
  Bench bench;
  bench.controller.machine().stop();
  bench.seconds(0.2);
  bench.spoil_globals({"nSession"});  // the only one that is meant to live on
  bench.controller.machine().start();
  bench.seconds(0.1);
  into_touch(bench, 3);
  EXPECT_EQ(bench.expect<TouchResult>(1, 30).outcome, Outcome::kContact) << bench.log();
  EXPECT_EQ(bench.state().task_error, 0);
}

TEST(ApplicationFaults, NoTaskIsMissedWhileTheTasksAreStillBeingCreated) {
  // What the controller says shifts the turns in which `start` creates the tasks.
  for (const char* version : {"s7.7.2", "s7.7.2 - Mar 23 2012", "s8.1", "s8.1 - Mar 23 2012"}) {
    for (const char* arm : {"", "tx90"}) {
      Bench bench({.differs = [=](Cabinet& cabinet) {
        cabinet.val3_version = version;
        cabinet.arm_type = arm;
      }});
      for (int starts = 0; starts < 2; ++starts) {
        EXPECT_EQ(bench.variable<double>("nTaskError"), 0) << version << ", " << arm << '\n' << bench.log();
        bench.controller.machine().stop();
        bench.seconds(0.2);
        bench.controller.machine().start();
        bench.seconds(0.1);
      }
    }
  }
}

TEST(ApplicationFaults, BehindAStartThatBrokeOffNothingIsPermitted) {
  Bench bench;
  bench.make_ready();
  bench.controller.machine().set_truth("bStarted", false);
  bench.seconds(0.1);
  EXPECT_EQ(bench.expect<Permit>(0).state, PermitState::kNone);
  bench.send(0, Begin{1, 30000});
  const Permit refused = bench.expect<Permit>(0);
  EXPECT_EQ(refused.reason, PermitReason::kRefused);
  EXPECT_EQ(refused.detail, static_cast<std::int32_t>(RejectReason::kTaskFailed));
}

TEST(ApplicationFaults, ALatchThatSeesNothingIsReplacedByTheCycle) {
  Bench bench;
  bench.cabinet.latch_blind = true;
  into_touch(bench, 3);
  const TouchResult result = bench.expect<TouchResult>(1, 30);
  EXPECT_EQ(result.outcome, Outcome::kContact);
  EXPECT_EQ(result.source, CaptureSource::kPolled);
}

TEST(ApplicationFaults, ClockOfSevenWeeksWraps) {
  Bench bench({.clock_s = 4294967.296 - 2.0});
  into_touch(bench, 3);
  const TouchResult result = bench.expect<TouchResult>(1, 30);
  EXPECT_EQ(result.outcome, Outcome::kContact) << bench.log();
  EXPECT_LT(result.contact_clock_ms, 60000u);
  EXPECT_EQ(bench.state().task_error, 0) << bench.log();
}

TEST(ApplicationFaults, AnImpossibleMoveIsAMotionErrorAndTheNextCommandIsTaken) {
  for (const int moves : {0, 1, 2}) {
    SCOPED_TRACE(moves);
    Bench bench;
    bench.make_ready();
    bench.face_mm = kFaceMm;
    bench.cabinet.moves_until_error = moves;
    bench.send(1, bench.touch());
    bench.expect<Accepted>(1);
    const TouchResult result = bench.await<TouchResult>(30);
    EXPECT_EQ(result.outcome, Outcome::kMotionError) << name(result.outcome);
    EXPECT_EQ(result.error_number, kErrorImpossibleMove);
    const bool retract_due = moves > 0;  // the first move goes to clear
    const Permit permit = bench.await<Permit>();
    EXPECT_EQ(permit.reason, PermitReason::kBrokenOff);
    EXPECT_EQ(permit.state, retract_due ? PermitState::kRetractOnly : PermitState::kNone);
    EXPECT_EQ(bench.state().task_error, 0) << "the task lives again";
    bench.send(0, ResultAcknowledge{1});
    if (!retract_due) continue;
    bench.send(2, Retract{20000, 30000});
    bench.expect<Accepted>(2);
    EXPECT_EQ(bench.await<MoveResult>(10).outcome, Outcome::kArrived);
    EXPECT_NEAR(bench.depth_mm(), -20, 0.001);
  }
}

TEST(ApplicationFaults, ATaskThatDiesIsToldAndRefusesEverythingAfter) {
  Bench idle;
  int told = 0;
  for (const std::string& task : idle.controller.tasks()) {
    SCOPED_TRACE(task);
    Bench bench;
    into_touch(bench, 2);
    bench.controller.machine().fail_task(task, 20);
    bench.seconds(1);
    for (const std::string& alive : bench.controller.tasks())
      EXPECT_EQ(bench.controller.machine().task_status(alive), alive == task ? 20 : 1) << alive;
    EXPECT_TRUE(bench.cabinet.is_empty());
    const int before = bench.states_seen();
    bench.seconds(0.2);
    if (bench.states_seen() == before) continue;  // the one that sends
    ++told;
    const TouchResult result = bench.await<TouchResult>();
    EXPECT_EQ(result.outcome, Outcome::kTaskFailed) << name(result.outcome);
    EXPECT_EQ(result.error_number, 20);
    EXPECT_EQ(bench.state().task_error, 20);
    EXPECT_EQ(bench.state().permit, PermitState::kNone);
  }
  EXPECT_GE(told, 3);
}

TEST(ApplicationFaults, WithADeadTaskCommandsAndBeginAreRefused) {
  Bench bench;
  bench.make_ready();
  bench.controller.machine().fail_task("screen", 20);
  EXPECT_EQ(bench.expect<Permit>(0, 0.2).state, PermitState::kNone);
  bench.send(1, bench.travel_to(-30));
  const Rejected rejected = bench.expect<Rejected>(1);
  EXPECT_EQ(rejected.reason, RejectReason::kTaskFailed);
  EXPECT_EQ(rejected.detail, 20);
  bench.send(0, Begin{.run = 2, .confirm_within_ms = 1000});
  EXPECT_EQ(bench.expect<Permit>(0).detail, static_cast<std::int32_t>(RejectReason::kTaskFailed));
}

TEST(ApplicationFaults, OverrunsAreCounted) {
  Bench bench;
  bench.greet();
  EXPECT_EQ(bench.state().overruns, 0u);
  bench.controller.machine().set_limits({.lines_per_period = 60});
  bench.seconds(0.5);
  bench.controller.machine().set_limits({});
  bench.seconds(0.1);
  EXPECT_GT(bench.state().overruns, 0u);
  EXPECT_TRUE(bench.connected());
}

TEST(ApplicationFaults, NoPeriodNeedsMoreThanAFewHundredStatements) {
  Bench bench;
  into_touch(bench, 2);
  bench.expect<TouchResult>(1, 30);
  bench.send(0, ResultAcknowledge{1});
  bench.send(2, bench.travel_to(-40));
  bench.expect<Accepted>(2);
  bench.expect<MoveResult>(2, 10);
  for (const char* task : {"touchcal~", "receive", "motion", "send", "supervise", "screen"}) {
    const int lines = bench.controller.machine().most_lines(task);
    RecordProperty(task, lines);
    EXPECT_GT(lines, 0) << task;
    EXPECT_LT(lines, task == std::string("touchcal~") ? 5000 : 600) << task;
  }
}

TEST(ApplicationFaults, MovingByHandInManualModeForgetsTheWayBack) {
  Bench bench;
  into_touch(bench, 2);
  bench.send(0, Stop{});
  bench.await<TouchResult>(3);
  bench.send(0, ResultAcknowledge{1});
  EXPECT_TRUE(bench.state().flags & kRetractDue);
  bench.cabinet.mode = 1;
  bench.seconds(0.2);
  EXPECT_TRUE(bench.state().flags & kRetractDue) << "the mode alone moves nothing";
  for (int i = 0; i < 100; ++i) {
    bench.cabinet.joints_deg[0] += 0.02;
    bench.ticks(1);
  }
  EXPECT_FALSE(bench.state().flags & kRetractDue);
}

TEST(ApplicationFaults, StoppedTooFarBehindTheTriggerDoesNotCount) {
  Bench bench;
  bench.cabinet.ramp_s = 2.0;  // 8 mm/s runs out over 8 mm
  into_touch(bench, 3);
  const TouchResult result = bench.expect<TouchResult>(1, 60);
  EXPECT_EQ(result.outcome, Outcome::kOvertravel) << name(result.outcome);
  EXPECT_GT(result.overtravel_dmm, 65000);
}

TEST(ApplicationFaults, TheSecondTouchBeginsNotBeyondApproach) {
  Bench bench;
  bench.make_ready();
  bench.face_mm = 0.5;
  Touch touch = bench.touch();
  touch.second_speed_um_s = 2000;
  touch.second_backoff_dmm = 50000;
  bench.send(1, touch);
  bench.expect<Accepted>(1);
  double highest = 100;
  std::optional<Message> end;
  bool touched = false;
  for (int left = 5000; !end && left > 0; --left) {
    end = bench.next(0.004);
    touched = touched || bench.depth_mm() > 0.5;
    if (touched && bench.state().phase == Phase::kSearch) highest = std::min(highest, bench.depth_mm());
  }
  ASSERT_TRUE(end);
  const auto result = std::get<TouchResult>(end->payload);
  EXPECT_EQ(result.outcome, Outcome::kContact) << name(result.outcome);
  EXPECT_EQ(result.first_source, CaptureSource::kLatched);
  EXPECT_GT(highest, -0.01);
}

TEST(ApplicationFaults, BeginWhileACommandRunsEndsItWithItsPermit) {
  Bench bench;
  into_touch(bench, -15);
  bench.send(0, Begin{.run = 2, .confirm_within_ms = 5000});
  const Permit permit = bench.expect<Permit>(0);
  EXPECT_EQ(permit.state, PermitState::kNone);
  EXPECT_EQ(permit.detail, static_cast<std::int32_t>(RejectReason::kBusy));
  EXPECT_EQ(bench.expect<TouchResult>(1, 0.3).outcome, Outcome::kStopped);
  EXPECT_LT(bench.depth_mm(), -10);
}

TEST(ApplicationTime, StopBeginsToSlowDownWithin20Milliseconds) {
  Bench bench;
  into_touch(bench, -10);
  bench.send(0, Stop{});
  bench.seconds(0.020);
  EXPECT_TRUE(bench.cabinet.is_empty()) << "resetMotion forgets the queue";
}

TEST(ApplicationTime, ALostLinkBeginsToSlowDownWithin20Milliseconds) {
  Bench bench;
  into_touch(bench, 2);
  bench.disconnect();
  bench.seconds(0.020);
  EXPECT_TRUE(bench.cabinet.is_empty());
}

TEST(ApplicationTime, ASilentHostIsStoppedWhenItsTimeIsOver) {
  Bench bench;
  into_touch(bench, 0.5);
  bench.heartbeats = false;
  const double from_s = bench.cabinet.now_s;
  while (!bench.cabinet.is_empty() && bench.cabinet.now_s < from_s + 2) bench.ticks(1);
  EXPECT_LE(bench.cabinet.now_s - from_s, 0.500 + 0.020);
  EXPECT_GE(bench.cabinet.now_s - from_s, 0.400 - 0.008) << "a heartbeat may have come just before";
}

TEST(ApplicationTime, ResultsComeWithin100MillisecondsOfStandstill) {
  Bench bench;
  into_touch(bench, 2);
  double moved_s = 0;
  std::optional<Message> end;
  for (int left = 5000; !end && left > 0; --left) {
    const Joint before = bench.cabinet.joints_deg;
    end = bench.next(0.004);
    if (bench.cabinet.joints_deg != before) moved_s = bench.cabinet.now_s;
  }
  ASSERT_TRUE(end);
  EXPECT_LE(bench.cabinet.now_s - moved_s, 0.100);
}

TEST(ApplicationTime, AnEdgeStopsASearchInTheCycleThatSeesIt) {
  Bench bench;
  into_touch(bench, kFaceMm);
  bench.ticks(2);
  EXPECT_TRUE(bench.cabinet.is_empty());
}

TEST(ApplicationLink, AnswersSurviveAConnectionThatTakesFewBytes) {
  Bench bench;
  bench.make_ready();
  for (const std::size_t room : {3u, 11u, 30u, 77u}) {
    bench.socket().room = room;
    bench.send(0, ResultQuery{99});
    bench.send(0, ResultQuery{98});
    bench.seconds(0.05);
    bench.socket().room = SIZE_MAX;
    EXPECT_EQ(bench.expect<ResultUnknown>(99).command_sequence, 99u) << room;
    EXPECT_EQ(bench.expect<ResultUnknown>(98).command_sequence, 98u) << room;
  }
}

TEST(ApplicationLink, DeadConnectionsAreLetGoWhateverClearBufferDoesToLivingOnes) {
  Bench bench;
  bench.cabinet.clear_buffer_closes = false;
  bench.greet();
  bench.disconnect();
  bench.seconds(0.1);
  EXPECT_GT(bench.greet().session, 0u);
  EXPECT_EQ(bench.state().permit, PermitState::kNone);
}

}  // namespace
}  // namespace val3
