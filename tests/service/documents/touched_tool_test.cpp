#include "service/documents/touched_tool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/documents/tool_document.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

ToolDocument touched_result() {
  ToolDocument document{.arm = "tx90", .tool = "gripper", .of_run = "7", .touch_count = 8, .complete = true};
  document.verdict = {.accepted = true, .reasons = {}};
  document.position_mm = {1.0, 2.0, 250.0};
  document.std_position_mm = {0.03, 0.04, 0.0};
  document.arm_errors = {{.name = "alpha6", .unit = "rad", .error = 0.002},
                         {.name = "d6", .unit = "mm", .error = -0.25}};
  document.world_box_rms_mm = 0.05;
  return document;
}

std::string why_not(const ToolDocument& document, const std::string& of_run = "7") {
  const auto found = touched_tool_of("run 9", document_text(document), of_run);
  const auto* why = std::get_if<std::string>(&found);
  return why ? *why : "";
}

TEST(TouchedTool, ReplacesTheDrawingOnTheCalibratedArmOnly) {
  const auto found = touched_tool_of("run 9", document_text(touched_result()), "7");
  const auto& touched = std::get<TouchedTool>(found);
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

TEST(TouchedTool, OfAnythingElseIsRefusedWithTheRemedy) {
  EXPECT_EQ(why_not(touched_result(), ""), "") << "of any calibration";
  EXPECT_THAT(why_not(touched_result(), "8"), HasSubstr("touchcal tool gripper --of 8"));
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
  const auto proof = touched_tool_of("run 3", document_text(ProofDocument()), "7");
  EXPECT_THAT(std::get<std::string>(proof), HasSubstr("run 3 is no result of touchcal tool"));
  const auto text = touched_tool_of("a.json", "{", "");
  EXPECT_THAT(std::get<std::string>(text), HasSubstr("a.json cannot be read"));
}

}  // namespace
}  // namespace cell
