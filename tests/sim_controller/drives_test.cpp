#include "sim_controller/drives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "drive_runs.hpp"

namespace sim {
namespace {

using namespace testing;

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
  EXPECT_EQ(id, 1.0);
  while (!drives.queue.empty()) {
    const TickMotion motion = tick(drives, 100.0, true);
    EXPECT_GT(move_id(drives), id);
    EXPECT_LT(move_id(drives) - id, 0.2);
    id = move_id(drives);
    if (motion.rate_to == 0.0) stops.push_back(motion.to);
    EXPECT_FALSE(is_settled(drives));
  }
  EXPECT_EQ(stops, (std::vector<calib::JointVector>{search().search_end, search().approach, corner}));
  EXPECT_EQ(id, 4.0);
}

TEST(Queue, HalfWayThroughTheSecondMoveTheIdIsTwoAndAHalf) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.02);
  movel(plant(), drives, search().approach, 0.02);
  while (move_id(drives) < 2.5) tick(drives, 100.0, true);
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
  EXPECT_EQ(move_id(drives), 3.0);
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
