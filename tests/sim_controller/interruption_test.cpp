#include <gtest/gtest.h>

#include "bench.hpp"
#include "sim_controller/controller.hpp"

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

/// The arm stands this long after whatever stops it, in simulated time.
constexpr milliseconds kStandstill(200);

class Interruption : public testing::DemoTouch {};

TEST_F(Interruption, StopWithNothingRunningIsHarmless) {
  Bench bench = Bench::ready(plant());
  EXPECT_TRUE(bench.send(0, cs8::Stop{}).empty());
}

TEST_F(Interruption, StopInEachPhaseEndsTheTouchWhereTheProtocolSays) {
  for (const Phase phase : {Phase::kTravel, Phase::kApproach, Phase::kSearch, Phase::kRetract}) {
    Bench bench = Bench::ready(plant());
    bench.touch_until(1, motion(), phase);
    const calib::JointVector at_stop = bench.joints();
    bench.send(0, cs8::Stop{});
    const auto result = bench.result<cs8::TouchResult>();
    EXPECT_EQ(result.outcome, Outcome::kStopped);
    EXPECT_EQ(result.phase, phase);
    if (phase == Phase::kSearch) {
      EXPECT_LT((bench.joints() - motion().approach).norm(), 1e-7);
    } else {  // nothing but the way to brake
      EXPECT_LT(tip_distance_m(plant(), bench.joints(), at_stop), 0.25 * (kTickSeconds + kResetSeconds))
          << cs8::name(phase);
    }
    // The probe tripped before a retract: what it found is not lost.
    EXPECT_EQ(result.source,
              phase == Phase::kRetract ? cs8::CaptureSource::kLatched : cs8::CaptureSource::kNone);
  }
}

TEST_F(Interruption, ASecondStopOnTheWayBackFromASearchLeavesTheArmWhereItStands) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.pass(milliseconds(500));  // the way back takes longer than to brake
  bench.send(0, cs8::Stop{});
  for (int i = 0; i < 100 && bench.phase() != Phase::kRetract; ++i) bench.pass(milliseconds(4));
  ASSERT_EQ(bench.phase(), Phase::kRetract);
  const calib::JointVector at_stop = bench.joints();
  bench.send(0, cs8::Stop{});
  const auto result = bench.result<cs8::TouchResult>();
  EXPECT_EQ(result.outcome, Outcome::kStopped);
  EXPECT_EQ(result.phase, Phase::kSearch);
  EXPECT_LT(tip_distance_m(plant(), bench.joints(), at_stop), 0.02 * (kTickSeconds + kResetSeconds));
  EXPECT_GT(tip_distance_m(plant(), bench.joints(), motion().approach), 1e-3);
  bench.pass(milliseconds(20));
  EXPECT_TRUE(bench.flag(cs8::kRetractDue));
}

TEST_F(Interruption, WhatIsLeftNearAFaceTakesNothingButARetractToTheClearPosture) {
  for (const Phase phase : {Phase::kApproach, Phase::kSearch, Phase::kRetract}) {
    for (const bool by_stop : {true, false}) {
      Bench bench = Bench::ready(plant());
      bench.touch_until(1, motion(), phase);
      if (by_stop) {
        bench.send(0, cs8::Stop{});
        bench.result<cs8::TouchResult>();
      } else {
        bench.happen(ConnectionClosed{});
        bench.tick(kStandstill);
        bench.connect();
      }
      bench.send(0, cs8::ResultAcknowledge{1});
      bench.pass(milliseconds(20));
      EXPECT_TRUE(bench.flag(cs8::kRetractDue));
      if (!by_stop) {
        EXPECT_EQ(bench.rejection(2, kRetract), RejectReason::kNotPermitted);
        bench.permit();
      }
      const RejectReason expected = by_stop ? RejectReason::kNotPermitted : RejectReason::kRetractPending;
      EXPECT_EQ(bench.rejection(2, touch()), expected);
      EXPECT_EQ(bench.rejection(2, travel_command(beside_park())), expected);
      bench.answer<cs8::Accepted>(2, kRetract);
      const auto result = bench.result<cs8::MoveResult>();
      EXPECT_EQ(result.outcome, Outcome::kArrived);
      EXPECT_EQ(result.joints, touch().clear);
      bench.pass(milliseconds(20));
      EXPECT_FALSE(bench.flag(cs8::kRetractDue));
      bench.send(0, cs8::ResultAcknowledge{2});
      if (by_stop) {
        EXPECT_EQ(bench.rejection(3, touch()), RejectReason::kNotPermitted);
        bench.permit();
      }
      bench.answer<cs8::Accepted>(3, touch());
    }
  }
}

