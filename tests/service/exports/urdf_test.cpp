// What a reader that is not ours makes of the file: the parser of the robot operating system.
#include "service/exports/urdf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <cstdlib>

#include "tests/service/exports/exported_arms.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Eigen::Isometry3d pose_of(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const urdf::Rotation& turn = pose.rotation;
  result.linear() = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).toRotationMatrix();
  result.translation() << pose.position.x, pose.position.y, pose.position.z;
  return result;
}

/// The pose of a link in the root's frame, by URDF's own rules.
Eigen::Isometry3d pose_in_root(const urdf::ModelInterface& robot, const std::string& name,
                               const calib::JointVector& joints) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (auto link = robot.getLink(name); link->parent_joint; link = link->getParent()) {
    const urdf::Joint& joint = *link->parent_joint;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
    if (joint.type != urdf::Joint::FIXED) {
      const double value = joints[joint.name.back() - '1'];
      if (joint.type == urdf::Joint::REVOLUTE) motion.rotate(Eigen::AngleAxisd(value, axis));
      if (joint.type == urdf::Joint::PRISMATIC) motion.translate(value * axis);
    }
    pose = pose_of(joint.parent_to_joint_origin_transform) * motion * pose;
  }
  return pose;
}

void expect_same_poses(const Arm& arm) {
  const auto robot = urdf::parseURDF(urdf_document(arm, "a test's arm"));
  ASSERT_TRUE(robot);
  EXPECT_EQ(robot->getRoot()->name, "block");
  for (const calib::JointVector& joints : postures(arm)) {
    const Eigen::Isometry3d theirs = pose_in_root(*robot, "stylus", joints);
    const Eigen::Isometry3d ours = calib::forward_kinematics(rigid(arm).model, joints);
    EXPECT_LT((theirs.translation() - ours.translation()).norm(), calib::kPositionErrorMaxMetres);
    EXPECT_LT((theirs.linear() - ours.linear()).norm(), 1e-9);
  }
}

TEST(Urdf, HasThePosesOfEachShippedArmWithErrors) {
  for (const char* name : {"tx90", "tx60", "three-parallel"}) {
    SCOPED_TRACE(name);
    expect_same_poses(calibrated(shipped_arm(name)));
  }
}

TEST(Urdf, HasThePosesOfAnArmThatSlidesAndOfOneThatCountsBackwards) {
  expect_same_poses(sliding(calibrated(shipped_arm("tx90"))));
}

TEST(Urdf, IsTakenByTheCheckerOfItsMakers) {
  const Folder folder;
  const std::string file =
      folder.write("arm.urdf", urdf_document(calibrated(shipped_arm("tx90")), "a test's arm")).string();
  EXPECT_EQ(std::system(("check_urdf '" + file + "' >/dev/null").c_str()), 0);
  const std::string broken = folder.write("broken.urdf", "<robot name=\"x\"/>").string();
  EXPECT_NE(std::system(("check_urdf '" + broken + "' >/dev/null 2>&1").c_str()), 0);
}

TEST(Urdf, HasLimitsAndMassesWithTheirPlaces) {
  const Arm arm = shipped_arm("tx90");
  const auto robot = urdf::parseURDF(urdf_document(arm, "a test's arm"));
  ASSERT_TRUE(robot);
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    const auto limits = robot->getJoint("joint_" + std::to_string(joint + 1))->limits;
    EXPECT_DOUBLE_EQ(limits->lower, arm.joint_ranges.lower[joint]);
    EXPECT_DOUBLE_EQ(limits->upper, arm.joint_ranges.upper[joint]);
    EXPECT_DOUBLE_EQ(limits->velocity, arm.joint_speeds_max[joint]);
  }
  const auto upper_arm = robot->getLink("link_2")->inertial;
  EXPECT_DOUBLE_EQ(upper_arm->mass, 25.0);
  EXPECT_DOUBLE_EQ(upper_arm->origin.position.x, 0.18);
  EXPECT_DOUBLE_EQ(upper_arm->origin.position.z, 0.05);
  EXPECT_FALSE(robot->getLink("link_1")->inertial);
}

TEST(Urdf, SaysWhatItLeavesOut) {
  Arm arm = shipped_arm("tx90");
  EXPECT_THAT(urdf_document(arm, "x"), HasSubstr("nothing: the arm is rigid"));
  arm.model.compliance_rad_per_nm[1] = 1e-6;
  EXPECT_THAT(urdf_document(arm, "x"), HasSubstr("the droop of its joints under gravity."));
  arm.model.harmonics_rad[3] = {1e-5, 0.0};
  EXPECT_THAT(urdf_document(arm, "x"),
              HasSubstr("the droop of its joints under gravity and what its gears do."));
}

TEST(Urdf, TakesAnyName) {
  Arm arm = shipped_arm("tx90");
  arm.name = R"(<"arm" & -- é>)";
  const std::string text = urdf_document(arm, "run 1 -- of ----> a test");
  EXPECT_THAT(text, HasSubstr("run 1 - "));
  const auto robot = urdf::parseURDF(text);
  ASSERT_TRUE(robot);
  EXPECT_EQ(robot->getName(), arm.name);
}

TEST(Urdf, RefusesAGainThatItHasNoPlaceFor) {
  Arm arm = shipped_arm("tx90");
  arm.model.gains[4] = 1.02;
  try {
    urdf_document(arm, "x");
    FAIL();
  } catch (const NotRepresentable& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("joint 5 has the gain 1.02"));
    EXPECT_THAT(refusal.what(), HasSubstr("export the DH tables"));
  }
}

}  // namespace
}  // namespace cell
