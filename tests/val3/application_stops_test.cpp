// What breaks a touch off, in each of its phases: PROTOCOL.md sections 6 to 8.
#include <gtest/gtest.h>

#include <functional>

#include "cs8_protocol/names.hpp"
#include "tests/val3/touch_steps.hpp"

namespace val3 {
namespace {

struct PhaseCase {
  Phase phase;
  bool retract_due;
  std::function<void(Bench&)> reach;
};

void reach_search(Bench& b) { run_until_depth(b, 3); }

/// A touch that begins 100 mm above clear, brought into each phase.
std::vector<PhaseCase> phases() {
  return {{Phase::kTravel, false, [](Bench& b) { run_until_depth(b, -80); }},
          {Phase::kApproach, true, [](Bench& b) { run_until_depth(b, -10); }},
          {Phase::kSearch, true, reach_search},
          {Phase::kRetract, true, [](Bench& b) {
             run_until_depth(b, kFaceMm);
             for (int left = 1000; b.depth_mm() > 4 && left > 0; --left) b.ticks(1);
           }}};
}

/// Ready, 100 mm above clear, touch 2 taken and in `wanted`.
void into_phase(Bench& bench, const PhaseCase& wanted) {
  bench.make_ready();
  bench.send(1, bench.travel_to(-120));
  bench.expect<Accepted>(1);
  bench.expect<MoveResult>(1, 10);
  bench.send(0, ResultAcknowledge{1});
  bench.face_mm = kFaceMm;
  begin_touch(bench, 2, bench.touch());
  wanted.reach(bench);
  EXPECT_EQ(bench.state().phase, wanted.phase);
}

TEST(ApplicationStops, AStopAtOnceBehindItsCommandEndsItInItsFirstPhase) {
  Bench bench;
  bench.make_ready();
  bench.send(1, bench.travel_to(-120));
  bench.send(0, Stop{});
  bench.expect<Accepted>(1);
  const MoveResult result = bench.expect<MoveResult>(1, 3);
  EXPECT_EQ(result.outcome, Outcome::kStopped);
  EXPECT_EQ(result.phase, Phase::kTravel);
}

TEST(ApplicationStops, StopEndsATouchInEachPhase) {
  for (const PhaseCase& wanted : phases()) {
    SCOPED_TRACE(name(wanted.phase));
    Bench bench;
    into_phase(bench, wanted);
    const double depth = bench.depth_mm();
    bench.send(0, Stop{});
    const TouchResult result = bench.expect<TouchResult>(2, 3);
    EXPECT_EQ(result.outcome, Outcome::kStopped);
    EXPECT_EQ(result.phase, wanted.phase);
    const bool is_search = wanted.phase == Phase::kSearch;  // brought back to approach
    EXPECT_NEAR(bench.depth_mm(), is_search ? 0 : depth, is_search ? 0.01 : 5);
    EXPECT_EQ(bench.expect<Permit>(0).state,
              wanted.retract_due ? PermitState::kRetractOnly : PermitState::kNone);
    EXPECT_EQ((bench.state().flags & kRetractDue) != 0, wanted.retract_due);
    const Joint stands = bench.cabinet.joints_deg;
    bench.seconds(0.5);
    EXPECT_EQ(bench.cabinet.joints_deg, stands);
    if (!wanted.retract_due) continue;
    bench.send(0, ResultAcknowledge{2});
    expect_way_back(bench, 3);
  }
}

TEST(ApplicationStops, ALostHostStopsTheArmOnTheSpotAndTheResultWaits) {
  for (const PhaseCase& wanted : phases()) {
    for (const bool closes : {true, false}) {
      SCOPED_TRACE(std::string(name(wanted.phase)) + (closes ? " closed" : " silent"));
      Bench bench;
      into_phase(bench, wanted);
      if (closes)
        bench.disconnect();
      else
        bench.heartbeats = false;
      bench.seconds(closes ? 0.2 : 0.7);
      const Joint stands = bench.cabinet.joints_deg;
      bench.seconds(1.5);
      EXPECT_EQ(bench.cabinet.joints_deg, stands) << "200 ms after the link is lost the arm stands";
      bench.heartbeats = true;
      EXPECT_EQ(bench.greet().open_sequence, 2u);
      bench.send(0, ResultQuery{2});
      const TouchResult result = bench.expect<TouchResult>(2);
      EXPECT_EQ(result.outcome, Outcome::kHeartbeatLost);
      EXPECT_EQ(bench.state().permit, PermitState::kNone);
      if (closes) {  // a silent host is waited for, and the touch goes on meanwhile
        EXPECT_EQ(result.phase, wanted.phase);
        EXPECT_EQ((bench.state().flags & kRetractDue) != 0, wanted.retract_due);
      }
      bench.send(0, ResultAcknowledge{2});
      bench.send(3, Retract{20000, 30000});
      EXPECT_EQ(bench.expect<Rejected>(3).reason, RejectReason::kNotPermitted) << "without a person's word";
    }
  }
}

TEST(ApplicationStops, ASecondHelloEndsWhatALostHostEnds) {
  for (const PhaseCase& wanted : phases()) {
    SCOPED_TRACE(name(wanted.phase));
    Bench bench;
    into_phase(bench, wanted);
    EXPECT_EQ(bench.greet_again().open_sequence, 2u);
    EXPECT_EQ(bench.expect<TouchResult>(2, 2).outcome, Outcome::kHeartbeatLost);
    EXPECT_EQ(bench.state().permit, PermitState::kNone);
    bench.send(0, ResultAcknowledge{2});
    bench.send(3, Retract{20000, 30000});
    EXPECT_EQ(bench.expect<Rejected>(3).reason, RejectReason::kNotPermitted) << "without a person's word";
  }
}

TEST(ApplicationStops, ASecondHelloEndsAPermitAndWhatIsOnItsWay) {
  Bench bench;
  bench.make_ready();
  EXPECT_EQ(bench.permit(), PermitState::kGranted);
  bench.greet_again();
  EXPECT_EQ(bench.state().permit, PermitState::kNone);
  bench.send(0, Begin{1, 30000});
  EXPECT_EQ(bench.expect<Permit>(0).state, PermitState::kAwaited);
  bench.send(0, Begin{2, 30000});
  bench.send(0, Hello{500});
  bench.expect<Welcome>(0);  // and not the answer to Begin before it
  bench.expect_silence(0.5);
  EXPECT_EQ(bench.state().permit, PermitState::kNone);
}

TEST(ApplicationStops, AReceiveTaskThatStandsStillStopsTheArm) {
  Bench bench;
  into_phase(bench, phases().front());
  bench.socket().timeout_s = 0;  // a read that waits for ever
  bench.heartbeats = false;
  bench.seconds(0.3);
  const Joint stands = bench.cabinet.joints_deg;
  EXPECT_EQ(bench.variable<double>("nPermit"), 0) << "before the silence of the host counts";
  bench.seconds(1);
  EXPECT_EQ(bench.cabinet.joints_deg, stands);
  bench.socket().timeout_s = -1;
  bench.heartbeats = true;
  EXPECT_EQ(bench.await<TouchResult>(1).outcome, Outcome::kHeartbeatLost);
}

TEST(ApplicationStops, AMoveThatTheArmDoesNotBeginIsAMotionErrorAtOnce) {
  Bench bench;
  bench.make_ready();
  bench.cabinet.stopped = true;  // it stays in the store, as one that cannot be carried out
  bench.send(2, bench.touch());
  bench.expect<Accepted>(2);
  const TouchResult result = bench.expect<TouchResult>(2, 5);
  EXPECT_EQ(result.outcome, Outcome::kMotionError) << name(result.outcome);
  EXPECT_EQ(result.error_number, 150);
  EXPECT_EQ(bench.state().permit, PermitState::kNone);
}

TEST(ApplicationStops, AMoveThatStandsStillOnItsWayIsAMotionErrorUnlessTheOperatorHoldsItsSpeedAtZero) {
  Bench bench;
  into_phase(bench, phases().front());
  bench.cabinet.monitor_speed_percent = 0;
  bench.seconds(5);
  EXPECT_EQ(bench.state().active_sequence, 2u) << "the deadline decides";
  bench.cabinet.monitor_speed_percent = 100;
  bench.seconds(0.1);
  bench.cabinet.stopped = true;
  const TouchResult result = bench.expect<TouchResult>(2, 5);
  EXPECT_EQ(result.outcome, Outcome::kMotionError) << name(result.outcome);
  EXPECT_EQ(result.error_number, 60) << "it had begun";
}

TEST(ApplicationStops, LostPermissionEndsATouchForGood) {
  const std::vector<std::pair<std::string, std::function<void(Bench&, bool)>>> losses{
      {"mode", [](Bench& b, bool lost) { b.cabinet.mode = lost ? 1 : 4; }},
      {"power", [](Bench& b, bool lost) { b.cabinet.powered = !lost; }},
      {"hold", [](Bench& b, bool lost) { b.cabinet.held = lost; }},
      {"emergency stop", [](Bench& b, bool lost) { b.cabinet.es_status = lost ? 2 : 0; }},
      {"cell", [](Bench& b, bool lost) { b.cell_closed = !lost; }}};
  for (const auto& [what, set] : losses) {
    SCOPED_TRACE(what);
    Bench bench;
    into_phase(bench, phases()[2]);
    set(bench, true);
    const TouchResult result = bench.await<TouchResult>(1);
    EXPECT_EQ(result.outcome, Outcome::kPermissionLost) << name(result.outcome);
    EXPECT_EQ(result.phase, Phase::kSearch);
    EXPECT_EQ(bench.await<Permit>().reason, PermitReason::kPermissionLost);
    const Joint stands = bench.cabinet.joints_deg;
    set(bench, false);
    bench.seconds(1);
    EXPECT_EQ(bench.cabinet.joints_deg, stands) << "forgotten and never resumed";
    EXPECT_TRUE(bench.cabinet.is_empty());
  }
}

TEST(ApplicationStops, ACutCableEndsATouch) {
  for (const bool contact_wire : {true, false}) {
    Bench bench;
    into_phase(bench, phases()[1]);
    (contact_wire ? bench.wires.contact : bench.wires.loop) = contact_wire;
    const TouchResult result = bench.await<TouchResult>(1);
    // a guard stops on whichever changes first; the other one never follows
    EXPECT_TRUE(result.outcome == Outcome::kProbeFault || contact_wire) << name(result.outcome);
    EXPECT_NE(result.outcome, Outcome::kContact);
  }
  Bench bench;
  into_phase(bench, phases()[2]);
  bench.wires.loop = false;  // the loop is cut while the probe is free
  const TouchResult result = bench.await<TouchResult>(1);
  EXPECT_EQ(result.outcome, Outcome::kProbeFault) << name(result.outcome);
  EXPECT_EQ(bench.await<Permit>().reason, PermitReason::kProbeFault);
  EXPECT_FALSE(bench.state().flags & kTouchTested);
}

TEST(ApplicationStops, ADeadlineEndsATouch) {
  Bench bench;
  bench.make_ready();
  Touch touch = bench.touch();
  touch.deadline_ms = 1500;  // 1 s to approach, then a search of 2.5 s
  begin_touch(bench, 1, touch);
  const TouchResult result = bench.expect<TouchResult>(1, 2.0);
  EXPECT_EQ(result.outcome, Outcome::kDeadline);
  EXPECT_EQ(result.phase, Phase::kSearch);
  EXPECT_EQ(bench.await<Permit>().state, PermitState::kRetractOnly);
}

TEST(ApplicationStops, FinishStopsWhatRunsAndGivesThePermitBack) {
  Bench bench;
  into_phase(bench, phases()[2]);
  bench.send(0, Finish{});
  bool stopped = false;
  bool finished = false;
  while (const auto message = bench.next(3)) {
    if (const auto* result = std::get_if<TouchResult>(&message->payload))
      stopped = result->outcome == Outcome::kStopped;
    if (const auto* permit = std::get_if<Permit>(&message->payload))
      finished = permit->state == PermitState::kNone;
  }
  EXPECT_TRUE(stopped);
  EXPECT_TRUE(finished);
}

TEST(ApplicationStops, ARetractThatIsBrokenOffGoesOnLater) {
  Bench bench;
  into_phase(bench, phases()[2]);
  bench.send(0, Stop{});
  bench.expect<TouchResult>(2, 3);
  bench.await<Permit>();
  bench.send(0, ResultAcknowledge{2});
  bench.send(3, Retract{5000, 30000});
  bench.expect<Accepted>(3);
  bench.seconds(1);
  bench.send(0, Stop{});
  EXPECT_EQ(bench.expect<MoveResult>(3, 1).outcome, Outcome::kStopped);
  EXPECT_TRUE(bench.state().flags & kRetractDue);
  bench.send(0, ResultAcknowledge{3});
  while (bench.next(0.1)) {
  }
  bench.send(0, Begin{.run = 2, .confirm_within_ms = 30000});
  EXPECT_EQ(bench.await<Permit>().state, PermitState::kAwaited);
  bench.confirm();
  bench.await<Permit>();
  bench.send(4, bench.touch());
  EXPECT_EQ(bench.expect<Rejected>(4).reason, RejectReason::kRetractPending);
  expect_way_back(bench, 5);
}

TEST(ApplicationStops, ATaskThatDiesIsNoticedAndNothingMovesAnyMore) {
  Bench idle;
  const std::vector<std::string> tasks = idle.controller.tasks();
  EXPECT_GE(tasks.size(), 4u);
  for (const std::string& task : tasks) {
    SCOPED_TRACE(task);
    Bench bench;
    into_phase(bench, phases()[2]);
    bench.controller.machine().fail_task(task, 150);
    bench.seconds(0.3);
    const Joint stands = bench.cabinet.joints_deg;
    bench.seconds(1);
    EXPECT_EQ(bench.cabinet.joints_deg, stands);
    EXPECT_TRUE(bench.cabinet.is_empty());
  }
}

TEST(ApplicationStops, StopLeavesNoTaskAlive) {
  Bench bench;
  into_phase(bench, phases()[2]);
  bench.controller.machine().stop();
  bench.seconds(0.3);
  EXPECT_TRUE(bench.controller.tasks().empty()) << testing::PrintToString(bench.controller.tasks());
  EXPECT_TRUE(bench.cabinet.is_empty());
  const Joint stands = bench.cabinet.joints_deg;
  bench.seconds(1);
  EXPECT_EQ(bench.cabinet.joints_deg, stands);
}

}  // namespace
}  // namespace val3