TEST_F(Interruption, AHostThatFallsSilentStopsTheArmInEachPhaseAfterItsTimeout) {
  for (const Phase phase : {Phase::kTravel, Phase::kApproach, Phase::kSearch, Phase::kRetract}) {
    Bench bench = Bench::ready(plant(), {.speed = 0.1});  // slow: no phase ends within the timeout
    bench.touch_until(1, motion(), phase);
    bench.tick(milliseconds(499));
    EXPECT_NE(bench.phase(), Phase::kIdle) << "it brakes too early";
    bench.tick(milliseconds(1));
    EXPECT_TRUE(bench.last.close);
    EXPECT_EQ(bench.phase(), Phase::kIdle);
    bench.tick(10 * kStandstill);
    ASSERT_FALSE(bench.state.motion.running);
    const auto result = std::get<cs8::TouchResult>(bench.state.stored_result->payload);
    EXPECT_EQ(result.outcome, Outcome::kHeartbeatLost);
    EXPECT_EQ(result.phase, phase);
    EXPECT_EQ(bench.state.motion.retract_path.empty(), phase == Phase::kTravel);
  }
}

TEST_F(Interruption, StopsTheArmWhereItWasWhenTheTimeoutRanOutHoweverLateTheTickIs) {
  const auto stopped_after = [](milliseconds tick) {
    Bench bench = Bench::ready(plant(), {.speed = 0.1});
    bench.touch_until(1, motion(), Phase::kSearch);
    bench.tick(tick);
    bench.tick(10 * kStandstill);
    return wire_from_joints(bench.state.cabinet.drives.joints);
  };
  EXPECT_EQ(stopped_after(milliseconds(500)), stopped_after(milliseconds(5000)));
}

TEST_F(Interruption, BytesThatWaitToBeReadAreNotSilence) {
  Bench bench = Bench::ready(plant(), {.speed = 0.1});
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.now += milliseconds(2000);
  bench.happen(Tick{.bytes_waiting = true});
  EXPECT_TRUE(bench.state.motion.running);
}

TEST_F(Interruption, ALostSocketStopsTheArmAndTheResultIsFoundAfterReconnecting) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kTravel);
  bench.happen(ConnectionClosed{});
  bench.tick(kStandstill);
  EXPECT_FALSE(bench.state.motion.running);
  EXPECT_EQ(bench.connect().open_sequence, 1u);
  const auto result = std::get<cs8::TouchResult>(bench.send(0, cs8::ResultQuery{1}).back().payload);
  EXPECT_EQ(result.outcome, Outcome::kHeartbeatLost);
  EXPECT_EQ(result.phase, Phase::kTravel);
}

TEST_F(Interruption, ARetractThatIsBrokenOffCanBeAskedForAgain) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.happen(ConnectionClosed{});
  bench.tick(kStandstill);
  bench.connect();
  bench.send(0, cs8::ResultAcknowledge{1});
  bench.permit();
  bench.answer<cs8::Accepted>(2, kRetract);
  bench.pass(milliseconds(60));
  bench.send(0, cs8::Stop{});
  EXPECT_EQ(bench.result<cs8::MoveResult>().outcome, Outcome::kStopped);
  bench.send(0, cs8::ResultAcknowledge{2});
  bench.answer<cs8::Accepted>(3, kRetract);
  EXPECT_EQ(bench.result<cs8::MoveResult>().joints, touch().clear);
}

