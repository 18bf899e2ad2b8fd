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

class Controller : public testing::DemoTouch {};

TEST_F(Controller, AnswersNothingBeforeHelloButAFault) {
  Bench bench(plant());
  bench.happen(ConnectionOpened{});
  const auto replies = bench.send(1, cs8::Stop{});
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(std::get<cs8::Fault>(replies.front().payload).code, cs8::FaultCode::kNoHandshake);
  EXPECT_TRUE(bench.last.close);
  Bench other(plant());
  other.happen(ConnectionOpened{});
  EXPECT_EQ(std::get<cs8::Fault>(other.send(1, cs8::Accepted{}).front().payload).code,
            cs8::FaultCode::kNoHandshake)
      << "whoever may send it";
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
  EXPECT_EQ(
      Bench(plant(), {.heartbeat_timeout_max = milliseconds(10'000)}).connect(100'000).heartbeat_timeout_ms,
      10'000u);
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

TEST_F(Controller, HasPowerSomeSimulatedSecondsAfterTheStart) {
  Bench bench(plant(), {.speed = 2.0});
  bench.connect();
  const auto refusal = [&bench] {
    const auto permit = std::get<cs8::Permit>(bench.send(0, cs8::Begin{1, 30'000}).front().payload);
    EXPECT_EQ(permit.reason, cs8::PermitReason::kRefused);
    return static_cast<RejectReason>(permit.detail);
  };
  const milliseconds power_up(static_cast<int>(kPowerUpSeconds * 1000 / 2));
  bench.pass(power_up - milliseconds(20));
  EXPECT_EQ(refusal(), RejectReason::kNotPowered);
  bench.pass(milliseconds(40));
  EXPECT_EQ(refusal(), RejectReason::kTouchTestMissing);
}

TEST_F(Controller, AtSpeedMaxHasTheResultWithTheNextTick) {
  Bench bench = Bench::ready(plant(), {.speed = kSpeedMax});
  bench.answer<cs8::Accepted>(1, touch());
  bench.happen(Tick{});
  ASSERT_EQ(bench.last.messages.size(), 1u);
  EXPECT_EQ(std::get<cs8::TouchResult>(bench.last.messages[0].payload).outcome, Outcome::kContact);
}

TEST_F(Controller, ATouchTakesItsSimulatedTimeDividedBySpeed) {
  const auto wall_s = [](double speed) {
    Bench bench = Bench::ready(plant(), {.speed = speed});
    const TimePoint start = bench.now;
    bench.answer<cs8::Accepted>(1, touch());
    bench.result<cs8::TouchResult>();
    return std::chrono::duration<double>(bench.now - start).count();
  };
  const double simulated_s = wall_s(1.0);
  EXPECT_GT(simulated_s, 2.0);
  EXPECT_NEAR(wall_s(10.0), simulated_s / 10.0, 0.021);
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
  EXPECT_EQ(result.first_source, cs8::CaptureSource::kNone);
  EXPECT_EQ(result.edges, 1u);
  EXPECT_LE(result.overtravel_dmm, cs8::dmm_from_metres(stopping_distance_m(0.008, kStopLatencySeconds)));
  EXPECT_GT(result.overtravel_dmm, cs8::dmm_from_metres(0.008 * kTickSeconds));
  EXPECT_EQ(
      std::count_if(bench.sent.begin(), bench.sent.end(),
                    [](const cs8::Message& m) { return cs8::type_of(m) == cs8::MessageType::kTouchResult; }),
      1);
}

TEST_F(Controller, FiveHundredTouchesHaveTheDeclaredNoise) {
  constexpr int kTouches = 500;
  Bench bench = Bench::ready(plant(), {.seed = 7, .speed = kSpeedMax});
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
    Bench bench = Bench::ready(plant(), {.seed = seed, .speed = kSpeedMax});
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
  const calib::JointVector standing = bench.joints();
  bench.answer<cs8::Accepted>(1, touch());
  EXPECT_EQ(bench.phase(), Phase::kSearch);
  EXPECT_EQ(bench.joints(), standing);
  const auto result = bench.result<cs8::TouchResult>();
  const auto again = bench.answer<cs8::TouchResult>(1, touch());
  EXPECT_EQ(again.contact, result.contact);
  EXPECT_FALSE(bench.state.motion.running);
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

TEST_F(Controller, ASecondHelloEndsThePermitAndWhatMoves) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(3, motion(), Phase::kSearch);
  const auto replies = bench.send(0, cs8::Hello{700});
  EXPECT_EQ(std::get<cs8::Welcome>(replies.front().payload).open_sequence, 3u);
  EXPECT_EQ(bench.state.permit.permit.state, cs8::PermitState::kNone);
  bench.pass(milliseconds(1000));
  const auto result = std::get<cs8::TouchResult>(bench.state.stored_result.value().payload);
  EXPECT_EQ(result.outcome, Outcome::kHeartbeatLost);
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
