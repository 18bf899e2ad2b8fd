#include "service/setup/urdf_arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <random>

#include "config/arm_file.hpp"
#include "config/arm_writer.hpp"
#include "config/config_error.hpp"
#include "service/exports/urdf.hpp"
#include "tests/service/exports/exported_arms.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Axes of all kinds, frames that are turned, fixed joints between, a branch, a mesh; no two lengths alike.
const std::string kOddRobot = R"(<?xml version="1.0"?>
<robot name="odd">
  <link name="world"/><link name="plate"/><link name="a"/><link name="b"/><link name="c"/><link name="flange"/>
  <link name="camera"/><link name="tool0"/><link name="e"/>
  <link name="l1"><inertial><origin xyz="0 0.01 0.1" rpy="0 0 1"/><mass value="8"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="adapter"><inertial><origin xyz="0.02 0 0"/><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="mount" type="fixed"><origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/><parent link="world"/><child link="plate"/></joint>
  <joint name="turn" type="continuous"><origin xyz="0 0 0.2" rpy="0 0 0.3"/><axis xyz="0 0 1"/><parent link="plate"/><child link="l1"/><limit effort="1" velocity="2.5"/></joint>
  <joint name="bolt" type="fixed"><origin xyz="0.01 0.02 0.03" rpy="1.57079 0 0"/><parent link="l1"/><child link="adapter"/></joint>
  <joint name="lift" type="revolute"><origin xyz="0.05 0.1 0.25" rpy="-1.1 0.2 0"/><axis xyz="0 1 0"/><limit lower="-1.5" upper="2" effort="1" velocity="3"/><parent link="adapter"/><child link="a"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="0 0.02 0.45" rpy="0 0 0"/><axis xyz="0 -2 0"/><limit lower="-2" upper="2.5" effort="1" velocity="3"/><parent link="a"/><child link="b"/></joint>
  <joint name="roll" type="revolute"><origin xyz="0.1 0 0.2" rpy="0 1.5707963 0"/><axis xyz="1 1 1"/><limit lower="-3" upper="3" effort="1" velocity="0"/><parent link="b"/><child link="c"/></joint>
  <joint name="bend" type="revolute"><origin xyz="0.2 0 0.1"/><limit lower="-2" upper="2" effort="1" velocity="4"/><parent link="c"/><child link="e"/></joint>
  <joint name="spin" type="revolute"><origin xyz="0.06 0.03 0" rpy="0.1 0.2 0.3"/><axis xyz="0.3 -0.1 0.9"/><limit lower="-3" upper="3.1" effort="1" velocity="5"/><parent link="e"/><child link="flange"/></joint>
  <joint name="look" type="fixed"><parent link="flange"/><child link="camera"/></joint>
  <joint name="hold" type="fixed"><origin xyz="0.02 0.01 0.08" rpy="0.5 0 1"/><parent link="flange"/><child link="tool0"/></joint>
</robot>)";

/// By the parser of the robot operating system and URDF's own rules.
Eigen::Isometry3d pose_of_link(const urdf::ModelInterface& robot, const std::string& base,
                               const std::string& tip, const calib::JointVector& joints) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Index turning = calib::kJointCount;
  for (auto link = robot.getLink(tip); link->name != base; link = link->getParent()) {
    const urdf::Joint& joint = *link->parent_joint;
    const urdf::Pose& origin = joint.parent_to_joint_origin_transform;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    if (joint.type != urdf::Joint::FIXED)
      motion.rotate(Eigen::AngleAxisd(
          joints[--turning], Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z).normalized()));
    pose = Eigen::Translation3d(origin.position.x, origin.position.y, origin.position.z) *
           Eigen::Quaterniond(origin.rotation.w, origin.rotation.x, origin.rotation.y, origin.rotation.z) *
           motion * pose;
  }
  return pose;
}

void expect_same_poses_as(const std::string& text, const std::string& base, const std::string& tip) {
  const auto robot = urdf::parseURDF(text);
  ASSERT_TRUE(robot);
  const MadeArm made = arm_of_urdf("test", text, base, tip);
  // As the program that reads the arm's file has it.
  const Arm read = read_arm_text("made", arm_document(made.arm));
  for (const calib::JointVector& joints : postures(made.arm)) {
    const Eigen::Isometry3d theirs = pose_of_link(*robot, base, tip, joints);
    const Eigen::Isometry3d ours = calib::forward_kinematics(rigid(read).model, joints);
    EXPECT_LT((theirs.translation() - ours.translation()).norm(), calib::kPositionErrorMaxMetres);
    EXPECT_LT((theirs.linear() - ours.linear()).norm(), 1e-9);
  }
}

TEST(UrdfArm, HasThePosesOfAnOddRobotWithTurnedFramesAndAnyAxes) {
  expect_same_poses_as(kOddRobot, "world", "tool0");
  expect_same_poses_as(kOddRobot, "plate", "flange");
}

TEST(UrdfArm, HasThePosesOfEachShippedArmExportedAndReadBack) {
  for (const char* name : {"tx90", "tx60", "three-parallel"}) {
    SCOPED_TRACE(name);
    expect_same_poses_as(urdf_document(shipped_arm(name), "a test's arm"), "block", "stylus");
    expect_same_poses_as(urdf_document(calibrated(shipped_arm(name)), "a test's arm"), "block", "stylus");
  }
  Arm backwards = shipped_arm("tx90");
  backwards.model.gains[4] = -1.0;
  expect_same_poses_as(urdf_document(backwards, "counts backwards"), "block", "stylus");
}