TEST_F(Interruption, ADeadlineIsWallTimeAndStopsTheArm) {
  for (const double speed : {0.5, 1.0}) {
    Bench bench = Bench::ready(plant(), {.speed = speed});
    cs8::Travel travel = travel_command(motion().waypoints.back());
    travel.deadline_ms = 300;
    bench.answer<cs8::Accepted>(1, travel);
    bench.pass(milliseconds(280));
    EXPECT_TRUE(bench.state.motion.running);
    bench.pass(milliseconds(20));
    EXPECT_EQ(bench.result<cs8::MoveResult>().outcome, Outcome::kDeadline);
  }
}

TEST_F(Interruption, LosesPermissionWhileMoving) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.state.cabinet.panel.held = true;
  bench.tick(milliseconds(4));
  EXPECT_EQ(bench.result<cs8::TouchResult>().outcome, Outcome::kPermissionLost);
}

TEST_F(Interruption, AMissedFaceIsNoContact) {
  const auto beside =
      aimed_touch(demo(), {.u_m = demo().block.faces[2].half_extent_m.x() + 0.02, .tilt_rad = 0.0});
  Bench bench = Bench::ready(plant(), {.speed = 10.0});
  bench.answer<cs8::Accepted>(1, touch_command(beside.motion));
  const auto result = bench.result<cs8::TouchResult>();
  EXPECT_EQ(result.outcome, Outcome::kNoContact);
  EXPECT_EQ(result.source, cs8::CaptureSource::kNone);
  EXPECT_EQ(result.contact, cs8::JointsMicrodeg{});
}

TEST_F(Interruption, AnEdgeInTheApproachIsLeftByARetract) {
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

TEST_F(Interruption, AnEdgeInATravelIsLeftByTheOperator) {
  Bench bench = Bench::ready(plant());
  bench.answer<cs8::Accepted>(1, travel_command(motion().search_end));
  const auto met = bench.result<cs8::MoveResult>();
  EXPECT_EQ(met.outcome, Outcome::kUnexpectedContact);
  EXPECT_EQ(met.phase, Phase::kTravel);
  bench.send(0, cs8::ResultAcknowledge{1});
  const auto permit = std::get<cs8::Permit>(bench.send(0, cs8::Begin{2, 30'000}).front().payload);
  EXPECT_EQ(permit.detail, static_cast<std::int32_t>(RejectReason::kProbeTriggered));
  EXPECT_EQ(bench.rejection(2, kRetract), RejectReason::kNotPermitted);
  bench.happen(ConnectionClosed{});
  bench.connect();
  bench.permit();
  bench.answer<cs8::Accepted>(2, touch());
}

TEST_F(Interruption, AMessageBehindTheCutOfItsConnectionIsNotAnswered) {
  Bench bench = Bench::ready(plant());
  bench.state.plan.add({.what = LinkFault{Fault::kCloseSocket}});
  bench.now += milliseconds(20);
  EXPECT_TRUE(bench.send(0, cs8::Heartbeat{}).empty());
  ASSERT_EQ(bench.last.link_faults.size(), 1U);
  EXPECT_EQ(bench.last.link_faults.front().kind, Fault::kCloseSocket);
}

TEST_F(Interruption, ACollisionTakesPowerAwayUntilTheOperatorFreesTheArmForTheNextHost) {
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
  bench.permit();
  EXPECT_TRUE(bench.flag(cs8::kPowered));
  EXPECT_EQ(bench.last_state()->joints, wire_from_joints(plant().start_joints));
  bench.answer<cs8::Accepted>(2, travel_command(beside_park()));
}

}  // namespace
}  // namespace sim
