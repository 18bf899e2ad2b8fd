#include "sim_controller/controller.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bench.hpp"
#include "sim_controller/contact.hpp"

namespace sim {
namespace {

using cs8::Outcome;
using cs8::Phase;
using cs8::RejectReason;
using testing::aimed_touch;
using testing::Bench;
using testing::kRetract;
using testing::milliseconds;
using testing::tip_m;
using testing::touch_command;
using testing::travel_command;

class Controller : public ::testing::Test {
 protected:
  static const cell::Cell& demo() {
    static const cell::Cell cell = testing::read_cell("demo");
    return cell;
  }
  static const Plant& plant() {
    static const Plant plant = testing::true_plant("demo");
    return plant;
  }
  static const testing::AimedTouch& aimed() {
    static const testing::AimedTouch touch = aimed_touch(demo(), {});
    return touch;
  }
  static const TouchMotion& motion() { return aimed().motion; }
  static cs8::Touch touch() { return touch_command(motion()); }
  static calib::JointVector beside_park() { return plant().start_joints + calib::JointVector::Constant(0.1); }
};

TEST_F(Controller, AnswersNothingBeforeHelloButAFault) {
  Bench bench(plant());
  bench.happen(ConnectionOpened{});
  const auto replies = bench.send(1, cs8::Stop{});
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(std::get<cs8::Fault>(replies.front().payload).code, cs8::FaultCode::kNoHandshake);
  EXPECT_TRUE(bench.last.close);
}

TEST_F(Controller, ClosesOnAMessageThatOnlyItSends) {
  Bench bench = Bench::ready(plant());
  const auto replies = bench.send(1, cs8::Accepted{});
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(std::get<cs8::Fault>(replies.front().payload).code, cs8::FaultCode::kWrongSide);
  EXPECT_TRUE(bench.last.close);
}

TEST_F(Controller, WelcomeTellsLimitsAndBringsTheTimeoutIntoItsRange) {
  Bench bench(plant());
  const cs8::Welcome welcome = bench.connect(1);
  EXPECT_EQ(cs8::text_of(welcome.application), "touchcal");
  EXPECT_EQ(cs8::text_of(welcome.arm), "tx90");
  EXPECT_EQ(welcome.heartbeat_timeout_ms, 200u);
  EXPECT_EQ(welcome.lower_limits, wire_from_joints(plant().joint_ranges.lower));
  EXPECT_EQ(welcome.upper_limits, wire_from_joints(plant().joint_ranges.upper));
  EXPECT_EQ(welcome.open_sequence, 0u);
  EXPECT_EQ(bench.connect(100'000).heartbeat_timeout_ms, 2000u);
}

TEST_F(Controller, SendsItsStateEveryTwentyMilliseconds) {
  Bench bench = Bench::ready(plant());
  bench.sent.clear();
  for (int i = 0; i < 100; ++i) bench.tick(milliseconds(4));
  EXPECT_EQ(bench.sent.size(), 20u);
  EXPECT_EQ(bench.last_state()->joints, wire_from_joints(plant().start_joints));
  EXPECT_TRUE(bench.flag(cs8::kPowered));
  EXPECT_TRUE(bench.flag(cs8::kSettled));
  EXPECT_FALSE(bench.flag(cs8::kProbeTouched));
  EXPECT_EQ(bench.last_state()->mode, cs8::WorkingMode::kRemote);
}

TEST_F(Controller, HasPowerAFifthOfASimulatedSecondAfterTheStart) {
  Bench bench(plant(), {.speed = 2.0});
  bench.connect();
  bench.tick(milliseconds(99));
  EXPECT_EQ(bench.rejection(1, touch()), RejectReason::kNotPowered);
  bench.tick(milliseconds(1));
  bench.answer<cs8::Accepted>(1, touch());
}

TEST_F(Controller, AtSpeedMaxHasPowerAtOnceAndTheResultWithTheNextTick) {
  Bench bench(plant(), {.speed = kSpeedMax});
  bench.connect();
  bench.answer<cs8::Accepted>(1, touch());
  bench.happen(Tick{});
  ASSERT_EQ(bench.last.messages.size(), 1u);
  EXPECT_EQ(std::get<cs8::TouchResult>(bench.last.messages[0].payload).outcome, Outcome::kContact);
}

TEST_F(Controller, ATouchTakesTheTimeOfItsMovesDividedBySpeed) {
  for (const double speed : {1.0, 10.0}) {
    Bench bench = Bench::ready(plant(), {.speed = speed});
    const TimePoint start = bench.now;
    bench.answer<cs8::Accepted>(1, touch());
    const double expected_s = bench.state.running->timeline.duration_s() / speed;
    bench.result<cs8::TouchResult>();
    EXPECT_NEAR(std::chrono::duration<double>(bench.now - start).count(), expected_s, 0.021);
  }
}

TEST_F(Controller, ATouchAnswersOnceWithEverything) {
  Bench bench = Bench::ready(plant());
  bench.answer<cs8::Accepted>(1, touch());
  const auto result = bench.result<cs8::TouchResult>();
  EXPECT_EQ(result.outcome, Outcome::kContact);
  EXPECT_EQ(result.phase, Phase::kIdle);
  EXPECT_EQ(result.source, cs8::CaptureSource::kLatched);
  EXPECT_EQ(result.search_speed_um_s, 8000);
  EXPECT_EQ(result.monitor_speed_percent, 100);
  EXPECT_EQ(result.overtravel_dmm, cs8::dmm_from_metres(stopping_distance_m(0.008, kStopLatencySeconds)));
  EXPECT_EQ(
      std::count_if(bench.sent.begin(), bench.sent.end(),
                    [](const cs8::Message& m) { return cs8::type_of(m) == cs8::MessageType::kTouchResult; }),
      1);
}

TEST_F(Controller, FiveHundredTouchesHaveTheDeclaredNoise) {
  constexpr int kTouches = 500;
  Bench bench(plant(), {.seed = 7, .speed = kSpeedMax});
  bench.connect();
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (std::uint32_t sequence = 1; sequence <= kTouches; ++sequence) {
    bench.answer<cs8::Accepted>(sequence, touch());
    const auto result = bench.result<cs8::TouchResult>();
    bench.send(0, cs8::ResultAcknowledge{sequence});
    const double off_m = calib::signed_distance_m(aimed().contact_plane,
                                                  tip_m(plant().truth, joints_from_wire(result.contact)));
    sum += off_m;
    sum_of_squares += off_m * off_m;
  }
  const double sigma_m = plant().touch_noise_m;
  EXPECT_NEAR(std::sqrt(sum_of_squares / kTouches), sigma_m, 0.1 * sigma_m) << "seed 7";
  EXPECT_NEAR(sum / kTouches, 0.0, 3.0 * sigma_m / std::sqrt(kTouches)) << "seed 7";
}

TEST_F(Controller, SameSeedSameBytesAndAnotherSeedOtherOnes) {
  const auto bytes = [](std::uint64_t seed) {
    Bench bench(plant(), {.seed = seed, .speed = kSpeedMax});
    bench.connect();
    for (std::uint32_t sequence = 1; sequence <= 5; ++sequence) {
      bench.answer<cs8::Accepted>(sequence, touch());
      bench.tick(milliseconds(20));
      bench.send(0, cs8::ResultAcknowledge{sequence});
    }
    std::vector<std::uint8_t> stream;
    for (const cs8::Message& message : bench.sent) cs8::encode(message, stream);
    return stream;
  };
  EXPECT_EQ(bytes(3), bytes(3));
  EXPECT_NE(bytes(3), bytes(4));
}

TEST(Gaussian, HasTheFirstValuesThatTheGeneratorsStandardGives) {
  // From the standard's tenth-thousandth value the generator is the same everywhere; this holds the mapping.
  std::mt19937_64 chance(5489);
  const auto uniform = [copy = chance]() mutable {
    return (static_cast<double>(copy() >> 11) + 0.5) * 0x1p-53;
  };
  auto twice = uniform;
  const double first = twice();
  const double second = twice();
  EXPECT_DOUBLE_EQ(gaussian(chance),
                   std::sqrt(-2.0 * std::log(first)) * std::cos(2.0 * std::numbers::pi * second));
}

// ---- what is refused ----

TEST_F(Controller, RefusesAPostureOutOfRangeAndNamesTheJoint) {
  Bench bench = Bench::ready(plant());
  for (std::size_t joint = 0; joint < 6; ++joint) {
    cs8::Travel travel = travel_command(plant().start_joints);
    travel.target[joint] = wire_from_joints(plant().joint_ranges.upper)[joint] + 1;
    const auto rejected = bench.answer<cs8::Rejected>(1, travel);
    EXPECT_EQ(rejected.reason, RejectReason::kOutOfRange);
    EXPECT_EQ(rejected.detail, static_cast<std::int32_t>(joint) + 1);
  }
  for (auto posture : {&cs8::Touch::clear, &cs8::Touch::approach, &cs8::Touch::search_end}) {
    cs8::Touch bad = touch();
    (bad.*posture)[2] = -180'000'000;
    EXPECT_EQ(bench.rejection(1, bad), RejectReason::kOutOfRange);
  }
  cs8::Touch bad_via = touch();
  bad_via.via_count = 1;
  bad_via.via[0][4] = 180'000'000;
  EXPECT_EQ(bench.rejection(1, bad_via), RejectReason::kOutOfRange);
  bad_via.via_count = 0;
  bench.answer<cs8::Accepted>(1, bad_via);
}

TEST_F(Controller, TakesAPostureExactlyOnItsLimit) {
  Plant free = plant();
  free.scene = {};
  Bench bench = Bench::ready(free);
  cs8::Travel travel = travel_command(plant().start_joints);
  travel.target = wire_from_joints(plant().joint_ranges.upper);
  bench.answer<cs8::Accepted>(1, travel);
}

TEST_F(Controller, RefusesASearchThatIsTooLong) {
  Bench bench = Bench::ready(plant());
  const auto longer =
      aimed_touch(demo(), {.standoff_m = 0.0385, .end_depth_m = kSearchLengthMaxMetres - 0.0384});
  const auto rejected = bench.answer<cs8::Rejected>(1, touch_command(longer.motion));
  EXPECT_EQ(rejected.reason, RejectReason::kSearchTooLong);
  EXPECT_EQ(rejected.detail, cs8::dmm_from_metres(kSearchLengthMaxMetres));
}

TEST_F(Controller, RefusesASearchThatCouldNotStopWithinHalfTheOvertravel) {
  Bench bench = Bench::ready(plant());
  cs8::Touch fast = touch();
  fast.search_speed_um_s = search_speed_max_um_s(plant()) + 1;
  const auto rejected = bench.answer<cs8::Rejected>(1, fast);
  EXPECT_EQ(rejected.reason, RejectReason::kSearchTooFast);
  EXPECT_EQ(rejected.detail, search_speed_max_um_s(plant()));
  fast.search_speed_um_s = rejected.detail;
  bench.answer<cs8::Accepted>(1, fast);
}

TEST_F(Controller, RefusesFieldsThatMakeNoSenseAndNamesTheWord) {
  Bench bench = Bench::ready(plant());
  const auto word = [&bench](const cs8::Payload& payload) {
    const auto rejected = bench.answer<cs8::Rejected>(1, payload);
    EXPECT_EQ(rejected.reason, RejectReason::kBadField);
    return rejected.detail;
  };
  const auto changed = [](auto command, auto field, auto value) {
    command.*field = value;
    return command;
  };
  // A payload of 53 words: via_count, 5 x 6, 3 x 6, three speeds, the deadline.
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::via_count, 6)), 1);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::via_count, -1)), 1);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::search_end, touch().approach)), 44);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::travel_speed_um_s, 0)), 50);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::approach_speed_um_s, -1)), 51);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::search_speed_um_s, 0)), 52);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::deadline_ms, 0u)), 53);
  const cs8::Travel travel = travel_command(beside_park());
  EXPECT_EQ(word(changed(travel, &cs8::Travel::travel_speed_um_s, 0)), 38);
  EXPECT_EQ(word(changed(travel, &cs8::Travel::deadline_ms, 0u)), 39);
  EXPECT_EQ(cs8::payload_size(cs8::MessageType::kTouch), 53u * 4u);
  EXPECT_EQ(cs8::payload_size(cs8::MessageType::kTravel), 39u * 4u);
}

