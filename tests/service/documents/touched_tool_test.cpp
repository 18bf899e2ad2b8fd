#include "service/documents/touched_tool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/tool_document.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

ToolDocument touched_result() {
  ToolDocument document{.arm = "tx90", .tool = "gripper", .of_run = "1", .touch_count = 8, .complete = true};
  document.verdict = {.accepted = true, .reasons = {}};
  document.drawn_mm = {0.0, 0.0, 249.0};
  document.position_mm = {1.0, 2.0, 250.0};
  document.arm_errors = {{.name = "alpha6", .unit = "rad", .error = 0.002},
                         {.name = "d6", .unit = "mm", .error = -0.25}};
  document.world_box_rms_mm = 0.05;
  return document;
}

TouchedTool touched_of(const ToolDocument& document) {
  return std::get<TouchedTool>(touched_tool_of("run 9", document_text(document)));
}

std::string why_not(const ToolDocument& document) {
  return std::get<std::string>(touched_tool_of("run 9", document_text(document)));
}

Cell cell_with_gripper() {
  Cell cell;
  cell.arm.name = "tx90";
  cell.tools.emplace("gripper", Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.249)));
  return cell;
}

TEST(TouchedTool, ReplacesTheDrawingOnTheCalibratedArmOnly) {
  const TouchedTool touched = touched_of(touched_result());
  EXPECT_EQ(touched.tool, "gripper");
  EXPECT_NEAR(touched.std_m, 50e-6, 1e-12);
  Eigen::Isometry3d pose(Eigen::Translation3d(0.0, 0.0, 0.249));
  pose.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  const calib::CompensationTool tool = as_touched(calib::drawn_tool(pose), touched);
  EXPECT_TRUE(tool.nominal_frame6_from_tool.isApprox(pose));
  EXPECT_TRUE(tool.calibrated_frame6_from_tool.translation().isApprox(Eigen::Vector3d(0.001, 0.002, 0.25)));
  EXPECT_TRUE(tool.calibrated_frame6_from_tool.linear().isApprox(pose.linear()));
  EXPECT_EQ(tool.std_tip_m, touched.std_m);
  calib::KinematicModel arm;
  arm.links[6].alpha_rad = 0.1;
  const calib::KinematicModel with = with_tool(arm, touched);
  EXPECT_DOUBLE_EQ(with.links[6].alpha_rad, 0.102);
  EXPECT_DOUBLE_EQ(with.links[6].d_m, -0.25e-3);
  EXPECT_EQ(with.links[5].alpha_rad, arm.links[5].alpha_rad);
}

TEST(TouchedTool, CountsByTheRunOfThisDaemonAndNotByTheNumberInTheResult) {
  const TouchedTool touched =
      touched_of(touched_result());  // made by a daemon where the calibration was run 1
  EXPECT_EQ(why_other_calibration(touched, "2", "2"), std::nullopt);
  EXPECT_THAT(why_other_calibration(touched, "2", "1").value(), HasSubstr("touchcal tool gripper --of 1"));
  EXPECT_TRUE(why_other_calibration(touched, std::nullopt, "1"));
}

TEST(TouchedTool, OfAnythingElseIsRefusedWithTheRemedy) {
  ToolDocument document = touched_result();
  document.verdict.accepted = false;
  EXPECT_THAT(why_not(document), HasSubstr("did not find the tip of the tool gripper"));
  document.verdict.accepted.reset();
  EXPECT_THAT(why_not(document), HasSubstr("touch it again"));
  document = touched_result();
  document.position_mm.reset();
  EXPECT_THAT(why_not(document), HasSubstr("touch it again"));
  document = touched_result();
  document.arm_errors.front().name = "alpha9";
  EXPECT_THAT(why_not(document), HasSubstr("the arm has no error 'alpha9'"));
  const auto proof = touched_tool_of("run 3", document_text(ProofDocument()));
  EXPECT_THAT(std::get<std::string>(proof), HasSubstr("run 3 is no result of touchcal tool"));
  EXPECT_THROW((void)touched_tool_of("a.json", "{"), DocumentError);
}

TEST(TouchedTool, IsOfTheCellsArmAndOfItsToolOfToday) {
  const auto pointer_of = [](const ToolDocument& document, const Cell& cell = cell_with_gripper()) {
    try {
      demand_tool_of(cell, touched_of(document));
    } catch (const ConfigError& error) {
      return error.pointer();
    }
    return std::string();
  };
  EXPECT_EQ(pointer_of(touched_result()), "");
  ToolDocument document = touched_result();
  document.arm = "tx60";
  EXPECT_EQ(pointer_of(document), "/arm");
  document = touched_result();
  document.tool = "saw";
  EXPECT_EQ(pointer_of(document), "/tool");
  document = touched_result();
  document.drawn_mm[2] = 249.1;
  EXPECT_EQ(pointer_of(document), "/drawn_mm");
  document = touched_result();
  document.position_mm = {500.0, 0.0, 9000.0};
  EXPECT_EQ(pointer_of(document), "/position_mm");
}

}  // namespace
}  // namespace cell
