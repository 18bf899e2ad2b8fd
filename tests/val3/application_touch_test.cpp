// Touches, travels and what breaks them off: PROTOCOL.md sections 3, 6, 8 and 10.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "cs8_protocol/names.hpp"
#include "tests/val3/bench.hpp"

namespace val3 {
namespace {

using namespace cs8;

constexpr double kFaceMm = 8.0;

double apart_deg(const JointsMicrodeg& a, const JointsMicrodeg& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]) / 1e6);
  return most;
}

/// Depth of a posture below the approach posture, from its height in world.
double depth_mm(Bench& bench, const JointsMicrodeg& joints) {
  const Joint before = bench.cabinet.joints_deg;
  for (std::size_t i = 0; i < joints.size(); ++i) bench.cabinet.joints_deg[i] = joints[i] / 1e6;
  const double depth = bench.depth_mm();
  bench.cabinet.joints_deg = before;
  return depth;
}

/// Sends a touch with a number and takes Accepted.
void begin_touch(Bench& bench, std::uint32_t sequence, const Touch& touch) {
  bench.send(sequence, touch);
  bench.expect<Accepted>(sequence);
}

TouchResult finish_touch(Bench& bench, std::uint32_t sequence) {
  return bench.expect<TouchResult>(sequence, 30);
}

void run_until_depth(Bench& bench, double mm) {
  for (int left = 5000; bench.depth_mm() < mm && left > 0; --left) bench.ticks(1);
  EXPECT_GE(bench.depth_mm(), mm);
}

TEST(ApplicationTouch, MeetsTheFaceAndTellsWhere) {
  Bench bench;
  bench.face_mm = kFaceMm;
  bench.make_ready();
  begin_touch(bench, 5, bench.touch());
  EXPECT_EQ(bench.state().active_sequence, 5u);
  const TouchResult result = finish_touch(bench, 5);
  EXPECT_EQ(result.outcome, Outcome::kContact) << name(result.outcome) << '\n' << bench.log();
  EXPECT_EQ(result.phase, Phase::kIdle);
  EXPECT_EQ(result.source, CaptureSource::kLatched);
  EXPECT_NEAR(depth_mm(bench, result.contact), kFaceMm, 0.005) << "0.2 ms at 8 mm/s is 1.6 um";
  EXPECT_GT(depth_mm(bench, result.stopped), kFaceMm);
  EXPECT_NEAR(result.overtravel_dmm / 1e4, depth_mm(bench, result.stopped) - depth_mm(bench, result.contact),
              0.002);
  EXPECT_EQ(result.search_speed_um_s, 8000);
  EXPECT_EQ(result.monitor_speed_percent, 100);
  EXPECT_NEAR(result.contact_clock_ms, bench.cabinet.clock_s * 1000, 4000);
  EXPECT_GT(result.contact_clock_ms, 0u);
  EXPECT_EQ(result.error_number, 0);
  EXPECT_EQ(result.first_source, CaptureSource::kNone);
  EXPECT_EQ(result.first_contact, JointsMicrodeg{});
  EXPECT_EQ(result.edges, 1u);
  EXPECT_LT(apart_deg(bench.state().joints, bench.touch().clear), 1e-5) << "at clear";
  EXPECT_FALSE(bench.state().flags & kRetractDue);
  EXPECT_EQ(bench.state().permit, PermitState::kGranted) << "a measurement does not end the run";
  EXPECT_EQ(bench.state().active_sequence, 0u);
  EXPECT_EQ(bench.state().overruns, 0u);
}

TEST(ApplicationTouch, SearchesAtTheSpeedThatWasAsked) {
  Bench bench;
  bench.face_mm = 15;
  bench.make_ready();
  Touch touch = bench.touch();
  touch.search_speed_um_s = 4000;
  begin_touch(bench, 1, touch);
  run_until_depth(bench, 2);
  const double from = bench.depth_mm();
  bench.seconds(1);
  EXPECT_NEAR(bench.depth_mm() - from, 4.0, 0.05);
}