TEST_F(Controller, RefusesWhatTheCabinetDoesNotPermit) {
  Bench bench = Bench::ready(plant());
  const auto rejection_with = [&bench](auto change) {
    const Panel before = bench.state.panel;
    change(bench.state.panel);
    const auto reason = bench.rejection(1, touch());
    bench.state.panel = before;
    return reason;
  };
  EXPECT_EQ(rejection_with([](Panel& p) { p.mode = cs8::WorkingMode::kManual; }), RejectReason::kNotRemote);
  EXPECT_EQ(rejection_with([](Panel& p) { p.powered = false; }), RejectReason::kNotPowered);
  EXPECT_EQ(rejection_with([](Panel& p) { p.held = true; }), RejectReason::kHold);
  EXPECT_EQ(rejection_with([](Panel& p) { p.emergency_stop = 2; }), RejectReason::kEmergencyStop);
  EXPECT_EQ(rejection_with([](Panel& p) { p.arm_calibrated = false; }), RejectReason::kNotCalibrated);
  EXPECT_EQ(rejection_with([](Panel& p) { p.monitor_speed_percent = 50; }), RejectReason::kMonitorSpeed);
  bench.answer<cs8::Accepted>(1, touch());
}

TEST_F(Controller, RefusesToMoveWithATouchedProbe) {
  Plant touched = plant();
  const Timeline timeline = touch_timeline(plant(), motion().waypoints.back(), motion(), 0.0);
  touched.start_joints = timeline.capture->stopped;
  Bench bench = Bench::ready(touched);
  EXPECT_EQ(bench.rejection(1, touch()), RejectReason::kProbeTriggered);
  EXPECT_TRUE(bench.flag(cs8::kProbeTouched));
}

