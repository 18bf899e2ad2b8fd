#include "sim_controller/drives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "aimed_touch.hpp"

namespace sim {
namespace {

using testing::tip_m;

constexpr int kTicksMax = 100'000;
/// A move's end, and a peak that lies inside a tick, cost up to a tick each.
constexpr double kTwoTicksSeconds = 2.0 * kTickSeconds;

const Plant& plant() {
  static const Plant plant = testing::perfect_plant("demo");
  return plant;
}

/// A search down to a face of the demo cell: 30 mm.
const TouchMotion& search() {
  static const TouchMotion motion =
      testing::aimed_touch(testing::read_cell("demo"), {.face = 0, .tilt_rad = 0.7}).motion;
  return motion;
}
double search_length_m() { return tip_distance_m(plant(), search().approach, search().search_end); }

Drives at_approach() { return {.joints = search().approach}; }

calib::JointVector random_joints(std::mt19937_64& chance) {
  calib::JointVector joints;
  for (int i = 0; i < calib::kJointCount; ++i) {
    const double share = static_cast<double>(chance() >> 11) * 0x1p-53;
    joints[i] = plant().joint_ranges.lower[i] +
                share * (plant().joint_ranges.upper[i] - plant().joint_ranges.lower[i]);
  }
  return joints;
}

/// Ticks until the queue is empty; what happened in them.
std::vector<TickMotion> run(Drives& drives, double monitor_speed_percent = 100.0) {
  std::vector<TickMotion> ticks;
  while (!drives.queue.empty() && ticks.size() < kTicksMax)
    ticks.push_back(tick(drives, monitor_speed_percent, true));
  EXPECT_TRUE(drives.queue.empty());
  return ticks;
}
double duration_s(const std::vector<TickMotion>& ticks) {
  return kTickSeconds * static_cast<double>(ticks.size());
}
double tip_speed_m_s(const TickMotion& tick) {
  return tip_distance_m(plant(), tick.from, tick.to) / kTickSeconds;
}

/// Distance from the search's line, and how far along it.
struct OnLine {
  double off_m;
  double along_m;
};
OnLine on_search_line(const calib::JointVector& joints) {
  const Eigen::Vector3d start = tip_m(plant().nominal, search().approach);
  const Eigen::Vector3d way = tip_m(plant().nominal, search().search_end) - start;
  const Eigen::Vector3d here = tip_m(plant().nominal, joints) - start;
  const double along_m = here.dot(way.normalized());
  return {(here - along_m * way.normalized()).norm(), along_m};
}

TEST(Drives, LineTakesItsWayAtSpeedAndOneRampMore) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.008);
  const double expected_s = search_length_m() / 0.008 + 0.008 / kAccelerationMetresPerSecond2;
  EXPECT_NEAR(duration_s(run(drives)), expected_s, kTwoTicksSeconds);
  EXPECT_EQ(drives.joints, search().search_end);
  EXPECT_EQ(drives.error, 0);
}

TEST(Drives, LineTooShortForItsSpeedIsRampsOnly) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.25);  // whose two ramps would be 125 mm long
  const double expected_s = 2.0 * std::sqrt(search_length_m() / kAccelerationMetresPerSecond2);
  EXPECT_NEAR(duration_s(run(drives)), expected_s, kTwoTicksSeconds);
}

TEST(Drives, JointMoveKeepsToItsSlowestJoint) {
  // Joint 6 turns about an axis through the tip. Two ramps of 0.4 s, the rest at full speed.
  const double speed = plant().joint_speeds_max[5];
  const double turn_rad = 4.0;
  ASSERT_LT(speed * kJointRampSeconds, 2.0 * turn_rad);
  calib::JointVector from = plant().start_joints;
  from[5] = -turn_rad;
  calib::JointVector to = from;
  to[5] = turn_rad;
  Drives drives{.joints = from};
  movej(plant(), drives, to, 0.25);
  EXPECT_NEAR(duration_s(run(drives)), 2.0 * turn_rad / speed + kJointRampSeconds, kTwoTicksSeconds);
}

