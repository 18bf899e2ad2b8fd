#include "sim_controller/motion_task.hpp"

#include <gtest/gtest.h>

#include "bench.hpp"

/// What the probe can do to a touch: PROTOCOL.md section 6.
namespace sim {
namespace {

using cs8::CaptureSource;
using cs8::Outcome;
using cs8::Phase;
using testing::Bench;
using testing::milliseconds;
using testing::touch_command;

class MotionTask : public testing::DemoTouch {
 protected:
  static cs8::Touch twice() {
    cs8::Touch command = touch();
    command.second_speed_um_s = 2'000;
    command.second_backoff_dmm = 20'000;
    return command;
  }
  /// The result of a touch into which `meddle` reaches when it has come to `phase`.
  template <class Meddle>
  static cs8::TouchResult touched(const cs8::Touch& command, Phase phase, const Meddle& meddle) {
    Bench bench = Bench::ready(plant());
    bench.answer<cs8::Accepted>(1, command);
    while (bench.state.motion.running && bench.phase() != phase) bench.pass(milliseconds(4));
    meddle(bench.state.cabinet);
    return bench.result<cs8::TouchResult>();
  }
  static double apart_m(const cs8::JointsMicrodeg& a, const cs8::JointsMicrodeg& b) {
    return tip_distance_m(plant(), joints_from_wire(a), joints_from_wire(b));
  }
};

constexpr auto kNothing = [](Cabinet&) {};

TEST_F(MotionTask, TheSecondTouchIsTheMeasurementAndAgreesWithTheFirst) {
  const auto result = touched(twice(), Phase::kIdle, kNothing);
  EXPECT_EQ(result.outcome, Outcome::kContact);
  EXPECT_EQ(result.source, CaptureSource::kLatched);
  EXPECT_EQ(result.first_source, CaptureSource::kLatched);
  EXPECT_EQ(result.search_speed_um_s, 2'000);
  EXPECT_NE(result.contact, result.first_contact);
  // Both read the latch at the end of its step.
  EXPECT_LT(apart_m(result.contact, result.first_contact), 0.008 * kLatchSeconds + 1e-6);
  const double first_stop_m = stopping_distance_m(0.008, kStopLatencySeconds);
  EXPECT_LT(apart_m(result.contact, result.stopped), first_stop_m);
  EXPECT_GT(cs8::metres_from_dmm(result.overtravel_dmm), 0.5 * first_stop_m) << "the longer of both";
}

TEST_F(MotionTask, WithoutALatchTheContactIsPolledAndSaysSo) {
  const auto lost = touched(touch(), Phase::kSearch,
                            [](Cabinet& cabinet) { cabinet.world.probe.troubles.latch_loses_edges = true; });
  const auto latched = touched(touch(), Phase::kIdle, kNothing);
  EXPECT_EQ(lost.outcome, Outcome::kContact);
  EXPECT_EQ(lost.source, CaptureSource::kPolled);
  EXPECT_LE(apart_m(lost.contact, latched.contact), 0.008 * kTickSeconds + 1e-6);
  EXPECT_GT(apart_m(lost.contact, latched.contact), 0.0);
}

TEST_F(MotionTask, BouncesAreCountedAndTheFirstEdgeCounts) {
  const auto clean = touched(touch(), Phase::kIdle, kNothing);
  const auto bounced =
      touched(touch(), Phase::kSearch, [](Cabinet& cabinet) { cabinet.world.probe.troubles.bounces = 3; });
  EXPECT_EQ(clean.edges, 1u);
  EXPECT_GT(bounced.edges, 1u);
  EXPECT_EQ(bounced.outcome, Outcome::kContact);
  EXPECT_LE(apart_m(bounced.contact, clean.contact), 0.008 * 7 * kLatchSeconds + 1e-6);
}

TEST_F(MotionTask, AnEdgeOfNoiseInTheSearchIsNoContact) {
  const auto result = touched(touch(), Phase::kSearch,
                              [](Cabinet& cabinet) { cabinet.world.probe.troubles.vibration_s = 0.001; });
  EXPECT_EQ(result.outcome, Outcome::kNoContact);
  EXPECT_EQ(result.source, CaptureSource::kNone);
  EXPECT_GE(result.edges, 1u);
}

TEST_F(MotionTask, AnEdgeOnTheWayIsAnUnexpectedContactHoweverShort) {
  for (const Phase phase : {Phase::kTravel, Phase::kApproach}) {
    const auto result =
        touched(touch(), phase, [](Cabinet& cabinet) { cabinet.world.probe.troubles.vibration_s = 0.001; });
    EXPECT_EQ(result.outcome, Outcome::kUnexpectedContact) << cs8::name(phase);
    EXPECT_EQ(result.phase, phase);
  }
}

TEST_F(MotionTask, ACutOrShortedWireIsAProbeFaultInEveryPhaseAndNeverFree) {
  for (const Phase phase : {Phase::kTravel, Phase::kApproach, Phase::kSearch}) {
    for (const bool loop : {true, false}) {
      const auto result = touched(touch(), phase, [loop](Cabinet& cabinet) {
        ProbeTroubles& troubles = cabinet.world.probe.troubles;
        (loop ? troubles.loop_wire : troubles.contact_wire) =
            loop ? WireTrouble::kCut : WireTrouble::kShorted;
      });
      EXPECT_EQ(result.outcome, Outcome::kProbeFault) << cs8::name(phase) << (loop ? " loop" : " contact");
    }
  }
}

TEST_F(MotionTask, AWireThatOnlyShowsAtTheContactIsAProbeFaultThere) {
  for (const bool loop : {true, false}) {
    const auto result = touched(touch(), Phase::kTravel, [loop](Cabinet& cabinet) {
      ProbeTroubles& troubles = cabinet.world.probe.troubles;
      (loop ? troubles.loop_wire : troubles.contact_wire) = loop ? WireTrouble::kShorted : WireTrouble::kCut;
    });
    EXPECT_EQ(result.outcome, Outcome::kProbeFault);
    EXPECT_EQ(result.phase, Phase::kSearch);
    EXPECT_NE(result.stopped, cs8::JointsMicrodeg{}) << "it stands somewhere";
  }
}

TEST_F(MotionTask, AWireThatFailsOnTheWayBackStopsTheArmThere) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kRetract);
  bench.state.cabinet.world.probe.troubles.loop_wire = WireTrouble::kCut;  // never free again
  const auto result = bench.result<cs8::TouchResult>();
  EXPECT_EQ(result.outcome, Outcome::kProbeFault);
  EXPECT_EQ(result.phase, Phase::kRetract);
  EXPECT_NE(result.stopped, touch().clear);
  bench.pass(milliseconds(20));
  EXPECT_TRUE(bench.flag(cs8::kRetractDue));
}

TEST_F(MotionTask, ASecondContactThatIsNotMadeLeavesTheFirstOneInItsOwnFields) {
  const auto result = touched(twice(), Phase::kSearch, [](Cabinet& cabinet) {
    cabinet.world.probe.troubles.stylus = StylusTrouble::kSticks;
  });
  ASSERT_EQ(result.outcome, Outcome::kProbeStuck);
  EXPECT_EQ(result.source, cs8::CaptureSource::kNone);
  EXPECT_EQ(result.contact, cs8::JointsMicrodeg{});
  EXPECT_EQ(result.contact_clock_ms, 0U);
  EXPECT_EQ(result.first_source, cs8::CaptureSource::kLatched);
  EXPECT_NE(result.first_contact, cs8::JointsMicrodeg{});
  EXPECT_EQ(result.search_speed_um_s, touch().search_speed_um_s) << "the second search did not begin";
}

TEST_F(MotionTask, AProbeThatDoesNotSeatAgainIsStuckAndNoMeasurement) {
  for (const cs8::Touch& command : {touch(), twice()}) {
    const auto result = touched(command, Phase::kSearch, [](Cabinet& cabinet) {
      cabinet.world.probe.troubles.stylus = StylusTrouble::kSticks;
    });
    EXPECT_EQ(result.outcome, Outcome::kProbeStuck);
    EXPECT_EQ(result.phase, Phase::kIdle) << "it is at its clear posture";
  }
}

TEST_F(MotionTask, AnEdgeOnTheWayBackIsAnUnexpectedContactOnceTheProbeWasFree) {
  const auto result = touched(touch(), Phase::kRetract,
                              [](Cabinet& cabinet) { cabinet.world.probe.troubles.vibration_s = 0.001; });
  EXPECT_EQ(result.outcome, Outcome::kContact) << "it is still on the face: that is its way off";
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kRetract);
  while (!bench.state.cabinet.probe_free()) bench.pass(milliseconds(4));
  bench.pass(milliseconds(8));
  bench.state.cabinet.world.probe.troubles.vibration_s = 0.001;
  const auto met = bench.result<cs8::TouchResult>();
  EXPECT_EQ(met.outcome, Outcome::kUnexpectedContact);
  EXPECT_EQ(met.phase, Phase::kRetract);
  bench.pass(milliseconds(20));
  EXPECT_TRUE(bench.flag(cs8::kRetractDue));
}

