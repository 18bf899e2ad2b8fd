// Touches and travels: PROTOCOL.md sections 3, 6, 8 and 10.
#include <gtest/gtest.h>

#include <cmath>

#include "cs8_protocol/names.hpp"
#include "tests/val3/touch_steps.hpp"

namespace val3 {
namespace {

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
  EXPECT_NEAR(result.contact_clock_ms, bench.cabinet.now_s * 1000, 4000);
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
  const double before_s = bench.cabinet.now_s;
  bench.send(1, travel);
  bench.expect<Accepted>(1);
  double highest = 0;
  std::optional<Message> end;
  while (!end && bench.cabinet.now_s < before_s + 20) {
    end = bench.next(0.004);
    highest = std::min(highest, bench.depth_mm());
  }
  ASSERT_TRUE(end);
  EXPECT_EQ(std::get<MoveResult>(end->payload).outcome, Outcome::kArrived);
  EXPECT_NEAR(highest, -100, 0.5);
  EXPECT_GE(bench.cabinet.now_s - before_s, 160 / 50.0) << "never faster than asked";
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

}  // namespace
}  // namespace val3