TEST_F(Controller, RefusesARetractWithNothingToRetractFrom) {
  Bench bench = Bench::ready(plant());
  EXPECT_EQ(bench.rejection(1, kRetract), RejectReason::kNothingToRetract);
}

// ---- sequences and results ----

TEST_F(Controller, OneMotionCommandAtATime) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  EXPECT_EQ(bench.rejection(2, touch()), RejectReason::kBusy);
  EXPECT_EQ(bench.rejection(2, travel_command(beside_park())), RejectReason::kBusy);
  EXPECT_EQ(bench.rejection(2, kRetract), RejectReason::kBusy);
}

TEST_F(Controller, ARepeatedCommandIsAnsweredAgainAndDoesNotMoveAgain) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  const TimePoint started = bench.state.running->started;
  bench.answer<cs8::Accepted>(1, touch());
  EXPECT_EQ(bench.state.running->started, started);
  const auto result = bench.result<cs8::TouchResult>();
  const auto again = bench.answer<cs8::TouchResult>(1, touch());
  EXPECT_EQ(again.contact, result.contact);
  EXPECT_FALSE(bench.state.running);
}

TEST_F(Controller, AnUnacknowledgedResultHoldsTheNextCommandBack) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kIdle);
  EXPECT_EQ(bench.rejection(2, touch()), RejectReason::kResultUnacknowledged);
  bench.send(0, cs8::ResultAcknowledge{7});
  EXPECT_EQ(bench.rejection(2, touch()), RejectReason::kResultUnacknowledged);
  bench.send(0, cs8::ResultAcknowledge{1});
  bench.answer<cs8::Accepted>(2, touch());
}

