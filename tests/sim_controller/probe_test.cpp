#include "sim_controller/probe.hpp"

#include <gtest/gtest.h>

namespace sim {
namespace {

constexpr unsigned kAir = 0;
constexpr unsigned kAllTick = (1U << kLatchStepsPerTick) - 1U;
constexpr ProbeInputs kFree{false, true};
constexpr ProbeInputs kTouched{true, false};

/// Deflected from this latch step (0 to 19) to the tick's end.
constexpr unsigned from_step(int first) { return kAllTick & ~((1U << first) - 1U); }

TEST(Probe, LatchesTheStepInWhichTheBallFirstTouches) {
  for (int first = 0; first < kLatchStepsPerTick; ++first) {
    Probe probe;
    const ProbeTick seen = step(probe, from_step(first));
    EXPECT_EQ(seen.edges, 1);
    ASSERT_TRUE(seen.edge_share);
    EXPECT_DOUBLE_EQ(*seen.edge_share, 0.05 * (first + 1));
    EXPECT_EQ(probe.inputs, kTouched);
    EXPECT_EQ(step(probe, kAllTick).edges, 0) << "held, no new edge";
    EXPECT_FALSE(step(probe, kAir).edge_share);
    EXPECT_EQ(probe.inputs, kFree) << "seated again";
  }
}

TEST(Probe, SeesAGrazeThatIsOverBeforeTheTicksEnd) {
  Probe probe;
  const ProbeTick seen = step(probe, 0b1100U);
  EXPECT_EQ(seen.edges, 1);
  EXPECT_DOUBLE_EQ(seen.edge_share.value(), 0.15);
  EXPECT_EQ(probe.inputs, kFree) << "nothing that polls sees it";
}

TEST(Probe, ThatStaysTouchedReadsSoInTheAirUntilFreed) {
  Probe probe{.troubles = {.stylus = StylusTrouble::kStaysTouched}};
  step(probe, kAir);
  EXPECT_EQ(probe.inputs, kTouched);
  free_probe(probe);
  step(probe, kAir);
  EXPECT_EQ(probe.inputs, kFree);
}

TEST(Probe, ThatNeverTouchesKeepsBothInputsAsInTheAir) {
  Probe probe{.troubles = {.stylus = StylusTrouble::kNeverTouches}};
  EXPECT_EQ(step(probe, from_step(3)).edges, 0);
  EXPECT_EQ(step(probe, kAllTick).edges, 0);
  EXPECT_EQ(probe.inputs, kFree);
}

TEST(Probe, ThatSticksStaysTouchedAfterTheRetractUntilFreed) {
  Probe probe{.troubles = {.stylus = StylusTrouble::kSticks}};
  step(probe, kAir);
  EXPECT_EQ(probe.inputs, kFree);
  EXPECT_DOUBLE_EQ(step(probe, from_step(9)).edge_share.value(), 0.5);
  for (int tick = 0; tick < 100; ++tick) {
    step(probe, kAir);
    ASSERT_EQ(probe.inputs, kTouched);
  }
  free_probe(probe);
  step(probe, kAir);
  EXPECT_EQ(probe.inputs, kFree);
  EXPECT_EQ(step(probe, from_step(9)).edges, 1) << "and works again";
}

TEST(Probe, BouncesSoManyTimesAndLatchesTheFirstEdge) {
  for (const int bounces : {1, 3, 8}) {
    Probe probe{.troubles = {.bounces = bounces}};
    ProbeTick seen = step(probe, from_step(14));
    int edges = seen.edges;
    EXPECT_DOUBLE_EQ(seen.edge_share.value(), 0.75);
    for (int tick = 0; tick < 10; ++tick) edges += step(probe, kAllTick).edges;
    EXPECT_EQ(edges, bounces + 1);
    EXPECT_EQ(probe.inputs, kTouched);
  }
}

TEST(Probe, ShakenForMoreThanALatchStepGivesAnEdgeInFreeAir) {
  Probe probe{.troubles = {.vibration_s = 3 * kLatchSeconds}};
  const ProbeTick seen = step(probe, kAir);
  EXPECT_EQ(seen.edges, 1);
  EXPECT_TRUE(seen.edge_share);
  EXPECT_EQ(probe.inputs, kFree) << "over before anything polls";
  EXPECT_EQ(step(probe, kAir).edges, 0) << "once only";
}

TEST(Probe, ShakenForLongIsSeenByWhatPollsAndEndsOnTime) {
  const int steps = 45;  // of 0.2 ms, from the middle of the first tick: 10 + 20 + 15
  Probe probe{.troubles = {.vibration_s = steps * kLatchSeconds}};
  EXPECT_EQ(step(probe, kAir).edges, 1);
  EXPECT_EQ(probe.inputs, kTouched);
  EXPECT_EQ(step(probe, kAir).edges, 0);
  EXPECT_EQ(probe.inputs, kTouched);
  step(probe, kAir);
  EXPECT_EQ(probe.inputs, kFree);
}

TEST(Probe, AnEdgeShorterThanALatchStepCapturesNothing) {
  Probe probe{.troubles = {.vibration_s = 0.5 * kLatchSeconds}};
  const ProbeTick seen = step(probe, kAir);
  EXPECT_EQ(seen.edges, 1);
  EXPECT_FALSE(seen.edge_share);
  EXPECT_EQ(probe.inputs, kFree);
  EXPECT_EQ(step(probe, kAir).edges, 0);
}

TEST(Probe, WhoseLatchLosesEdgesIsStillSeenWhenPolled) {
  Probe probe{.troubles = {.latch_loses_edges = true}};
  const ProbeTick seen = step(probe, from_step(5));
  EXPECT_EQ(seen.edges, 1);
  EXPECT_FALSE(seen.edge_share);
  EXPECT_EQ(probe.inputs, kTouched);
}

TEST(Probe, ACutLoopIsOpenWhateverTheStylusDoes) {
  Probe probe{.troubles = {.loop_wire = WireTrouble::kCut}};
  step(probe, kAir);
  EXPECT_EQ(probe.inputs, (ProbeInputs{false, false}));
  step(probe, kAllTick);
  EXPECT_EQ(probe.inputs, kTouched);
}

TEST(Probe, AShortedLoopIsClosedWhateverTheStylusDoes) {
  Probe probe{.troubles = {.loop_wire = WireTrouble::kShorted}};
  step(probe, kAir);
  EXPECT_EQ(probe.inputs, kFree);
  EXPECT_TRUE(step(probe, from_step(7)).edge_share);
  EXPECT_EQ(probe.inputs, (ProbeInputs{true, true}));
}

TEST(Probe, ACutContactIsNeverTouchedButTheLoopOpens) {
  Probe probe{.troubles = {.contact_wire = WireTrouble::kCut}};
  EXPECT_EQ(step(probe, from_step(7)).edges, 0);
  EXPECT_EQ(probe.inputs, (ProbeInputs{false, false}));
  probe.troubles.vibration_s = 0.5 * kLatchSeconds;
  EXPECT_EQ(step(probe, kAllTick).edges, 0);
}

TEST(Probe, AShortedContactReadsTouchedBesideAClosedLoop) {
  Probe probe{.troubles = {.contact_wire = WireTrouble::kShorted}};
  EXPECT_EQ(step(probe, kAir).edges, 1) << "the short itself is an edge";
  EXPECT_EQ(probe.inputs, (ProbeInputs{true, true}));
  EXPECT_EQ(step(probe, from_step(7)).edges, 0);
}

}  // namespace
}  // namespace sim
