// What a VAL3 program stores: descriptors, lines and arcs of a tool, errors, stops, connection moves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drive_runs.hpp"

namespace sim {
namespace {

using namespace testing;

/// Joint 6 turned from one end to the other: its nominal speed alone limits it.
Stretch turn_of_joint_6(double rad) {
  calib::JointVector from = plant().start_joints;
  from[5] = -rad / 2.0;
  calib::JointVector to = from;
  to[5] = rad / 2.0;
  return {{from, to}};
}

Drives with(const Stretch& stretch, const MotionDescriptor& how) {
  Drives drives{.joints = stretch.at(0.0)};
  store(drives, plan_move(plant(), stretch, how));
  return drives;
}

/// The tool's centre behind a tool, in R_-1.
Eigen::Vector3d tool_m(const calib::JointVector& joints, const Eigen::Isometry3d& tip_from_tool) {
  return (calib::forward_kinematics(plant().nominal, joints) * tip_from_tool).translation();
}

Eigen::Isometry3d some_tool() {
  Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
  tool.translation() = Eigen::Vector3d(0.05, -0.03, 0.08);
  tool.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()));
  return tool;
}

TEST(MotionDescriptor, SharesScaleSpeedAccelerationAndDecelerationByThemselves) {
  const double turn_rad = 6.0;
  const double nominal = plant().joint_speeds_max[5];
  const MotionDescriptor how{
      .joint_speed_share = 0.4, .joint_acceleration_share = 0.5, .joint_deceleration_share = 2.0};
  Drives drives = with(turn_of_joint_6(turn_rad), how);
  const double top = 0.4 * nominal;
  const double up_s = top / (0.5 * nominal / kJointRampSeconds);
  const double down_s = top / (2.0 * nominal / kJointRampSeconds);
  const double expected_s = turn_rad / top + up_s / 2.0 + down_s / 2.0;
  EXPECT_NEAR(duration_s(run(drives)), expected_s, kTwoTicksSeconds);
}

TEST(MotionDescriptor, TheTurnsCapSlowsAWristThatTurnsOnTheSpot) {
  Drives drives = with(turn_of_joint_6(4.0), {.turn_speed_rad_s = 0.5});
  const double ramp_s = 0.5 / (plant().joint_speeds_max[5] / kJointRampSeconds);
  const double bound = 1.002;  // the cap is kept by a bound on the turn, which is this near
  const double duration = duration_s(run(drives));
  EXPECT_GE(duration, 4.0 / 0.5 + ramp_s - kTwoTicksSeconds);
  EXPECT_LE(duration, bound * 4.0 / 0.5 + ramp_s + kTwoTicksSeconds);
}

TEST(MotionDescriptor, TheTipsCapIsThatOfTheToolThatIsGiven) {
  const Eigen::Isometry3d tool = some_tool();
  const Stretch stretch = turn_of_joint_6(3.0);
  const auto fastest_m_s = [&](const Eigen::Isometry3d& planned_with) {
    Drives drives{.joints = stretch.at(0.0)};
    store(drives, plan_move(plant(), stretch, {.tip_speed_m_s = 0.02}, planned_with));
    double fastest = 0.0;
    for (const TickMotion& tick : run(drives))
      fastest = std::max(fastest, (tool_m(tick.to, tool) - tool_m(tick.from, tool)).norm() / kTickSeconds);
    return fastest;
  };
  EXPECT_NEAR(fastest_m_s(tool), 0.02, 2e-4);
  EXPECT_GT(fastest_m_s(Eigen::Isometry3d::Identity()), 0.1);
}

TEST(MotionDescriptor, AStopSlowsDownWithTheMovesOwnDeceleration) {
  Drives drives = with(turn_of_joint_6(6.0), {.joint_speed_share = 0.5, .joint_deceleration_share = 0.25});
  for (int i = 0; i < 100; ++i) tick(drives, 100.0, true);
  stop_move(drives);
  int ticks = 0;
  for (; drives.rate > 0.0 && ticks < kTicksMax; ++ticks) tick(drives, 100.0, true);
  EXPECT_NEAR(ticks * kTickSeconds, 0.5 * kJointRampSeconds / 0.25, kTwoTicksSeconds);
}

