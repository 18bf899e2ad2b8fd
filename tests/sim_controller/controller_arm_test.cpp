// The nominal arm in VAL3's conventions; poses from the maker's own list of frames (add-on manual, page 29).
#include "sim_controller/controller_arm.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "drive_runs.hpp"
#include "sim_controller/val3_units.hpp"

namespace sim {
namespace {

using namespace testing;

const ControllerArm& arm() {
  static const ControllerArm arm(plant(), 0.1);
  return arm;
}

Eigen::Vector3d flange_mm(const val3::Joint& joints_deg) {
  return arm().world_from_flange(joints_from_val3(joints_deg)).translation() * 1e3;
}

TEST(ControllerArm, StandsWhereTheMakersFramesPutTheFlangeOfATx90) {
  EXPECT_LT((flange_mm({}) - Eigen::Vector3d(50, 50, 950)).norm(), 1e-9);
  EXPECT_LT((flange_mm({0, 0, 0, 0, 90, 0}) - Eigen::Vector3d(150, 50, 850)).norm(), 1e-9);
  EXPECT_LT((flange_mm({0, 90, 0, 0, 0, 0}) - Eigen::Vector3d(1000, 50, 0)).norm(), 1e-9);
}

TEST(ControllerArm, ItsWorldAndFlangeAreThoseOfTheDrivesModel) {
  std::mt19937_64 chance(3);
  for (int i = 0; i < 50; ++i) {
    const calib::JointVector joints = random_joints(chance);
    const Eigen::Isometry3d by_drives =
        calib::forward_kinematics(plant().nominal, joints) * arm().tip_from_flange();
    EXPECT_TRUE(by_drives.isApprox(arm().block_from_world() * arm().world_from_flange(joints), 1e-9));
  }
}

TEST(ControllerArm, FindsAPostureAgainWithAnyTurnsItHas) {
  std::mt19937_64 chance(4);
  for (int i = 0; i < 300; ++i) {
    const calib::JointVector joints = random_joints(chance);
    const auto found = arm().solve(arm().world_from_flange(joints), {}, joints);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - joints).cwiseAbs().maxCoeff(), 1e-6) << joints.transpose();
  }
}

TEST(ControllerArm, SolvesIntoTheConfigurationThatIsDemanded) {
  const calib::JointVector near = joints_from_val3({10, 30, 70, 20, 40, 10});
  const Eigen::Isometry3d pose = arm().world_from_flange(near);
  EXPECT_EQ(arm().config_of(near),
            (val3::Config{val3::Shoulder::kLefty, val3::Elbow::kPositive, val3::Wrist::kPositive}));
  int found = 0;
  for (const auto shoulder : {val3::Shoulder::kLefty, val3::Shoulder::kRighty}) {
    for (const auto elbow : {val3::Elbow::kPositive, val3::Elbow::kNegative}) {
      for (const auto wrist : {val3::Wrist::kPositive, val3::Wrist::kNegative}) {
        const val3::Config demanded{shoulder, elbow, wrist};
        const auto joints = arm().solve(pose, demanded, near);
        if (!joints) continue;
        ++found;
        EXPECT_EQ(arm().config_of(*joints), demanded);
        EXPECT_TRUE(arm().world_from_flange(*joints).isApprox(pose, 1e-8));
        EXPECT_TRUE(arm().in_range(*joints));
      }
    }
  }
  EXPECT_GE(found, 4);
  // Free takes the nearest of them.
  const auto free = arm().solve(pose, {val3::Shoulder::kFree, val3::Elbow::kFree, val3::Wrist::kFree}, near);
  ASSERT_TRUE(free);
  EXPECT_LT((*free - near).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(ControllerArm, HasNothingForAPoseOutOfReachOrRange) {
  Eigen::Isometry3d far = arm().world_from_flange(plant().start_joints);
  far.translation().x() += 2.0;
  EXPECT_FALSE(arm().solve(far, {}, plant().start_joints));
  calib::JointVector limit = plant().start_joints;
  limit[1] = plant().joint_ranges.upper[1];
  EXPECT_TRUE(arm().in_range(limit));
  EXPECT_TRUE(arm().solve(arm().world_from_flange(limit), {}, limit));
  limit[1] += 1e-3;
  EXPECT_FALSE(arm().in_range(limit));
  EXPECT_FALSE(arm().solve(arm().world_from_flange(limit), {}, limit));
}

TEST(Val3Units, APoseComesBackAlsoFromAQuarterTurnAboutY) {
  for (const val3::Trsf& t : {val3::Trsf{1, 2, 3, 10, 20, 30}, val3::Trsf{0, 0, 0, -170, 80, 120},
                              val3::Trsf{0, 0, 0, 0, 90, 25}, val3::Trsf{0, 0, 0, 0, -90, -140}}) {
    const val3::Trsf again = val3_from_pose(pose_from_val3(t));
    EXPECT_NEAR(again.x, t.x, 1e-9);
    EXPECT_NEAR(again.y, t.y, 1e-9);
    EXPECT_NEAR(again.z, t.z, 1e-9);
    EXPECT_NEAR(again.rx, t.rx, 1e-6);
    EXPECT_NEAR(again.ry, t.ry, 1e-6);
    EXPECT_NEAR(again.rz, t.rz, 1e-6);
  }
  // Turned about x behind a quarter turn about y: all of it is rz.
  EXPECT_EQ(val3_from_pose(pose_from_val3({.rx = 40, .ry = 90})).rx, 0.0);
}

}  // namespace
}  // namespace sim