TEST(ApplicationTouch, ASecondSlowTouchIsTheMeasurement) {
  Bench bench;
  bench.face_mm = kFaceMm;
  bench.make_ready();
  Touch touch = bench.touch();
  touch.second_speed_um_s = 1000;
  touch.second_backoff_dmm = 10000;
  begin_touch(bench, 1, touch);
  const TouchResult result = finish_touch(bench, 1);
  EXPECT_EQ(result.outcome, Outcome::kContact) << name(result.outcome) << '\n' << bench.log();
  EXPECT_EQ(result.source, CaptureSource::kLatched);
  EXPECT_EQ(result.first_source, CaptureSource::kLatched);
  EXPECT_EQ(result.search_speed_um_s, 1000);
  EXPECT_NEAR(depth_mm(bench, result.first_contact), kFaceMm, 0.005);
  EXPECT_NEAR(depth_mm(bench, result.contact), kFaceMm, 0.001);
  EXPECT_LT(depth_mm(bench, result.stopped) - kFaceMm, result.overtravel_dmm / 1e4)
      << "that of the first is longer";
  EXPECT_EQ(result.edges, 1u);
}

TEST(ApplicationTouch, WithoutALatchTheCycleThatSawTheInputCounts) {
  Bench bench({.latch = false});
  bench.face_mm = kFaceMm;
  bench.make_ready();
  begin_touch(bench, 1, bench.touch());
  const TouchResult result = finish_touch(bench, 1);
  EXPECT_EQ(result.outcome, Outcome::kContact) << name(result.outcome) << '\n' << bench.log();
  EXPECT_EQ(result.source, CaptureSource::kPolled);
  const double late_mm = depth_mm(bench, result.contact) - kFaceMm;
  EXPECT_GE(late_mm, 0);
  EXPECT_LT(late_mm, 2 * 0.004 * 8.0);
}

TEST(ApplicationTouch, NoFaceIsNoContact) {
  Bench bench;
  bench.make_ready();
  begin_touch(bench, 1, bench.touch());
  const TouchResult result = finish_touch(bench, 1);
  EXPECT_EQ(result.outcome, Outcome::kNoContact);
  EXPECT_EQ(result.phase, Phase::kIdle);
  EXPECT_EQ(result.source, CaptureSource::kNone);
  EXPECT_EQ(result.contact, JointsMicrodeg{});
  EXPECT_EQ(result.contact_clock_ms, 0u);
  EXPECT_LT(apart_deg(bench.state().joints, bench.touch().clear), 1e-5);
}

TEST(ApplicationTouch, AStuckProbeDoesNotCount) {
  Bench bench;
  bench.face_mm = kFaceMm;
  bench.make_ready();
  bench.wires.stuck = true;
  begin_touch(bench, 1, bench.touch());
  const TouchResult result = finish_touch(bench, 1);
  EXPECT_EQ(result.outcome, Outcome::kProbeStuck);
  EXPECT_LT(apart_deg(bench.state().joints, bench.touch().clear), 1e-5);
}

TEST(ApplicationTouch, AProbeStuckAfterTheFirstTouchIsFoundBeforeTheSecond) {
  Bench bench;
  bench.face_mm = kFaceMm;
  bench.make_ready();
  bench.wires.stuck = true;
  Touch touch = bench.touch();
  touch.second_speed_um_s = 1000;
  touch.second_backoff_dmm = 10000;
  begin_touch(bench, 1, touch);
  EXPECT_EQ(finish_touch(bench, 1).outcome, Outcome::kProbeStuck);
  EXPECT_LT(apart_deg(bench.state().joints, touch.clear), 1e-5);
}

TEST(ApplicationTouch, EdgesOfBounceAreCountedAndTheFirstIsTheTrigger) {
  Bench bench;
  bench.face_mm = kFaceMm;
  bench.cabinet.ramp_s = 0.04;  // a longer way to stand in which to bounce
  bench.make_ready();
  bench.wires.bounce_mm = 0.07;
  begin_touch(bench, 1, bench.touch());
  const TouchResult result = finish_touch(bench, 1);
  EXPECT_EQ(result.outcome, Outcome::kContact) << name(result.outcome);
  EXPECT_GE(result.edges, 2u);
  EXPECT_NEAR(depth_mm(bench, result.contact), kFaceMm, 0.005);
}