TEST_F(Controller, AnOldSequenceIsStale) {
  Bench bench = Bench::ready(plant());
  EXPECT_EQ(bench.rejection(0, touch()), RejectReason::kStaleSequence);
  bench.touch_until(5, motion(), Phase::kIdle);
  EXPECT_EQ(bench.rejection(4, touch()), RejectReason::kStaleSequence);
  bench.send(0, cs8::ResultAcknowledge{5});
  EXPECT_EQ(bench.rejection(5, touch()), RejectReason::kStaleSequence);
  bench.answer<cs8::Accepted>(6, touch());
}

TEST_F(Controller, ARefusedSequenceMayBeUsedAgain) {
  Bench bench = Bench::ready(plant());
  EXPECT_EQ(bench.rejection(1, kRetract), RejectReason::kNothingToRetract);
  bench.answer<cs8::Accepted>(1, touch());
}

TEST_F(Controller, AQueryTellsWhatBecameOfACommand) {
  Bench bench = Bench::ready(plant());
  const auto query = [&bench](std::uint32_t sequence) {
    return cs8::type_of(bench.send(0, cs8::ResultQuery{sequence}).back());
  };
  EXPECT_EQ(query(0), cs8::MessageType::kResultUnknown);
  EXPECT_EQ(query(1), cs8::MessageType::kResultUnknown);
  bench.touch_until(1, motion(), Phase::kSearch);
  EXPECT_EQ(query(1), cs8::MessageType::kAccepted);
  bench.result<cs8::TouchResult>();
  EXPECT_EQ(query(1), cs8::MessageType::kTouchResult);
  bench.send(0, cs8::ResultAcknowledge{1});
  EXPECT_EQ(query(1), cs8::MessageType::kResultUnknown);
}