TEST_F(MotionTask, TheLowestMonitorSpeedOfTheSearchIsToldWithTheContact) {
  Bench bench = Bench::ready(plant());
  bench.touch_until(1, motion(), Phase::kSearch);
  bench.state.cabinet.panel.monitor_speed_percent = 50;
  bench.pass(milliseconds(40));
  bench.state.cabinet.panel.monitor_speed_percent = 100;
  EXPECT_EQ(bench.result<cs8::TouchResult>().monitor_speed_percent, 50);
}

TEST_F(MotionTask, LostReferencesEndTheCommand) {
  const auto result =
      touched(touch(), Phase::kSearch, [](Cabinet& cabinet) { cabinet.panel.arm_calibrated = false; });
  EXPECT_EQ(result.outcome, Outcome::kPermissionLost);
}

TEST_F(MotionTask, ATaskThatDiesEndsTheCommandWithItsNumber) {
  for (const Phase phase : {Phase::kTravel, Phase::kApproach, Phase::kSearch, Phase::kRetract}) {
    const auto result = touched(touch(), phase, [](Cabinet& cabinet) { cabinet.task_error = 123; });
    EXPECT_EQ(result.outcome, Outcome::kTaskFailed);
    EXPECT_EQ(result.error_number, 123);
    EXPECT_EQ(result.phase, phase);
  }
}