TEST(Drives, NoTickOfRandomJointMovesIsAboveASpeedOrARamp) {
  std::mt19937_64 chance(11);
  const calib::JointVector ramp_max = plant().joint_speeds_max / kJointRampSeconds;
  for (int move = 0; move < 60; ++move) {
    const double cap_m_s = std::array{0.02, 0.25, 5.0}[static_cast<std::size_t>(move % 3)];
    Drives drives{.joints = random_joints(chance)};
    const calib::JointVector target =
        move % 2 == 0 ? random_joints(chance)
                      : (drives.joints + 0.05 * (random_joints(chance) - drives.joints)).eval();
    movej(plant(), drives, target, cap_m_s);
    calib::JointVector speed_before = calib::JointVector::Zero();
    double fastest_m_s = 0.0;
    calib::JointVector joints = drives.joints;
    for (const TickMotion& tick : run(drives)) {
      ASSERT_EQ(tick.from, joints);
      joints = tick.to;
      const calib::JointVector speed = (tick.to - tick.from) / kTickSeconds;
      ASSERT_TRUE((speed.cwiseAbs().array() <= plant().joint_speeds_max.array() * (1.0 + 1e-9)).all());
      ASSERT_TRUE(
          ((speed - speed_before).cwiseAbs().array() / kTickSeconds <= ramp_max.array() * (1.0 + 1e-6))
              .all());
      ASSERT_LE(tip_speed_m_s(tick), cap_m_s * (1.0 + 1e-9));
      speed_before = speed;
      fastest_m_s = std::max(fastest_m_s, tip_speed_m_s(tick));
    }
    EXPECT_EQ(drives.joints, target);
    if (move % 6 == 0) {  // long and slow: the cap is used
      EXPECT_GT(fastest_m_s, 0.98 * cap_m_s);
    }
  }
}

TEST(Drives, SearchHasItsSpeedToAPerCentOnceTheRampIsOver) {
  const double speed = 0.008;
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, speed);
  const double ramp_s = speed / kAccelerationMetresPerSecond2;
  const std::vector<TickMotion> ticks = run(drives);
  int flat = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    EXPECT_LE(tip_speed_m_s(ticks[i]), speed * (1.0 + kToolSpeedErrorMax));
    const double from_s = kTickSeconds * static_cast<double>(i);
    if (from_s < ramp_s || from_s > duration_s(ticks) - ramp_s - kTwoTicksSeconds) continue;
    EXPECT_GE(tip_speed_m_s(ticks[i]), speed * (1.0 - 0.01));
    ++flat;
  }
  EXPECT_GT(flat, 900);  // 30 mm at 8 mm/s are 937 ticks
}

TEST(Drives, LineIsStraightAndItsOrientationFixedInsideTicksToo) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.1);
  const Eigen::Matrix3d turn = calib::forward_kinematics(plant().nominal, search().approach).linear();
  double along_m = 0.0;
  for (const TickMotion& tick : run(drives)) {
    EXPECT_LT((tick.at(0.0) - tick.from).norm(), 1e-12);
    EXPECT_LT((tick.at(1.0) - tick.to).norm(), 1e-12);
    for (int step = 1; step <= 20; ++step) {
      const calib::JointVector joints = tick.at(step / 20.0);
      const OnLine here = on_search_line(joints);
      EXPECT_LT(here.off_m, 1e-6);
      EXPECT_GE(here.along_m, along_m - 1e-12);
      along_m = here.along_m;
      const Eigen::Matrix3d turned = calib::forward_kinematics(plant().nominal, joints).linear();
      EXPECT_LT(Eigen::AngleAxisd(turn.transpose() * turned).angle(), 1e-6);
    }
  }
  EXPECT_NEAR(along_m, search_length_m(), 1e-9);
}