TEST_F(Controller, AResultWaitsForTheNextConnection) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(3, motion(), Phase::kIdle);
  const auto result = std::get<cs8::TouchResult>(bench.state.stored_result->payload);
  bench.happen(ConnectionClosed{});
  const cs8::Welcome welcome = bench.connect();
  EXPECT_EQ(welcome.last_sequence, 3u);
  EXPECT_EQ(welcome.open_sequence, 3u);
  const auto found = std::get<cs8::TouchResult>(bench.send(0, cs8::ResultQuery{3}).back().payload);
  EXPECT_EQ(found.contact, result.contact);
}

// ---- motion that is broken off ----

TEST_F(Controller, StopWithNothingRunningIsHarmless) {
  Bench bench = Bench::ready(plant());
  EXPECT_TRUE(bench.send(0, cs8::Stop{}).empty());
}

TEST_F(Controller, StopInEachPhaseEndsTheTouchWhereTheProtocolSays) {
  for (const Phase phase : {Phase::kTravel, Phase::kApproach, Phase::kSearch, Phase::kRetract}) {
    Bench bench = Bench::ready(plant());
    bench.touch_until(1, motion(), phase);
    const calib::JointVector at_stop = bench.place().joints;
    bench.send(0, cs8::Stop{});
    const auto result = bench.result<cs8::TouchResult>();
    EXPECT_EQ(result.outcome, Outcome::kStopped);
    EXPECT_EQ(result.phase, phase);
    const calib::JointVector expected = phase == Phase::kSearch ? motion().approach : at_stop;
    EXPECT_LT((bench.state.joints - expected).norm(), 1e-7) << cs8::name(phase);
    // The probe tripped before a retract: what it found is not lost.
    EXPECT_EQ(result.source,
              phase == Phase::kRetract ? cs8::CaptureSource::kLatched : cs8::CaptureSource::kNone);
  }
}

TEST_F(Controller, WhatIsLeftNearAFaceTakesNothingButARetractToTheClearPosture) {
  for (const Phase phase : {Phase::kApproach, Phase::kSearch, Phase::kRetract}) {
    for (const bool by_stop : {true, false}) {
      Bench bench = Bench::ready(plant());
      bench.touch_until(1, motion(), phase);
      if (by_stop) {
        bench.send(0, cs8::Stop{});
        bench.result<cs8::TouchResult>();
      } else {
        bench.happen(ConnectionClosed{});
        bench.connect();
      }
      bench.send(0, cs8::ResultAcknowledge{1});
      bench.pass(milliseconds(20));
      EXPECT_TRUE(bench.flag(cs8::kRetractDue));
      EXPECT_EQ(bench.rejection(2, touch()), RejectReason::kRetractPending);
      EXPECT_EQ(bench.rejection(2, travel_command(beside_park())), RejectReason::kRetractPending);
      bench.answer<cs8::Accepted>(2, kRetract);
      const auto result = bench.result<cs8::MoveResult>();
      EXPECT_EQ(result.outcome, Outcome::kArrived);
      EXPECT_EQ(result.joints, touch().clear);
      bench.pass(milliseconds(20));
      EXPECT_FALSE(bench.flag(cs8::kRetractDue));
      bench.send(0, cs8::ResultAcknowledge{2});
      bench.answer<cs8::Accepted>(3, touch());
    }
  }
}