TEST_F(MotionTask, AnArmThatDoesNotComeToRestIsNotWaitedForForEver) {
  const auto result =
      touched(touch(), Phase::kSearch, [](Cabinet& cabinet) { cabinet.never_settles = true; });
  EXPECT_EQ(result.outcome, Outcome::kMotionError);
  EXPECT_NE(result.error_number, 0);
}

TEST_F(MotionTask, AnArmAtItsTargetHasArrivedThoughTheDrivesNeverSaySo) {
  Bench bench = Bench::ready(plant());
  bench.state.cabinet.never_settles = true;
  bench.answer<cs8::Accepted>(1, travel_command(beside_park()));
  const auto result = bench.result<cs8::MoveResult>();
  EXPECT_EQ(result.outcome, Outcome::kArrived);
  EXPECT_EQ(result.joints, wire_from_joints(beside_park()));
}

TEST_F(MotionTask, EdgesAreThoseOfTheLastTriggerThoughASecondOneWasToCome) {
  Bench bench = Bench::ready(plant());
  bench.answer<cs8::Accepted>(1, twice());
  const auto searches_again = [&bench] {
    return bench.state.motion.running->first && bench.state.motion.running->stage == Stage::kSearch;
  };
  while (bench.state.motion.running && !searches_again()) bench.pass(milliseconds(4));
  ASSERT_TRUE(bench.state.motion.running);
  bench.send(0, cs8::Stop{});
  const auto result = bench.result<cs8::TouchResult>();
  EXPECT_EQ(result.outcome, Outcome::kStopped);
  EXPECT_EQ(result.first_source, cs8::CaptureSource::kLatched);
  EXPECT_EQ(result.edges, 1u);
}

TEST_F(MotionTask, OvertravelIsNoMeasurement) {
  Plant slow = plant();
  slow.stop_latency_s = 0.04;
  slow.overtravel_m = 2e-4;
  Bench bench = Bench::ready(slow);
  cs8::Touch command = touch();
  command.search_speed_um_s = search_speed_max_um_s(slow);
  bench.answer<cs8::Accepted>(1, command);
  const auto result = bench.result<cs8::TouchResult>();
  EXPECT_EQ(result.outcome, Outcome::kOvertravel);
  EXPECT_GT(cs8::metres_from_dmm(result.overtravel_dmm), slow.overtravel_m);
}

TEST_F(MotionTask, HoldInEveryPhaseForgetsTheRestOfTheMotion) {
  for (const Phase phase : {Phase::kTravel, Phase::kApproach, Phase::kSearch, Phase::kRetract}) {
    Bench bench = Bench::ready(plant());
    bench.touch_until(1, motion(), phase);
    perform(bench.plant, bench.state.cabinet, Act::kHold);
    EXPECT_EQ(bench.result<cs8::TouchResult>().outcome, Outcome::kPermissionLost);
    const calib::JointVector standing = bench.joints();
    perform(bench.plant, bench.state.cabinet, Act::kMove);
    bench.pass(milliseconds(1000));
    EXPECT_EQ(bench.joints(), standing) << cs8::name(phase);
  }
}

}  // namespace
}  // namespace sim
