#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "bench.hpp"

/// PROTOCOL.md section 7: touch test, closed cell, confirmation, and how the permit goes.
namespace sim {
namespace {

using cs8::PermitReason;
using cs8::PermitState;
using cs8::Phase;
using cs8::RejectReason;
using testing::Bench;
using testing::kRetract;
using testing::milliseconds;
using testing::travel_command;

constexpr OperatorDuties kNobody{
    .powers_up = false, .touches_probe = false, .confirms = false, .frees_arm = false};

class Permit : public testing::DemoTouch {
 protected:
  /// A greeted controller in whose cell people do nothing but what the test does.
  static Bench alone() {
    Bench bench(plant(), {.duties = kNobody});
    bench.connect();
    return bench;
  }
  static void act(Bench& bench, Act what, milliseconds then = milliseconds(100)) {
    bench.pass(milliseconds(20));
    perform(bench.plant, bench.state.cabinet, what);
    bench.pass(then);
  }
  static void touch_by_hand(Bench& bench) {
    bench.pass(milliseconds(100));
    act(bench, Act::kTouchStylus);
    act(bench, Act::kReleaseStylus);
  }
  /// Touched by hand without power, then powered: ready for a Begin.
  static Bench prepared() {
    Bench bench = alone();
    touch_by_hand(bench);
    act(bench, Act::kPowerOn);
    return bench;
  }
  static cs8::Permit begin(Bench& bench, std::uint32_t within_ms = 30'000) {
    return std::get<cs8::Permit>(bench.send(0, cs8::Begin{7, within_ms}).front().payload);
  }
  static RejectReason refusal(Bench& bench) {
    const cs8::Permit told = begin(bench);
    EXPECT_EQ(told.state, PermitState::kNone);
    EXPECT_EQ(told.reason, PermitReason::kRefused);
    return static_cast<RejectReason>(told.detail);
  }
  static cs8::Permit last_told(const Bench& bench) {
    for (auto message = bench.sent.rbegin(); message != bench.sent.rend(); ++message) {
      if (const auto* told = std::get_if<cs8::Permit>(&message->payload)) return *told;
    }
    throw std::logic_error("no Permit was sent");
  }
};

TEST_F(Permit, NothingMovesBeforeARunIsConfirmedAtTheCell) {
  Bench bench = prepared();
  EXPECT_EQ(bench.rejection(1, touch()), RejectReason::kNotPermitted);
  EXPECT_EQ(begin(bench).state, PermitState::kAwaited);
  EXPECT_EQ(bench.rejection(1, touch()), RejectReason::kNotPermitted);
  act(bench, Act::kPressConfirm);
  EXPECT_EQ(last_told(bench).state, PermitState::kGranted);
  EXPECT_EQ(last_told(bench).run, 7u);
  EXPECT_EQ(bench.last_state()->permit, PermitState::kGranted);
  bench.answer<cs8::Accepted>(1, touch());
}

TEST_F(Permit, BeginIsRefusedWithWhatIsNotSo) {
  const std::map<RejectReason, std::function<void(Cabinet&)>> unmet{
      {RejectReason::kTaskFailed, [](Cabinet& c) { c.task_error = 20; }},
      {RejectReason::kEmergencyStop, [](Cabinet& c) { c.panel.emergency_stop = 1; }},
      {RejectReason::kNotRemote, [](Cabinet& c) { c.panel.mode = cs8::WorkingMode::kLocal; }},
      {RejectReason::kNotPowered, [](Cabinet& c) { c.panel.powered = false; }},
      {RejectReason::kHold, [](Cabinet& c) { c.panel.held = true; }},
      {RejectReason::kNotCalibrated, [](Cabinet& c) { c.panel.arm_calibrated = false; }},
      {RejectReason::kMonitorSpeed, [](Cabinet& c) { c.panel.monitor_speed_percent = 50; }},
      {RejectReason::kCellOpen, [](Cabinet& c) { c.panel.cell_closed = false; }},
      {RejectReason::kProbeInputs, [](Cabinet& c) { c.world.probe.troubles.loop_wire = WireTrouble::kCut; }},
      {RejectReason::kProbeTriggered,
       [](Cabinet& c) { c.world.probe.troubles.stylus = StylusTrouble::kStaysTouched; }},
      {RejectReason::kTouchTestMissing, [](Cabinet& c) { c.touch_test = TouchTest::kNone; }},
  };
  for (const auto& [reason, spoil] : unmet) {
    Bench bench = prepared();
    spoil(bench.state.cabinet);
    bench.pass(milliseconds(20));
    EXPECT_EQ(refusal(bench), reason) << cs8::name(reason);
  }
}

TEST_F(Permit, TheTouchTestCountsWithoutPowerOrInManualModeOnly) {
  for (const bool manual : {false, true}) {
    Bench bench = alone();
    act(bench, Act::kPowerOn);
    touch_by_hand(bench);
    EXPECT_FALSE(bench.flag(cs8::kTouchTested)) << "with power, in remote mode";
    act(bench, manual ? Act::kManualMode : Act::kPowerOff);
    touch_by_hand(bench);
    bench.pass(milliseconds(20));
    EXPECT_TRUE(bench.flag(cs8::kTouchTested));
  }
}

TEST_F(Permit, ATouchShorterThanTwentyMillisecondsIsNoTouchTest) {
  Bench bench = alone();
  bench.pass(milliseconds(100));
  perform(bench.plant, bench.state.cabinet, Act::kTouchStylus);
  bench.pass(milliseconds(12));
  perform(bench.plant, bench.state.cabinet, Act::kReleaseStylus);
  bench.pass(milliseconds(100));
  EXPECT_FALSE(bench.flag(cs8::kTouchTested));
}

TEST_F(Permit, WhoeverEntersTheCellMakesTheTouchTestAnew) {
  Bench bench = prepared();
  act(bench, Act::kOpenCell);
  EXPECT_FALSE(bench.flag(cs8::kTouchTested));
  act(bench, Act::kCloseCell);
  EXPECT_EQ(refusal(bench), RejectReason::kTouchTestMissing);
  act(bench, Act::kPowerOff);
  act(bench, Act::kOpenCell);
  touch_by_hand(bench);
  act(bench, Act::kCloseCell);
  act(bench, Act::kPowerOn);
  EXPECT_EQ(begin(bench).state, PermitState::kAwaited);
}

TEST_F(Permit, AKeyThatHangsConfirmsNothing) {
  Bench bench = prepared();
  act(bench, Act::kPressConfirm);
  EXPECT_EQ(begin(bench).state, PermitState::kAwaited);
  bench.pass(milliseconds(500));
  EXPECT_EQ(last_told(bench).state, PermitState::kAwaited);
  act(bench, Act::kReleaseConfirm);
  act(bench, Act::kPressConfirm);
  EXPECT_EQ(last_told(bench).state, PermitState::kGranted);
}

TEST_F(Permit, TheConfirmationIsWaitedForThirtySecondsAtMost) {
  for (const std::uint32_t asked_ms : {5'000u, 30'000u, 4'000'000'000u}) {
    Bench bench = prepared();
    begin(bench, asked_ms);
    const milliseconds within(std::min(asked_ms, kConfirmWithinMaxMs));
    bench.pass(within - milliseconds(20));
    EXPECT_EQ(last_told(bench).state, PermitState::kAwaited);
    bench.pass(milliseconds(20));
    EXPECT_EQ(last_told(bench).state, PermitState::kNone);
    EXPECT_EQ(last_told(bench).reason, PermitReason::kNotConfirmed);
    act(bench, Act::kPressConfirm);
    EXPECT_EQ(bench.rejection(1, touch()), RejectReason::kNotPermitted);
  }
}

TEST_F(Permit, GoesWithThePermissionAndDoesNotComeBackWithIt) {
  const std::vector<std::pair<Act, Act>> taken_and_given{{Act::kHold, Act::kMove},
                                                         {Act::kPowerOff, Act::kPowerOn},
                                                         {Act::kManualMode, Act::kRemoteMode},
                                                         {Act::kOpenCell, Act::kCloseCell},
                                                         {Act::kEmergencyStop, Act::kReleaseEmergencyStop}};
  for (const auto& [taken, given] : taken_and_given) {
    for (const bool awaited : {true, false}) {
      Bench bench = prepared();
      begin(bench);
      if (!awaited) act(bench, Act::kPressConfirm);
      act(bench, taken);
      EXPECT_EQ(last_told(bench).state, PermitState::kNone);
      EXPECT_EQ(last_told(bench).reason, PermitReason::kPermissionLost);
      act(bench, given);
      EXPECT_EQ(bench.last_state()->permit, PermitState::kNone);
    }
  }
}

TEST_F(Permit, GoesWithACutCableAndTheTouchTestWithIt) {
  Bench bench = Bench::ready(plant());
  bench.state.cabinet.world.probe.troubles.loop_wire = WireTrouble::kCut;
  bench.pass(milliseconds(60));
  EXPECT_EQ(bench.rejection(1, touch()), RejectReason::kNotPermitted);
  EXPECT_EQ(last_told(bench).reason, PermitReason::kProbeFault);
  EXPECT_FALSE(bench.flag(cs8::kTouchTested));
}

TEST_F(Permit, GoesWithFinishAndWithTheConnection) {
  Bench finished = Bench::ready(plant());
  finished.send(0, cs8::Finish{});
  EXPECT_EQ(last_told(finished).reason, PermitReason::kFinished);
  EXPECT_EQ(finished.rejection(1, touch()), RejectReason::kNotPermitted);
  EXPECT_TRUE(finished.send(0, cs8::Finish{}).empty()) << "there is none any more";

  Bench left = Bench::ready(plant());
  left.happen(ConnectionClosed{});
  left.connect();
  EXPECT_EQ(left.rejection(1, touch()), RejectReason::kNotPermitted);
}

TEST_F(Permit, FinishStopsARunningCommandFirst) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kTravel);
  bench.send(0, cs8::Finish{});
  EXPECT_EQ(bench.result<cs8::TouchResult>().outcome, cs8::Outcome::kStopped);
  EXPECT_EQ(bench.rejection(2, touch()), RejectReason::kResultUnacknowledged);
}

TEST_F(Permit, BeginWhileACommandRunsIsRefusedAndEndsIt) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  EXPECT_EQ(refusal(bench), RejectReason::kBusy);
  EXPECT_EQ(bench.result<cs8::TouchResult>().outcome, cs8::Outcome::kStopped);
}