TEST(ToolPath, OfAToolsLineIsStraightForTheToolAndNotForTheTip) {
  const Eigen::Isometry3d tool = some_tool();
  const calib::JointVector from = search().approach;
  Eigen::Isometry3d target = calib::forward_kinematics(plant().nominal, from) * tool;
  const Eigen::Vector3d start_m = target.translation();
  target.translate(Eigen::Vector3d(0.06, 0.02, -0.04));
  target.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  const ToolPath line = line_to_pose(plant(), from, target, tool);
  ASSERT_TRUE(line.complete);
  const Eigen::Vector3d way = (target.translation() - start_m).normalized();
  double tip_off_m = 0.0;
  for (int i = 0; i <= 200; ++i) {
    const calib::JointVector here = posture(line.path, i / 200.0);
    EXPECT_LT((tool_m(here, tool) - start_m).cross(way).norm(), 1e-6);
    tip_off_m =
        std::max(tip_off_m, (tip_m(plant().nominal, here) - tip_m(plant().nominal, from)).cross(way).norm());
  }
  EXPECT_GT(tip_off_m, 1e-3);
  const Eigen::Isometry3d end = calib::forward_kinematics(plant().nominal, line.path.back()) * tool;
  EXPECT_TRUE(end.isApprox(target, 1e-8));
}

TEST(ToolPath, OfATurnOnTheSpotKeepsTheToolsCentre) {
  const calib::JointVector from = search().approach;
  Eigen::Isometry3d target = calib::forward_kinematics(plant().nominal, from);
  const Eigen::Vector3d start_m = target.translation();
  target.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 1, 0).normalized()));
  const ToolPath line = line_to_pose(plant(), from, target);
  ASSERT_TRUE(line.complete);
  for (int i = 0; i <= 100; ++i)
    EXPECT_LT((tip_m(plant().nominal, posture(line.path, i / 100.0)) - start_m).norm(), 1e-6);
}

/// An arc in the horizontal plane over the approach posture, so many radians to the via point and to the end.
ToolPath arc(double radius_m, double via_rad, double end_rad) {
  const Eigen::Isometry3d start = calib::forward_kinematics(plant().nominal, search().approach);
  const auto at = [&](double rad) {
    Eigen::Isometry3d pose = start;
    pose.translation() += Eigen::Vector3d(radius_m * (std::cos(rad) - 1.0), radius_m * std::sin(rad), 0.0);
    return pose;
  };
  return arc_to_pose(plant(), search().approach, at(via_rad), at(end_rad));
}

TEST(ToolPath, OfAnArcKeepsItsRadiusAndPassesTheViaPoint) {
  const double radius_m = 0.03;
  const ToolPath way = arc(radius_m, 1.0, 2.5);
  ASSERT_TRUE(way.complete);
  EXPECT_NEAR(way.length_m, 2.5 * radius_m, 1e-9);
  const Eigen::Vector3d start_m = tip_m(plant().nominal, search().approach);
  const Eigen::Vector3d centre_m = start_m - Eigen::Vector3d(radius_m, 0.0, 0.0);
  const auto at = [&](double rad) -> Eigen::Vector3d {
    return centre_m + radius_m * Eigen::Vector3d(std::cos(rad), std::sin(rad), 0.0);
  };
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Vector3d here_m = tip_m(plant().nominal, posture(way.path, i / 100.0));
    EXPECT_LT((here_m - at(2.5 * i / 100.0)).norm(), 2e-6);
  }
}

