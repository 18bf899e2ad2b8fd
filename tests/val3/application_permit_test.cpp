// The order before a run, and what is refused: PROTOCOL.md sections 7 and 9.
#include <gtest/gtest.h>

#include <functional>

#include "tests/val3/bench.hpp"

namespace val3 {
namespace {

using namespace cs8;

Permit begin(Bench& bench) {
  bench.send(0, Begin{.run = 31, .confirm_within_ms = 5000});
  const Permit permit = bench.expect<Permit>(0);
  EXPECT_EQ(permit.run, 31u);
  return permit;
}

TEST(ApplicationPermit, BeginIsRefusedWithTheFirstThatIsNotSo) {
  const std::vector<std::pair<RejectReason, std::function<void(Bench&)>>> wrongs{
      {RejectReason::kEmergencyStop, [](Bench& b) { b.cabinet.es_status = 2; }},
      {RejectReason::kEmergencyStop, [](Bench& b) { b.cabinet.es_status = 1; }},
      {RejectReason::kNotRemote, [](Bench& b) { b.cabinet.mode = 3; }},
      {RejectReason::kNotPowered, [](Bench& b) { b.cabinet.powered = false; }},
      {RejectReason::kHold, [](Bench& b) { b.cabinet.held = true; }},
      {RejectReason::kNotCalibrated, [](Bench& b) { b.cabinet.calibrated = false; }},
      {RejectReason::kMonitorSpeed, [](Bench& b) { b.cabinet.monitor_speed_percent = 99; }},
      {RejectReason::kCellOpen, [](Bench& b) { b.cell_closed = false; }},
      {RejectReason::kProbeInputs, [](Bench& b) { b.wires.loop = false; }},
      {RejectReason::kProbeInputs, [](Bench& b) { b.wires.contact = true; }},
      {RejectReason::kProbeTriggered, [](Bench& b) { b.wires.hand = true; }},
  };
  for (const auto& [reason, make_wrong] : wrongs) {
    SCOPED_TRACE(static_cast<int>(reason));
    Bench bench;
    bench.touch_by_hand();
    bench.greet();
    make_wrong(bench);
    bench.seconds(0.1);
    const Permit permit = begin(bench);
    EXPECT_EQ(permit.state, PermitState::kNone);
    EXPECT_EQ(permit.reason, PermitReason::kRefused);
    EXPECT_EQ(permit.detail, static_cast<std::int32_t>(reason));
  }
}

TEST(ApplicationPermit, WithoutATouchTestNothingBegins) {
  Bench bench;
  bench.greet();
  EXPECT_EQ(begin(bench).detail, static_cast<std::int32_t>(RejectReason::kTouchTestMissing));
  // in remote mode with power a touch is no test
  bench.wires.hand = true;
  bench.seconds(0.1);
  bench.wires.hand = false;
  bench.seconds(0.1);
  EXPECT_FALSE(bench.state().flags & kTouchTested);
  bench.touch_by_hand();
  EXPECT_TRUE(bench.state().flags & kTouchTested);
  EXPECT_EQ(begin(bench).state, PermitState::kAwaited);
}

TEST(ApplicationPermit, WithPowerOffATouchIsATest) {
  Bench bench;
  bench.greet();
  bench.cabinet.powered = false;
  bench.seconds(0.1);
  bench.wires.hand = true;
  bench.seconds(0.1);
  bench.wires.hand = false;
  bench.seconds(0.1);
  EXPECT_TRUE(bench.state().flags & kTouchTested);
}

TEST(ApplicationPermit, OneWireAloneIsNoTouchTest) {
  for (const bool contact_wire : {true, false}) {
    Bench bench;
    bench.greet();
    (contact_wire ? bench.wires.contact : bench.wires.loop) = !contact_wire;
    bench.touch_by_hand();
    bench.wires = {};
    bench.seconds(0.1);
    EXPECT_FALSE(bench.state().flags & kTouchTested) << contact_wire;
  }
}

TEST(ApplicationPermit, OpeningTheCellAsksForANewTouchTest) {
  Bench bench;
  bench.touch_by_hand();
  bench.greet();
  EXPECT_TRUE(bench.state().flags & kTouchTested);
  bench.cell_closed = false;
  bench.seconds(0.1);
  bench.cell_closed = true;
  EXPECT_FALSE(bench.state().flags & kTouchTested);
  EXPECT_EQ(begin(bench).detail, static_cast<std::int32_t>(RejectReason::kTouchTestMissing));
}

TEST(ApplicationPermit, AKeyThatHangsConfirmsNothing) {
  Bench bench;
  bench.touch_by_hand();
  bench.greet();
  bench.confirm_key = true;
  bench.seconds(0.1);
  EXPECT_EQ(begin(bench).state, PermitState::kAwaited);
  bench.seconds(1);
  EXPECT_EQ(bench.state().permit, PermitState::kAwaited);
  bench.confirm_key = false;
  bench.seconds(0.1);
  EXPECT_EQ(bench.state().permit, PermitState::kAwaited);
  bench.confirm();
  EXPECT_EQ(bench.expect<Permit>(0).state, PermitState::kGranted);
}

TEST(ApplicationPermit, NobodyConfirmsInTime) {
  Bench bench;
  bench.touch_by_hand();
  bench.greet();
  EXPECT_EQ(begin(bench).state, PermitState::kAwaited);
  bench.expect_silence(4.9);
  const Permit over = bench.expect<Permit>(0, 0.3);
  EXPECT_EQ(over.state, PermitState::kNone);
  EXPECT_EQ(over.reason, PermitReason::kNotConfirmed);
  bench.confirm();
  EXPECT_EQ(bench.state().permit, PermitState::kNone);
}

TEST(ApplicationPermit, IsGivenBackByFinish) {
  Bench bench;
  bench.make_ready();
  bench.send(0, Finish{});
  const Permit permit = bench.expect<Permit>(0);
  EXPECT_EQ(permit.state, PermitState::kNone);
  EXPECT_EQ(permit.reason, PermitReason::kFinished);
  bench.send(0, Finish{});
  bench.expect_silence(0.2);
  bench.send(1, bench.travel_to(-30));
  EXPECT_EQ(bench.expect<Rejected>(1).reason, RejectReason::kNotPermitted);
}

TEST(ApplicationPermit, IsLostWithPermissionCellAndProbe) {
  const std::vector<std::pair<PermitReason, std::function<void(Bench&)>>> losses{
      {PermitReason::kPermissionLost, [](Bench& b) { b.cabinet.mode = 1; }},
      {PermitReason::kPermissionLost, [](Bench& b) { b.cabinet.powered = false; }},
      {PermitReason::kPermissionLost, [](Bench& b) { b.cabinet.held = true; }},
      {PermitReason::kPermissionLost, [](Bench& b) { b.cabinet.es_status = 2; }},
      {PermitReason::kPermissionLost, [](Bench& b) { b.cell_closed = false; }},
      {PermitReason::kProbeFault, [](Bench& b) { b.wires.loop = false; }},
  };
  for (const auto& [reason, lose] : losses) {
    for (const bool confirmed : {false, true}) {
      Bench bench;
      bench.touch_by_hand();
      bench.greet();
      EXPECT_EQ(begin(bench).state, PermitState::kAwaited);
      if (confirmed) {
        bench.confirm();
        EXPECT_EQ(bench.expect<Permit>(0).state, PermitState::kGranted);
      }
      lose(bench);
      const Permit permit = bench.expect<Permit>(0, 0.2);
      EXPECT_EQ(permit.state, PermitState::kNone);
      EXPECT_EQ(permit.reason, reason);
    }
  }
}

TEST(ApplicationPermit, EndsWithTheConnection) {
  Bench bench;
  bench.make_ready();
  bench.disconnect();
  bench.seconds(0.1);
  bench.greet();
  EXPECT_EQ(bench.state().permit, PermitState::kNone);
  bench.send(1, bench.travel_to(-30));
  EXPECT_EQ(bench.expect<Rejected>(1).reason, RejectReason::kNotPermitted);
}

// ---- commands that are refused ----

struct Refused {
  const char* what;
  RejectReason reason;
  std::int32_t detail;
  std::function<void(Bench&)> world;
  std::function<Payload(Bench&)> command;
};

Payload plain_touch(Bench& b) { return b.touch(); }
void as_it_is(Bench&) {}

template <class Change>
std::function<Payload(Bench&)> touch_with(Change change) {
  return [change](Bench& b) -> Payload {
    Touch touch = b.touch();
    change(touch);
    return touch;
  };
}

std::vector<Refused> refusals() {
  using R = RejectReason;
  return {
      {"emergency stop", R::kEmergencyStop, 0, [](Bench& b) { b.cabinet.es_status = 2; }, plain_touch},
      {"manual", R::kNotRemote, 0, [](Bench& b) { b.cabinet.mode = 1; }, plain_touch},
      {"no power", R::kNotPowered, 0, [](Bench& b) { b.cabinet.powered = false; }, plain_touch},
      {"hold", R::kHold, 0, [](Bench& b) { b.cabinet.held = true; }, plain_touch},
      {"not referenced", R::kNotCalibrated, 0, [](Bench& b) { b.cabinet.calibrated = false; }, plain_touch},
      {"monitor speed", R::kMonitorSpeed, 40, [](Bench& b) { b.cabinet.monitor_speed_percent = 40; },
       plain_touch},
      {"open cell", R::kCellOpen, 0, [](Bench& b) { b.cell_closed = false; }, plain_touch},
      {"retract", R::kNothingToRetract, 0, as_it_is,
       [](Bench&) {
         return Retract{20000, 30000};
       }},
      {"no travel speed", R::kBadField, 50, as_it_is, touch_with([](Touch& t) { t.travel_speed_um_s = 0; })},
      {"approach too fast", R::kBadField, 51, as_it_is,
       touch_with([](Touch& t) { t.approach_speed_um_s = 20001; })},
      {"no search speed", R::kBadField, 52, as_it_is, touch_with([](Touch& t) { t.search_speed_um_s = 0; })},
      {"second faster than first", R::kBadField, 53, as_it_is, touch_with([](Touch& t) {
         t.second_speed_um_s = t.search_speed_um_s + 1;
         t.second_backoff_dmm = 20000;
       })},
      {"backoff", R::kBadField, 54, as_it_is, touch_with([](Touch& t) {
         t.second_speed_um_s = 2000;
         t.second_backoff_dmm = 4999;
       })},
      {"no deadline", R::kBadField, 55, as_it_is, touch_with([](Touch& t) { t.deadline_ms = 0; })},
      {"joint 2", R::kOutOfRange, 2, as_it_is, touch_with([](Touch& t) { t.clear[1] = 147500001 + 1000; })},
      {"joint 6 of a via", R::kOutOfRange, 6, as_it_is, touch_with([](Touch& t) {
         t.via_count = 1;
         t.via[0] = t.clear;
         t.via[0][5] = -280000000;
       })},
      {"long search", R::kSearchTooLong, 400000, as_it_is,
       [](Bench& b) -> Payload {
         Touch touch = b.touch();
         touch.search_end = b.at_depth(40.1);
         return touch;
       }},
      {"fast search", R::kSearchTooFast, 20000, as_it_is,
       touch_with([](Touch& t) { t.search_speed_um_s = 20001; })},
      {"probe wire", R::kNotPermitted, 0, [](Bench& b) { b.wires.loop = false; }, plain_touch},
      {"touched", R::kProbeTriggered, 0, [](Bench& b) { b.wires.hand = true; }, plain_touch},
  };
}

TEST(ApplicationPermit, CommandsAreRefusedWithReasonAndDetailAndNothingMoves) {
  for (const Refused& refused : refusals()) {
    SCOPED_TRACE(refused.what);
    Bench bench;
    bench.make_ready();
    refused.world(bench);
    bench.seconds(0.1);
    while (bench.next(0.01)) {  // what the permit has to say about it
    }
    const Joint before = bench.cabinet.joints_deg;
    bench.send(1, refused.command(bench));
    const Rejected rejected = bench.expect<Rejected>(1);
    EXPECT_EQ(rejected.reason, refused.reason);
    EXPECT_EQ(rejected.detail, refused.detail);
    bench.seconds(0.5);
    EXPECT_EQ(bench.cabinet.joints_deg, before);
    EXPECT_EQ(bench.greet_again().last_sequence, 0u) << "a refused command leaves no trace";
  }
}

}  // namespace
}  // namespace val3
