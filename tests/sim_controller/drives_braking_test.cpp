// Resets, holds and the monitor speed.
#include <gtest/gtest.h>

#include <cmath>

#include "drive_runs.hpp"

namespace sim {
namespace {

using namespace testing;

TEST(ResetMotion, StandsWithinThePromisedWayAndTimeAtAnySpeedOfASearch) {
  for (const double speed : {0.001, 0.003, 0.008, 0.02, 0.05, 0.1}) {
    for (const int more_ticks : {0, 1, 7}) {
      Drives drives = at_approach();
      movel(plant(), drives, search().search_end, speed);
      const double ramp_ticks = speed / kAccelerationMetresPerSecond2 / kTickSeconds;
      for (int i = 0; i < more_ticks + ramp_ticks; ++i) tick(drives, 100.0, true);
      const double edge_m = on_search_line(drives.joints).along_m;
      for (int i = 0; i * kTickSeconds < kStopLatencySeconds; ++i) tick(drives, 100.0, true);
      const std::vector<TickMotion> ticks = brake(drives);
      for (const TickMotion& tick : ticks) EXPECT_LT(on_search_line(tick.to).off_m, 1e-6);
      EXPECT_LE(on_search_line(drives.joints).along_m - edge_m,
                stopping_distance_m(speed, kStopLatencySeconds));
      EXPECT_LE(duration_s(ticks), speed / kResetDecelerationMetresPerSecond2 + kTickSeconds);
      EXPECT_TRUE(drives.queue.empty());
      EXPECT_EQ(drives.rate, 0.0);
      EXPECT_EQ(move_id(drives), 0.0);
    }
  }
}

TEST(ResetMotion, AtTravelSpeedItBrakesFor125Milliseconds) {
  // 250 mm/s and 2 m/s^2: 125 ms, 15.6 mm.
  const calib::JointVector from = plant().start_joints;
  calib::JointVector to = from;
  to[0] += 1.5;  // an arc: the tool is at its cap all the way
  Drives drives{.joints = from};
  movej(plant(), drives, to, 0.25);
  for (int i = 0; i < 200; ++i) tick(drives, 100.0, true);
  const calib::JointVector here = drives.joints;
  const double duration = duration_s(brake(drives));
  EXPECT_NEAR(duration, 0.125, kTickSeconds);
  EXPECT_NEAR(tip_distance_m(plant(), here, drives.joints), 0.25 * 0.25 / 4.0, 0.2e-3);
}

TEST(ResetMotion, AnyJointMoveStandsWithin150Milliseconds) {
  std::mt19937_64 chance(12);
  for (int move = 0; move < 200; ++move) {
    const calib::JointVector from = random_joints(chance);
    const calib::JointVector to = random_joints(chance);
    const double cap_m_s = move % 2 == 0 ? 0.25 : 5.0;
    Drives drives{.joints = from};
    movej(plant(), drives, to, cap_m_s);
    const auto before = static_cast<int>(chance() % 200);
    for (int i = 0; i < before && !drives.queue.empty(); ++i) tick(drives, 100.0, true);
    EXPECT_LE(duration_s(brake(drives)), 0.150);
    // On the straight line in joint space, not beyond its end.
    const double progress = (drives.joints - from).dot(to - from) / (to - from).squaredNorm();
    EXPECT_LT((drives.joints - from - progress * (to - from)).norm(), 1e-9);
    EXPECT_LE(progress, 1.0 + 1e-12);
  }
}

TEST(ResetMotion, IsOverAtOnceWhenTheArmStands) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.008);
  reset_motion(drives);
  EXPECT_TRUE(drives.queue.empty());
  EXPECT_TRUE(is_settled(drives));
  EXPECT_EQ(drives.joints, search().approach);
}