TEST(ApplicationTouch, AnEdgeInTheApproachStopsTheArmAndOnlyARetractIsTaken) {
  Bench bench;
  bench.face_mm = -10;  // between clear and approach
  bench.make_ready();
  begin_touch(bench, 1, bench.touch());
  const TouchResult result = finish_touch(bench, 1);
  EXPECT_EQ(result.outcome, Outcome::kUnexpectedContact);
  EXPECT_EQ(result.phase, Phase::kApproach);
  EXPECT_LT(bench.depth_mm(), -9) << "20 mm/s: it stops within a millimetre";
  const Permit permit = bench.expect<Permit>(0);
  EXPECT_EQ(permit.state, PermitState::kRetractOnly);
  EXPECT_EQ(permit.reason, PermitReason::kBrokenOff);
  EXPECT_TRUE(bench.state().flags & kRetractDue);
  bench.send(0, ResultAcknowledge{1});
  bench.send(2, bench.touch());
  EXPECT_EQ(bench.expect<Rejected>(2).reason, RejectReason::kNotPermitted);
  bench.send(3, Retract{20000, 30000});
  bench.expect<Accepted>(3);
  const MoveResult back = bench.expect<MoveResult>(3, 10);
  EXPECT_EQ(back.outcome, Outcome::kArrived);
  EXPECT_LT(apart_deg(back.joints, bench.touch().clear), 1e-5);
  EXPECT_EQ(bench.expect<Permit>(0).state, PermitState::kNone);
  EXPECT_FALSE(bench.state().flags & kRetractDue);
}

TEST(ApplicationTouch, AnEdgeInATravelStopsTheArm) {
  Bench bench;
  bench.make_ready();
  bench.send(1, bench.travel_to(-120));
  bench.expect<Accepted>(1);
  EXPECT_EQ(bench.expect<MoveResult>(1, 10).outcome, Outcome::kArrived);
  bench.send(0, ResultAcknowledge{1});
  bench.face_mm = -60;
  bench.send(2, bench.travel_to(-20));
  bench.expect<Accepted>(2);
  const MoveResult result = bench.expect<MoveResult>(2, 10);
  EXPECT_EQ(result.outcome, Outcome::kUnexpectedContact);
  EXPECT_EQ(result.phase, Phase::kTravel);
  EXPECT_LT(bench.depth_mm(), -55);
  const Permit permit = bench.expect<Permit>(0);
  EXPECT_EQ(permit.state, PermitState::kNone) << "no touch, so no way back is known";
  EXPECT_EQ(permit.reason, PermitReason::kBrokenOff);
}

TEST(ApplicationTouch, TravelGoesThroughViaAtItsSpeed) {
  Bench bench;
  bench.make_ready();
  Travel travel = bench.travel_to(-20);
  travel.via_count = 2;
  travel.via[0] = bench.at_depth(-60);
  travel.via[1] = bench.at_depth(-100);
  travel.travel_speed_um_s = 50000;
  const double before_s = bench.cabinet.clock_s;
  bench.send(1, travel);
  bench.expect<Accepted>(1);
  double highest = 0;
  std::optional<Message> end;
  while (!end && bench.cabinet.clock_s < before_s + 20) {
    end = bench.next(0.004);
    highest = std::min(highest, bench.depth_mm());
  }
  ASSERT_TRUE(end);
  EXPECT_EQ(std::get<MoveResult>(end->payload).outcome, Outcome::kArrived);
  EXPECT_NEAR(highest, -100, 0.5);
  EXPECT_GE(bench.cabinet.clock_s - before_s, 160 / 50.0) << "never faster than asked";
}

// ---- repeats ----