TEST_F(Permit, OfABrokenOffTouchIsForTheWayBackOnly) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.send(0, cs8::Stop{});
  bench.result<cs8::TouchResult>();
  EXPECT_EQ(last_told(bench).state, PermitState::kRetractOnly);
  EXPECT_EQ(last_told(bench).reason, PermitReason::kBrokenOff);
  bench.send(0, cs8::ResultAcknowledge{1});
  EXPECT_EQ(bench.rejection(2, travel_command(beside_park())), RejectReason::kNotPermitted);
  bench.answer<cs8::Accepted>(2, kRetract);
  EXPECT_EQ(bench.result<cs8::MoveResult>().outcome, cs8::Outcome::kArrived);
  EXPECT_EQ(last_told(bench).state, PermitState::kNone);
}

TEST_F(Permit, OfATravelThatIsStoppedIsGone) {
  Bench bench = Bench::ready(plant());
  bench.answer<cs8::Accepted>(1, travel_command(beside_park()));
  bench.pass(milliseconds(40));
  bench.send(0, cs8::Stop{});
  bench.result<cs8::MoveResult>();
  EXPECT_EQ(last_told(bench).state, PermitState::kNone);
}

TEST_F(Permit, TheRoundOfTheOperatorEndsInAConfirmedRun) {
  Bench bench = Bench::ready(plant());
  EXPECT_TRUE(bench.flag(cs8::kTouchTested));
  EXPECT_TRUE(bench.flag(cs8::kCellClosed));
  EXPECT_TRUE(bench.flag(cs8::kPowered));
  EXPECT_EQ(bench.last_state()->permit, PermitState::kGranted);
}

}  // namespace
}  // namespace sim