TEST_F(Controller, AHostThatFallsSilentStopsTheArmInEachPhaseAfterItsTimeout) {
  for (const Phase phase : {Phase::kTravel, Phase::kApproach, Phase::kSearch, Phase::kRetract}) {
    Bench bench = Bench::ready(plant(), {.speed = 0.1});  // slow: no phase ends within the timeout
    bench.touch_until(1, motion(), phase);
    const TimePoint silent_from = bench.now;
    bench.tick(milliseconds(499));
    EXPECT_TRUE(bench.state.running);
    bench.tick(milliseconds(1));
    ASSERT_FALSE(bench.state.running);
    EXPECT_TRUE(bench.last.close);
    const auto result = std::get<cs8::TouchResult>(bench.state.stored_result->payload);
    EXPECT_EQ(result.outcome, Outcome::kHeartbeatLost);
    EXPECT_EQ(result.phase, phase);
    EXPECT_EQ(bench.now - silent_from, milliseconds(500));
    EXPECT_EQ(bench.state.way_out.empty(), phase == Phase::kTravel);
  }
}

TEST_F(Controller, StopsTheArmWhereItWasWhenTheTimeoutRanOutHoweverLateTheTickIs) {
  const auto stopped_after = [](milliseconds tick) {
    Bench bench = Bench::ready(plant(), {.speed = 0.1});
    bench.touch_until(1, motion(), Phase::kSearch);
    bench.tick(tick);
    return wire_from_joints(bench.state.joints);
  };
  EXPECT_EQ(stopped_after(milliseconds(500)), stopped_after(milliseconds(5000)));
}

TEST_F(Controller, BytesThatWaitToBeReadAreNotSilence) {
  Bench bench = Bench::ready(plant(), {.speed = 0.1});
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.now += milliseconds(2000);
  bench.happen(Tick{.bytes_waiting = true});
  EXPECT_TRUE(bench.state.running);
}

TEST_F(Controller, ALostSocketStopsTheArmAndTheResultIsFoundAfterReconnecting) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kTravel);
  bench.happen(ConnectionClosed{});
  EXPECT_FALSE(bench.state.running);
  EXPECT_EQ(bench.connect().open_sequence, 1u);
  const auto result = std::get<cs8::TouchResult>(bench.send(0, cs8::ResultQuery{1}).back().payload);
  EXPECT_EQ(result.outcome, Outcome::kHeartbeatLost);
  EXPECT_EQ(result.phase, Phase::kTravel);
}

TEST_F(Controller, ARetractThatIsBrokenOffCanBeAskedForAgain) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.happen(ConnectionClosed{});
  bench.connect();
  bench.send(0, cs8::ResultAcknowledge{1});
  bench.answer<cs8::Accepted>(2, kRetract);
  bench.pass(milliseconds(60));
  bench.send(0, cs8::Stop{});
  EXPECT_EQ(bench.result<cs8::MoveResult>().outcome, Outcome::kStopped);
  bench.send(0, cs8::ResultAcknowledge{2});
  bench.answer<cs8::Accepted>(3, kRetract);
  EXPECT_EQ(bench.result<cs8::MoveResult>().joints, touch().clear);
}

TEST_F(Controller, ADeadlineIsWallTimeAndStopsTheArm) {
  for (const double speed : {0.5, 1.0}) {
    Bench bench = Bench::ready(plant(), {.speed = speed});
    cs8::Travel travel = travel_command(motion().waypoints.back());
    travel.deadline_ms = 300;
    bench.answer<cs8::Accepted>(1, travel);
    bench.pass(milliseconds(280));
    EXPECT_TRUE(bench.state.running);
    bench.pass(milliseconds(20));
    EXPECT_EQ(bench.result<cs8::MoveResult>().outcome, Outcome::kDeadline);
  }
}

TEST_F(Controller, LosesPermissionWhileMoving) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.state.panel.held = true;
  bench.tick(milliseconds(4));
  EXPECT_EQ(bench.result<cs8::TouchResult>().outcome, Outcome::kPermissionLost);
}