TEST(UrdfArm, TakesRangesSpeedsAndMassesAndTellsWhatItAssumed) {
  const MadeArm made = arm_of_urdf("odd.urdf", kOddRobot, "world", "tool0");
  EXPECT_EQ(made.arm.name, "odd");
  EXPECT_EQ(made.arm.joint_ranges.lower[1], -1.5);
  EXPECT_EQ(made.arm.joint_ranges.upper[5], 3.1);
  EXPECT_EQ(made.arm.joint_speeds_max[0], 2.5);
  const calib::PointMass& mass = made.arm.model.masses[1];
  EXPECT_DOUBLE_EQ(mass.mass_kg, 10.0) << "what is bolted to a link weighs with it";
  EXPECT_THAT(made.remarks, ::testing::Contains(HasSubstr("joint turn has no range")));
  EXPECT_THAT(made.remarks, ::testing::Contains(HasSubstr("joint roll has no speed")));
  // Of 8 and 2 kg, in the base, by hand.
  const auto robot = urdf::parseURDF(kOddRobot);
  const calib::JointVector zero = calib::JointVector::Zero();
  const Eigen::Vector3d center =
      0.8 * (pose_of_link(*robot, "world", "l1", zero) * Eigen::Vector3d(0.0, 0.01, 0.1)) +
      0.2 * (pose_of_link(*robot, "world", "adapter", zero) * Eigen::Vector3d(0.02, 0.0, 0.0));
  EXPECT_LT((calib::forward_chain(made.arm.model, zero).block_from_frame[1] * mass.center_in_frame_m - center)
                .norm(),
            1e-12);
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refusal_of(const std::string& text, const std::string& base = "world",
                       const std::string& tip = "tool0") {
  return error_of([&] { arm_of_urdf("odd.urdf", text, base, tip); }).what();
}

TEST(UrdfArm, RefusesWhatIsNoArmAndNamesTheJoint) {
  EXPECT_THAT(
      refusal_of(with(kOddRobot, R"(name="elbow" type="revolute")", R"(name="elbow" type="prismatic")")),
      AllOf(HasSubstr("joint[elbow]"), HasSubstr("prismatic"), HasSubstr("six revolute")));
  EXPECT_THAT(
      refusal_of(with(kOddRobot, R"(<axis xyz="0 -2 0"/>)", R"(<axis xyz="0 -2 0"/><mimic joint="lift"/>)")),
      AllOf(HasSubstr("joint[elbow]"), HasSubstr("mimics")));
  EXPECT_THAT(refusal_of(with(kOddRobot, R"(name="elbow" type="revolute")", R"(name="elbow" type="fixed")")),
              AllOf(HasSubstr("has 5 revolute joints"), HasSubstr("turn, lift, roll")));
  EXPECT_THAT(refusal_of(kOddRobot, "world", "nose"), HasSubstr("no link \"nose\"; its links are world"));
  EXPECT_THAT(refusal_of(kOddRobot, "camera", "tool0"), HasSubstr("the chain ends at \"world\""));
  EXPECT_THAT(refusal_of(with(kOddRobot, "0.1 -0.2 0.3", "0.1 nan 0.3")),
              AllOf(HasSubstr("joint[mount]"), HasSubstr("finite")));
  EXPECT_THAT(refusal_of(with(kOddRobot, "0.1 -0.2 0.3", "0.1 -0.2")), HasSubstr("has 2 numbers; give 3"));
  EXPECT_THAT(refusal_of(with(kOddRobot, "0 -2 0", "0 0 0")), HasSubstr("axis without a length"));
  EXPECT_THAT(refusal_of(with(kOddRobot, R"(lower="-1.5")", R"(lower="2")")), HasSubstr("lower limit"));
}

TEST(UrdfArm, RefusesARobotInMillimetresAndNamesTheUnit) {
  EXPECT_THAT(refusal_of(with(kOddRobot, R"(xyz="0 0.02 0.45")", R"(xyz="0 20 450")")),
              AllOf(HasSubstr("is the unit another one?"), HasSubstr("URDF are metres")));
}

TEST(UrdfArm, RefusesFilesThatAreNone) {
  EXPECT_THAT(refusal_of("<robot><link"), HasSubstr("is no XML"));
  EXPECT_THAT(refusal_of("<sdf/>"), HasSubstr("has no <robot>"));
  EXPECT_THAT(refusal_of(R"(<robot xmlns:xacro="x"><xacro:include filename="a"/></robot>)"),
              HasSubstr("expand it first"));
  EXPECT_THAT(refusal_of(std::string(kUrdfSizeMax + 1, ' ')), HasSubstr("larger than 4 MB"));
  EXPECT_THAT(refusal_of(with(kOddRobot, R"(<child link="camera"/>)", R"(<child link="tool0"/>)")),
              HasSubstr("two joints"));
  // A ring has no end.
  EXPECT_THAT(
      refusal_of(
          R"(<robot><link name="world"/><link name="tool0"/><link name="a"/><joint name="x" type="fixed"><parent link="a"/><child link="tool0"/></joint><joint name="y" type="fixed"><parent link="tool0"/><child link="a"/></joint></robot>)"),
      HasSubstr("does not hang on"));
}

}  // namespace
}  // namespace cell