TEST(ResetMotion, SwallowsMotionsUntilTheArmStands) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.008);
  for (int i = 0; i < 100; ++i) tick(drives, 100.0, true);
  reset_motion(drives);
  movej(plant(), drives, plant().start_joints, 0.25);
  movel(plant(), drives, search().approach, 0.25);
  follow(plant(), drives, {{search().search_end, search().approach}}, 0.25);
  EXPECT_EQ(drives.queue.size(), 1U);  // the search
  while (drives.braking) tick(drives, 100.0, true);
  EXPECT_TRUE(drives.queue.empty());
  movel(plant(), drives, search().approach, 0.02);
  run(drives);
  EXPECT_EQ(drives.joints, search().approach);
}

TEST(ResetMotion, BrakesWithoutPermissionToo) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.1);
  for (int i = 0; i < 50; ++i) tick(drives, 100.0, true);
  reset_motion(drives);
  int ticks = 0;
  for (; drives.braking && ticks < kTicksMax; ++ticks) tick(drives, 0.0, false);
  EXPECT_LE(ticks * kTickSeconds, 0.1 / kResetDecelerationMetresPerSecond2 + kTickSeconds);
}

TEST(Hold, StopsOnThePathWithItsRampKeepsTheQueueAndGoesOn) {
  const double speed = 0.05;
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, speed);
  for (int i = 0; i < 60; ++i) tick(drives, 100.0, true);
  const double pressed_m = on_search_line(drives.joints).along_m;
  int stopping_ticks = 0;
  for (; drives.rate > 0.0; ++stopping_ticks) {
    EXPECT_LT(on_search_line(tick(drives, 100.0, false).to).off_m, 1e-6);
  }
  EXPECT_NEAR(stopping_ticks * kTickSeconds, speed / kAccelerationMetresPerSecond2, kTwoTicksSeconds);
  EXPECT_NEAR(on_search_line(drives.joints).along_m - pressed_m, stopping_distance_m(speed, 0.0), 1e-5);

  const calib::JointVector held = drives.joints;
  for (int i = 0; i < kSettledTicks; ++i) tick(drives, 100.0, false);
  EXPECT_EQ(drives.joints, held);
  EXPECT_FALSE(is_empty(drives));
  EXPECT_TRUE(is_settled(drives));

  run(drives);
  EXPECT_EQ(drives.joints, search().search_end);
}

TEST(Hold, AtAnyTickOfAMoveEndsWhereTheMoveEnds) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.1);
  while (!drives.queue.empty()) {
    Drives held = drives;
    for (int i = 0; i < 60; ++i) tick(held, 100.0, false);
    EXPECT_EQ(held.rate, 0.0);
    run(held);
    ASSERT_EQ(held.joints, search().search_end);
    tick(drives, 100.0, true);
  }
}

TEST(MonitorSpeed, TenPerCentTakesTenTimesAsLongInTheFlatPart) {
  const double speed = 0.02;
  const auto flat_s = [&](double percent) {
    Drives drives = at_approach();
    movel(plant(), drives, search().search_end, speed);
    // Without the two ramps, each of which is the mean of standstill and speed: half its time is flat's.
    return duration_s(run(drives, percent)) - speed * percent / 100.0 / kAccelerationMetresPerSecond2;
  };
  EXPECT_NEAR(flat_s(100.0), search_length_m() / speed, kTwoTicksSeconds);
  EXPECT_NEAR(flat_s(10.0), 10.0 * search_length_m() / speed, kTwoTicksSeconds);
}

TEST(MonitorSpeed, TurnedDownInAMoveTheArmSlowsWithItsRamp) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.05);
  for (int i = 0; i < 60; ++i) tick(drives, 100.0, true);
  double before_m_s = tip_speed_m_s(tick(drives, 100.0, true));
  for (int i = 0; i < 60; ++i) {
    const double speed_m_s = tip_speed_m_s(tick(drives, 20.0, true));
    EXPECT_LE(before_m_s - speed_m_s, 1.01 * kAccelerationMetresPerSecond2 * kTickSeconds);
    before_m_s = speed_m_s;
  }
  EXPECT_NEAR(before_m_s, 0.2 * 0.05, 1e-4);
  run(drives, 20.0);
  EXPECT_EQ(drives.joints, search().search_end);
}

}  // namespace
}  // namespace sim