TEST_F(Controller, AMissedFaceIsNoContact) {
  const auto beside =
      aimed_touch(demo(), {.u_m = demo().block.faces[2].half_extent_m.x() + 0.02, .tilt_rad = 0.0});
  Bench bench = Bench::ready(plant(), {.speed = 10.0});
  bench.answer<cs8::Accepted>(1, touch_command(beside.motion));
  const auto result = bench.result<cs8::TouchResult>();
  EXPECT_EQ(result.outcome, Outcome::kNoContact);
  EXPECT_EQ(result.source, cs8::CaptureSource::kNone);
  EXPECT_EQ(result.contact, cs8::JointsMicrodeg{});
}

TEST_F(Controller, AnEdgeInTheApproachIsLeftByARetract) {
  Bench bench = Bench::ready(plant());
  cs8::Touch low = touch();
  low.approach = touch().search_end;
  low.search_end = touch().approach;
  bench.answer<cs8::Accepted>(1, low);
  const auto met = bench.result<cs8::TouchResult>();
  EXPECT_EQ(met.outcome, Outcome::kUnexpectedContact);
  EXPECT_EQ(met.phase, Phase::kApproach);
  EXPECT_EQ(met.source, cs8::CaptureSource::kNone);
  bench.send(0, cs8::ResultAcknowledge{1});
  bench.pass(milliseconds(20));
  EXPECT_TRUE(bench.flag(cs8::kProbeTouched));
  EXPECT_TRUE(bench.flag(cs8::kRetractDue));
  bench.answer<cs8::Accepted>(2, kRetract);
  EXPECT_EQ(bench.result<cs8::MoveResult>().joints, touch().clear);
}

TEST_F(Controller, AnEdgeInATravelIsLeftByTheOperator) {
  Bench bench = Bench::ready(plant());
  bench.answer<cs8::Accepted>(1, travel_command(motion().search_end));
  const auto met = bench.result<cs8::MoveResult>();
  EXPECT_EQ(met.outcome, Outcome::kUnexpectedContact);
  EXPECT_EQ(met.phase, Phase::kTravel);
  bench.send(0, cs8::ResultAcknowledge{1});
  EXPECT_EQ(bench.rejection(2, kRetract), RejectReason::kNothingToRetract);
  EXPECT_EQ(bench.rejection(2, touch()), RejectReason::kProbeTriggered);
  bench.connect();
  bench.answer<cs8::Accepted>(2, touch());
}

TEST_F(Controller, ACollisionTakesPowerAwayUntilTheOperatorFreesTheArmForTheNextHost) {
  Plant narrow = plant();
  const Eigen::Vector3d holder =
      calib::forward_kinematics(narrow.truth, motion().waypoints.back()) * Eigen::Vector3d(0.0, 0.0, -0.15);
  narrow.scene.obstacles.push_back(
      {"shelf", holder - Eigen::Vector3d::Constant(0.01), holder + Eigen::Vector3d::Constant(0.01)});
  Bench bench = Bench::ready(narrow);
  bench.answer<cs8::Accepted>(1, touch());
  EXPECT_EQ(bench.result<cs8::TouchResult>().outcome, Outcome::kCollision);
  bench.send(0, cs8::ResultAcknowledge{1});
  bench.pass(milliseconds(1000));
  EXPECT_FALSE(bench.flag(cs8::kPowered));
  EXPECT_EQ(bench.rejection(2, travel_command(beside_park())), RejectReason::kNotPowered);
  bench.happen(ConnectionClosed{});
  bench.connect();
  bench.pass(milliseconds(200));
  EXPECT_TRUE(bench.flag(cs8::kPowered));
  EXPECT_EQ(bench.last_state()->joints, wire_from_joints(plant().start_joints));
  bench.answer<cs8::Accepted>(2, travel_command(beside_park()));
}

TEST_F(Controller, AConnectionThatDoesNotSayHelloIsClosed) {
  Bench bench(plant());
  bench.happen(ConnectionOpened{});
  bench.tick(kHelloTimeout - milliseconds(1));
  EXPECT_FALSE(bench.last.close);
  bench.tick(milliseconds(1));
  EXPECT_TRUE(bench.last.close);
}

}  // namespace
}  // namespace sim