TEST(Drives, InsideATickOfARampTheWayGrowsWithTheSquareOfTime) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.1);
  const TickMotion first = tick(drives, 100.0, true);
  const double way_m = on_search_line(first.to).along_m;
  EXPECT_NEAR(way_m, kAccelerationMetresPerSecond2 * kTickSeconds * kTickSeconds / 2.0, 0.01 * way_m);
  EXPECT_NEAR(on_search_line(first.at(0.5)).along_m, way_m / 4.0, 1e-3 * way_m);
}

/// Ticks until a reset is over; the longest it may last.
std::vector<TickMotion> brake(Drives& drives) {
  std::vector<TickMotion> ticks;
  reset_motion(drives);
  while (drives.braking && ticks.size() < kTicksMax) ticks.push_back(tick(drives, 100.0, true));
  EXPECT_FALSE(drives.braking);
  return ticks;
}

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
  for (int i = 0; i < 10; ++i) tick(drives, 100.0, false);
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

TEST(Queue, MovesFollowOneAnotherFromStandstillToStandstill) {
  calib::JointVector corner = search().approach;
  corner[0] += 0.05;
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.02);
  movel(plant(), drives, search().approach, 0.02);
  movej(plant(), drives, corner, 0.25);
  ASSERT_EQ(drives.queue.size(), 3U);
  std::vector<calib::JointVector> stops;
  double id = move_id(drives);
  EXPECT_EQ(id, 0.0);
  while (!drives.queue.empty()) {
    const TickMotion motion = tick(drives, 100.0, true);
    EXPECT_GT(move_id(drives), id);
    EXPECT_LT(move_id(drives) - id, 0.2);
    id = move_id(drives);
    if (motion.rate_to == 0.0) stops.push_back(motion.to);
    EXPECT_FALSE(is_settled(drives));
  }
  EXPECT_EQ(stops, (std::vector<calib::JointVector>{search().search_end, search().approach, corner}));
  EXPECT_EQ(id, 3.0);
}

TEST(Queue, HalfWayThroughTheSecondMoveTheIdIsOneAndAHalf) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.02);
  movel(plant(), drives, search().approach, 0.02);
  while (move_id(drives) < 1.5) tick(drives, 100.0, true);
  EXPECT_NEAR(on_search_line(drives.joints).along_m, search_length_m() / 2.0, 0.02 * kTickSeconds);
}

TEST(Queue, IsEmptyBeforeTheArmIsSettled) {
  for (const bool by_reset : {false, true}) {
    Drives drives = at_approach();
    EXPECT_TRUE(is_empty(drives));
    EXPECT_TRUE(is_settled(drives));
    movel(plant(), drives, search().search_end, 0.1);
    EXPECT_FALSE(is_empty(drives));
    tick(drives, 100.0, true);
    EXPECT_FALSE(is_settled(drives));
    if (by_reset) {
      for (int i = 0; i < 50; ++i) tick(drives, 100.0, true);
      reset_motion(drives);
    }
    while (!is_empty(drives)) tick(drives, 100.0, true);
    EXPECT_FALSE(is_settled(drives));
    while (drives.rate > 0.0) tick(drives, 100.0, true);
    for (int i = 0; i < kSettledTicks; ++i) {
      EXPECT_FALSE(is_settled(drives));
      tick(drives, 100.0, true);
    }
    EXPECT_TRUE(is_settled(drives));
  }
}

TEST(Queue, AMoveToWhereTheArmIsEndsInATickOrTwo) {
  Drives drives = at_approach();
  movej(plant(), drives, search().approach, 0.25);
  movel(plant(), drives, search().approach, 0.25);
  EXPECT_LE(run(drives).size(), 6U);
  EXPECT_EQ(drives.joints, search().approach);
  EXPECT_EQ(move_id(drives), 2.0);
}

