#include "service/run/compensated_targets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/halton.hpp"
#include "config/truth.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kDemo = kSourceDir / "config/cells/demo";

const Cell& demo() {
  static const Cell cell = read_cell(kDemo / "cell.json");
  return cell;
}

Arm calibrated() {
  Arm arm = demo().arm;
  arm.model = true_model(read_truth(kDemo / "truth-real.json"), arm);
  return arm;
}

calib::JointVector some_joints() {
  return calib::kRadiansPerDegree * (calib::JointVector() << 20.0, 30.0, 60.0, 10.0, 50.0, -20.0).finished();
}

void expect_refused(const Arm& arm, const std::string& pointer, const std::string& part) {
  const ConfigError error = error_of([&] { demand_arm_of(demo(), arm, "arm.json"); });
  EXPECT_EQ(error.source(), "arm.json");
  EXPECT_EQ(error.pointer(), pointer);
  EXPECT_THAT(error.message(), HasSubstr(part));
  EXPECT_THAT(error.message(), HasSubstr("give an arm that was calibrated in this cell"));
}

TEST(CompensatedTargets, AreJointsAndPosesInTheirOrder) {
  const Arm arm = calibrated();
  const calib::CompensationTool tool = tool_named(demo(), arm, "gripper", "t", "");
  const calib::Compensation compensation(
      {.nominal = demo().arm.model, .calibrated = arm.model, .joint_ranges = demo().arm.joint_ranges});
  const Eigen::Isometry3d pose = compensation.nominal_world_from_tool(tool, some_joints());
  const auto results = compensated(
      demo(), arm, tool,
      {{.name = "joints", .wanted = some_joints()},
       {.name = "far", .wanted = PoseTarget{Eigen::Isometry3d(Eigen::Translation3d(9, 0, 0)), some_joints()}},
       {.name = "pose", .wanted = PoseTarget{pose, some_joints()}}});
  ASSERT_EQ(results.size(), 3U);
  ASSERT_TRUE(results[0].joints && results[2].joints);
  EXPECT_TRUE(results[0].joints->isApprox(*results[2].joints, 1e-9));
  EXPECT_EQ(results[1].reason, calib::CompensationReason::kNominalOutOfReach);
  EXPECT_LT(
      (compensation.calibrated_world_from_tool(tool, *results[0].joints).translation() - pose.translation())
          .norm(),
      calib::kCompensationResidualMax);
}

TEST(CompensatedTargets, AreTheSameByAnyNumberOfThreads) {
  const Arm arm = calibrated();
  const calib::CompensationTool tool = tool_named(demo(), arm, "gripper", "t", "");
  std::vector<Target> targets;
  for (int i = 1; i <= 3'500; ++i)
    targets.push_back(
        {.name = std::to_string(i), .wanted = calib::halton_posture(i, demo().arm.joint_ranges)});
  const auto one = compensated(demo(), arm, tool, targets);
  for (const int threads : {2, 3, 64}) {
    const auto many = compensated(demo(), arm, tool, targets, threads);
    ASSERT_EQ(many.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(many[i].status, one[i].status) << i;
      EXPECT_EQ(many[i].joints, one[i].joints) << i;
    }
  }
}

TEST(CompensatedTargets, TheStylusIsTouchedAndAnotherToolIsNot) {
  const Arm arm = calibrated();
  const auto stylus = tool_named(demo(), arm, "stylus", "t", "");
  EXPECT_TRUE(stylus.is_stylus);
  EXPECT_FALSE(stylus.nominal_frame6_from_tool.isApprox(stylus.calibrated_frame6_from_tool));
  const auto gripper = tool_named(demo(), arm, "gripper", "t", "");
  EXPECT_FALSE(gripper.is_stylus);
  EXPECT_TRUE(gripper.nominal_frame6_from_tool.isApprox(demo().tools.at("gripper")));
  EXPECT_TRUE(gripper.calibrated_frame6_from_tool.isApprox(demo().tools.at("gripper")));
  const ConfigError error = error_of([&] { tool_named(demo(), arm, "welder", "t.json", "/tool"); });
  EXPECT_EQ(error.pointer(), "/tool");
  EXPECT_THAT(error.message(), HasSubstr("give one of stylus, gripper"));
}

TEST(CompensatedTargets, TakeACalibrationOfTheCellsArmWhereverItStands) {
  Arm arm = calibrated();
  EXPECT_NO_THROW(demand_arm_of(demo(), arm, "arm.json"));
  arm.model.links[0].r_m += 3.0;
  arm.model.links[1].theta_rad += 1.0;
  arm.model.links[6].theta_rad += 2.0 * std::numbers::pi;
  EXPECT_NO_THROW(demand_arm_of(demo(), arm, "arm.json"));
}

TEST(CompensatedTargets, RefuseAnotherArm) {
  Arm arm = calibrated();
  arm.name = "tx60";
  expect_refused(arm, "/name", "is \"tx60\" but the cell's arm is \"tx90\"");
  arm = calibrated();
  arm.model.gains[3] = -1.0;
  expect_refused(arm, "/frames/4/gain", "is -1 but that of the cell's arm is 1");
  arm = calibrated();
  arm.model.joint_types[1] = calib::JointType::kPrismatic;
  expect_refused(arm, "/frames/2/joint_type", "another");
  arm = calibrated();
  arm.model.links[3].d_m += 0.06;
  expect_refused(arm, "/frames/3", "d is 60.2 mm from");
  arm = calibrated();
  arm.model.links[5].alpha_rad += 0.2;
  expect_refused(arm, "/frames/5", "alpha is 11.5 deg from");
}

TEST(CompensatedTargets, KnowAnArmThatNobodyCalibrated) {
  EXPECT_TRUE(is_uncalibrated(demo(), demo().arm));
  EXPECT_FALSE(is_uncalibrated(demo(), calibrated()));
  Arm moved = demo().arm;
  moved.model.links[0].r_m += 0.01;
  EXPECT_TRUE(is_uncalibrated(demo(), moved));
  Arm yielding = demo().arm;
  yielding.model.compliance_rad_per_nm[2] = 1e-6;
  EXPECT_FALSE(is_uncalibrated(demo(), yielding));
}

TEST(CompensatedTargets, AreNotOfAnotherRobotThanTheCells) {
  Cell cell = edf();
  Arm arm = cell.arm;
  arm.serial = "ONE";
  EXPECT_NO_THROW(demand_serial_of(cell, arm, "arm.json")) << "the cell's is not known";
  cell.arm_serial = "ONE";
  EXPECT_NO_THROW(demand_serial_of(cell, arm, "arm.json"));
  cell.arm_serial = "TWO";
  try {
    demand_serial_of(cell, arm, "arm.json");
    FAIL() << "it is another robot";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.pointer(), "/serial");
    EXPECT_THAT(error.what(), testing::HasSubstr("is \"ONE\", and the cell's file has \"TWO\""));
  }
}

}  // namespace
}  // namespace cell