TEST(ApplicationTouch, ARepeatedSequenceNeverMoves) {
  Bench bench;
  bench.face_mm = kFaceMm;
  bench.make_ready();
  begin_touch(bench, 7, bench.touch());
  bench.send(7, bench.touch());
  bench.expect<Accepted>(7);
  bench.send(0, ResultQuery{7});
  bench.expect<Accepted>(7);
  bench.send(8, bench.touch());
  EXPECT_EQ(bench.expect<Rejected>(8).reason, RejectReason::kBusy);
  bench.send(6, bench.touch());
  EXPECT_EQ(bench.expect<Rejected>(6).reason, RejectReason::kStaleSequence);
  const TouchResult result = finish_touch(bench, 7);
  const Joint stands = bench.cabinet.joints_deg;
  bench.send(7, bench.travel_to(-30));  // what else the repeat contains is not looked at
  EXPECT_EQ(bench.expect<TouchResult>(7).contact, result.contact);
  bench.send(0, ResultQuery{7});
  EXPECT_EQ(bench.expect<TouchResult>(7).contact, result.contact);
  bench.send(8, bench.touch());
  EXPECT_EQ(bench.expect<Rejected>(8).reason, RejectReason::kResultUnacknowledged);
  bench.send(0, ResultAcknowledge{6});
  bench.send(0, ResultQuery{7});
  bench.expect<TouchResult>(7);
  bench.send(0, ResultAcknowledge{7});
  bench.send(0, ResultQuery{7});
  EXPECT_EQ(bench.expect<ResultUnknown>(7).command_sequence, 7u);
  bench.send(7, bench.touch());
  EXPECT_EQ(bench.expect<Rejected>(7).reason, RejectReason::kStaleSequence);
  bench.send(0, bench.touch());
  EXPECT_EQ(bench.expect<Rejected>(0).reason, RejectReason::kStaleSequence);
  EXPECT_EQ(bench.cabinet.joints_deg, stands);
  begin_touch(bench, 8, bench.touch());
}

// ---- what breaks a touch off, in each of its phases ----

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
    bench.send(3, Retract{20000, 30000});
    bench.expect<Accepted>(3);
    EXPECT_EQ(bench.expect<MoveResult>(3, 10).outcome, Outcome::kArrived);
    EXPECT_NEAR(bench.depth_mm(), -20, 0.001);
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

TEST(ApplicationStops, LostPermissionEndsATouchForGood) {
  const std::vector<std::pair<std::string, std::function<void(Bench&, bool)>>> losses{
      {"mode", [](Bench& b, bool lost) { b.cabinet.mode = lost ? 1 : 4; }},
      {"power", [](Bench& b, bool lost) { b.cabinet.powered = !lost; }},
      {"hold", [](Bench& b, bool lost) { b.cabinet.held = lost; }},
      {"emergency stop", [](Bench& b, bool lost) { b.cabinet.emergency_stop = lost ? 2 : 0; }},
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
  bench.send(5, Retract{20000, 30000});
  bench.expect<Accepted>(5);
  EXPECT_EQ(bench.expect<MoveResult>(5, 10).outcome, Outcome::kArrived);
  EXPECT_NEAR(bench.depth_mm(), -20, 0.001);
}

TEST(ApplicationStops, ATaskThatDiesIsNoticedAndNothingMovesAnyMore) {
  Bench idle;
  const std::vector<std::string> tasks = idle.interpreter.tasks();
  EXPECT_GE(tasks.size(), 4u);
  for (const std::string& task : tasks) {
    SCOPED_TRACE(task);
    Bench bench;
    into_phase(bench, phases()[2]);
    bench.interpreter.fail_task(task, 150);
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
  bench.interpreter.stop();
  bench.seconds(0.3);
  EXPECT_TRUE(bench.interpreter.tasks().empty()) << testing::PrintToString(bench.interpreter.tasks());
  EXPECT_TRUE(bench.cabinet.is_empty());
  const Joint stands = bench.cabinet.joints_deg;
  bench.seconds(1);
  EXPECT_EQ(bench.cabinet.joints_deg, stands);
}

}  // namespace
}  // namespace val3