TEST(Follow, GoesBackOverThePosturesOfASearchThatWasStopped) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.008);
  std::vector<TickMotion> there;
  for (int i = 0; i < 400; ++i) there.push_back(tick(drives, 100.0, true));
  for (const TickMotion& tick : brake(drives)) there.push_back(tick);
  const TickMotion& last = there.back();
  follow(plant(), drives, {*last.path, last.path_to, 0.0}, 0.02);
  std::size_t i = 0;
  for (const TickMotion& back : run(drives)) {
    EXPECT_LT(on_search_line(back.at(0.5)).off_m, 1e-6);
    EXPECT_LE(tip_speed_m_s(back), 0.02 * (1.0 + kToolSpeedErrorMax));
    ++i;
  }
  EXPECT_GT(i, 100U);
  EXPECT_EQ(drives.joints, search().approach);
}

TEST(Follow, RefusesAPathThatBeginsElsewhere) {
  Drives drives = at_approach();
  EXPECT_THROW(follow(plant(), drives, {{search().search_end, search().approach}}, 0.02), std::logic_error);
}

TEST(Error, ATargetBeyondAJointLimitIsNotTravelledToAndEndsTheQueue) {
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    calib::JointVector beyond = plant().start_joints;
    beyond[joint] = plant().joint_ranges.upper[joint] + 1e-6;
    Drives drives{.joints = plant().start_joints};
    calib::JointVector first = plant().start_joints;
    first[0] += 0.1;
    movej(plant(), drives, first, 0.25);
    movej(plant(), drives, beyond, 0.25);
    movej(plant(), drives, plant().start_joints, 0.25);
    run(drives);
    EXPECT_EQ(drives.error, kImpossibleMoveError);
    EXPECT_EQ(drives.joints, first);
    reset_motion(drives);
    EXPECT_EQ(drives.error, 0);
  }
}

TEST(Error, ALineThroughTheArmsOwnColumnStopsWhereItCanBeFollowedTo) {
  calib::JointVector left = search().approach;
  calib::JointVector right = left;
  left[0] = -1.5;
  right[0] = 1.5;
  Drives drives{.joints = left};
  movel(plant(), drives, right, 0.25);
  movej(plant(), drives, left, 0.25);
  const std::vector<TickMotion> ticks = run(drives);
  EXPECT_EQ(drives.error, kImpossibleMoveError);
  EXPECT_TRUE(drives.queue.empty());
  EXPECT_GT(ticks.size(), 100U);
  EXPECT_TRUE(plant().joint_ranges.contains(drives.joints));
  const Eigen::Vector3d from_m = tip_m(plant().nominal, left);
  const Eigen::Vector3d way_m = tip_m(plant().nominal, right) - from_m;
  const Eigen::Vector3d here_m = tip_m(plant().nominal, drives.joints) - from_m;
  EXPECT_LT(here_m.cross(way_m.normalized()).norm(), 1e-6);
  EXPECT_LT(here_m.dot(way_m), way_m.squaredNorm());
  for (const TickMotion& tick : ticks) {
    ASSERT_TRUE(((tick.to - tick.from).cwiseAbs().array() <=
                 plant().joint_speeds_max.array() * kTickSeconds * (1.0 + 1e-9))
                    .all());
  }
}

TEST(Error, ALineToAnotherBranchOfTheArmDoesNotArrive) {
  calib::JointVector bent;
  bent << 0.0, 0.6, 0.3, 0.2, 0.5, 0.1;
  calib::JointVector turned_wrist = bent;
  turned_wrist[3] += std::numbers::pi;
  turned_wrist[4] = -bent[4];
  turned_wrist[5] += std::numbers::pi;
  Drives drives{.joints = bent};
  movel(plant(), drives, turned_wrist, 0.02);
  run(drives);
  EXPECT_EQ(drives.error, kImpossibleMoveError);
  EXPECT_LT((drives.joints - bent).norm(), 1e-6);
}

}  // namespace
}  // namespace sim