TEST(ToolPath, OfAnArcThatIsNoneHasNoWay) {
  const double half = std::numbers::pi;
  for (const auto& [radius_m, via, end] : {std::tuple{0.03, half, 4.0}, std::tuple{0.03, 1.0, 1.0 + half},
                                           std::tuple{0.03, 0.0, 1.0}, std::tuple{0.0, 1.0, 2.0}}) {
    const ToolPath way = arc(radius_m, via, end);
    EXPECT_FALSE(way.complete) << via << ' ' << end;
    EXPECT_EQ(way.path.front(), way.path.back());
  }
}

TEST(StoredMove, ThatIsImpossibleFailsWhenItsTurnComesAndUntilAReset) {
  Drives drives = at_approach();
  store(drives, plan_move(plant(), {{search().approach, plant().start_joints}}, at_tip_speed(0.25)));
  store(drives, impossible_move(end_of_queue(drives)));
  store(drives, impossible_move(end_of_queue(drives)));
  while (drives.joints != plant().start_joints) {
    EXPECT_EQ(drives.error, 0);
    tick(drives, 100.0, true);
  }
  EXPECT_EQ(drives.error, 0);
  tick(drives, 100.0, true);
  EXPECT_EQ(drives.error, kImpossibleMoveError);
  EXPECT_TRUE(is_empty(drives));
  EXPECT_EQ(drives.joints, plant().start_joints);
  for (int i = 0; i < 10; ++i) tick(drives, 100.0, true);
  EXPECT_EQ(drives.error, kImpossibleMoveError);
  reset_motion(drives);
  EXPECT_EQ(drives.error, 0);
}

TEST(StoredMove, ThatIsImpossibleWaitsForPermission) {
  Drives drives = at_approach();
  store(drives, impossible_move(drives.joints));
  for (int i = 0; i < 10; ++i) tick(drives, 100.0, false);
  EXPECT_EQ(drives.error, 0);
  tick(drives, 100.0, true);
  EXPECT_EQ(drives.error, kImpossibleMoveError);
}

TEST(StoredMove, BehindAResetBeginsWhereTheArmWillStand) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.1);
  for (int i = 0; i < 50; ++i) tick(drives, 100.0, true);
  reset_motion(drives);
  const calib::JointVector stand = end_of_queue(drives);
  EXPECT_EQ(store(drives, plan_move(plant(), {{stand, search().approach}}, at_tip_speed(0.1))), 1.0);
  EXPECT_FALSE(is_empty(drives));
  int ticks = 0;
  for (; drives.braking && ticks < kTicksMax; ++ticks) tick(drives, 100.0, true);
  EXPECT_GT(ticks, 1);
  EXPECT_EQ(drives.joints, stand);
  EXPECT_FALSE(is_connecting(drives));
  run(drives);
  EXPECT_EQ(drives.joints, search().approach);
}

TEST(MoveId, CountsFromOneAndTakesTheNumberThatIsSet) {
  Drives drives = at_approach();
  EXPECT_EQ(move_id(drives), 0.0);
  const Stretch there{{search().approach, plant().start_joints}};
  EXPECT_EQ(store(drives, plan_move(plant(), there, at_tip_speed(0.25))), 1.0);
  EXPECT_EQ(move_id(drives), 1.0);
  set_move_id(drives, 1000.0);
  EXPECT_EQ(move_id(drives), 1.0);
  EXPECT_EQ(store(drives, plan_move(plant(), {there.path, 1.0, 0.0}, at_tip_speed(0.25))), 1001.0);
  while (move_id(drives) < 1.5) tick(drives, 100.0, true);
  while (move_id(drives) < 2.0) tick(drives, 100.0, true);
  EXPECT_EQ(std::floor(move_id(drives)), 1001.0);
  run(drives);
  EXPECT_EQ(move_id(drives), 1002.0);
  reset_motion(drives);
  EXPECT_EQ(move_id(drives), 0.0);
}

TEST(StopMove, KeepsTheQueueUntilTheRestartOrAReset) {
  for (const bool by_reset : {false, true}) {
    Drives drives = at_approach();
    movel(plant(), drives, search().search_end, 0.05);
    for (int i = 0; i < 60; ++i) tick(drives, 100.0, true);
    stop_move(drives);
    for (int i = 0; i < 200; ++i) tick(drives, 100.0, true);
    EXPECT_TRUE(is_settled(drives));
    EXPECT_FALSE(is_empty(drives));
    EXPECT_GT(search_length_m() - on_search_line(drives.joints).along_m, 0.01);
    if (by_reset) {
      reset_motion(drives);
      movel(plant(), drives, search().search_end, 0.05);
    } else {
      restart_move(drives);
    }
    run(drives);
    EXPECT_EQ(drives.joints, search().search_end);
  }
}

/// A line that was left half way, by an arm that now stands elsewhere.
Drives displaced(double rad) {
  Drives drives = at_approach();
  movel(plant(), drives, search().search_end, 0.05);
  for (int i = 0; i < 60; ++i) tick(drives, 100.0, true);
  while (drives.rate > 0.0) tick(drives, 100.0, false);
  calib::JointVector elsewhere = drives.joints;
  elsewhere[0] += rad;
  displace(drives, elsewhere);
  return drives;
}

TEST(ConnectionMove, GoesBackToWhereThePathWasLeftAndOnFromThere) {
  for (const double rad : {0.5 * kDriftRadians, 0.3}) {
    Drives drives = displaced(rad);
    drives.auto_connect = rad > kDriftRadians;
    EXPECT_TRUE(is_connecting(drives));
    const double id = move_id(drives);
    const calib::JointVector left = posture(*drives.queue.front().path, drives.progress);
    while (drives.joints != left && !drives.queue.empty()) {
      tick(drives, 100.0, true);
      if (drives.joints != left) {
        EXPECT_EQ(move_id(drives), id);
      }
    }
    EXPECT_FALSE(is_connecting(drives));
    for (const TickMotion& tick : run(drives)) EXPECT_LT(on_search_line(tick.to).off_m, 1e-6);
    EXPECT_EQ(drives.joints, search().search_end);
    EXPECT_EQ(move_id(drives), id < 2.0 ? 2.0 : 0.0);
  }
}

TEST(ConnectionMove, FromFarAwayWaitsUntilSomebodyAgrees) {
  Drives drives = displaced(0.3);
  const calib::JointVector there = drives.joints;
  for (int i = 0; i < 100; ++i) tick(drives, 100.0, true);
  EXPECT_EQ(drives.joints, there);
  EXPECT_TRUE(is_connecting(drives));
  drives.connect_agreed = true;
  run(drives);
  EXPECT_EQ(drives.joints, search().search_end);
}

TEST(ConnectionMove, IsPlannedAgainForAnArmThatIsDisplacedOnIt) {
  Drives drives = displaced(0.3);
  drives.auto_connect = true;
  for (int i = 0; i < 50; ++i) tick(drives, 100.0, true);
  while (drives.rate > 0.0) tick(drives, 100.0, false);
  calib::JointVector elsewhere = drives.joints;
  elsewhere[1] -= 0.1;
  displace(drives, elsewhere);
  run(drives);
  EXPECT_EQ(drives.joints, search().search_end);
}

TEST(ConnectionMove, GoesToTheStartThatAResetNames) {
  Drives drives = at_approach();
  reset_motion(drives, plant().start_joints);
  EXPECT_EQ(end_of_queue(drives), plant().start_joints);
  calib::JointVector target = plant().start_joints;
  target[0] += 0.1;
  store(drives, plan_move(plant(), {{plant().start_joints, target}}, at_tip_speed(0.25)));
  drives.auto_connect = true;
  bool passed_start = false;
  for (const TickMotion& tick : run(drives)) passed_start = passed_start || tick.to == plant().start_joints;
  EXPECT_TRUE(passed_start);
  EXPECT_EQ(drives.joints, target);
}

}  // namespace
}  // namespace sim
