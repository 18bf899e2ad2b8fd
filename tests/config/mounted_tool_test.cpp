#include "config/mounted_tool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/read_config.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class MountedTool : public CopiedConfig {
 protected:
  /// Of the cell `demo`.
  static Cell demo() { return read_cell(std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/demo/cell.json"); }
};

TEST_F(MountedTool, ItsTipTouchesInPlaceOfTheProbe) {
  const Cell cell = demo();
  const Cell mounted = with_tool_mounted(cell, "gripper");
  calib::JointVector joints;
  joints << 0.3, -0.4, 1.2, 0.7, 0.9, -1.1;
  const Eigen::Isometry3d tool =
      calib::forward_chain(cell.arm.model, joints).block_from_frame[calib::kJointCount] *
      cell.tools.at("gripper");
  EXPECT_TRUE(calib::forward_kinematics(mounted.arm.model, joints).isApprox(tool, 1e-12));
  EXPECT_EQ(mounted.probe.stylus.radius_m, cell.tool_tips.at("gripper").radius_m);
  EXPECT_EQ(mounted.probe.stylus.pretravel_m, 0.0);
  EXPECT_TRUE(mounted.probe.bodies.empty());
  EXPECT_EQ(mounted.touch_noise_m, cell.tool_tips.at("gripper").noise_m);
}

TEST_F(MountedTool, NothingOfTheProbeIsHiddenAnyMore) {
  Truth truth;
  truth.probe.stylus_radius_m = 0.003;
  truth.probe.lobes_m = 1e-5;
  truth.errors[3] = 1e-3;
  const Truth mounted = with_tip_mounted(truth, {.radius_m = 0.004, .std_radius_m = 0.0, .noise_m = 2e-5});
  EXPECT_FALSE(mounted.probe.stylus_radius_m);
  EXPECT_EQ(mounted.probe.lobes_m, 0.0);
  EXPECT_EQ(mounted.probe.noise_m, 2e-5);
  EXPECT_EQ(mounted.errors[3], 1e-3);
}

TEST_F(MountedTool, AToolThatCannotTouchIsNamedWithThoseThatCan) {
  Cell cell = demo();
  EXPECT_THAT(why_no_tip(cell, "saw"),
              HasSubstr("the cell has no tool \"saw\"; those that can touch are gripper"));
  cell.tool_tips.clear();
  EXPECT_THAT(why_no_tip(cell, "gripper"), HasSubstr("the tool \"gripper\" has no \"tip\"; add one"));
  EXPECT_THROW(with_tool_mounted(cell, "gripper"), std::logic_error);
}

TEST_F(MountedTool, ATipNeedsItsSchemaAndItsFigures) {
  edit(kCell, [](json& cell) {
    cell["schema"] = "touchcal/cell/6";
    cell["tools"]["pin"] = json::parse(
        R"({"position_mm":[0,0,200],"rotation_deg":[0,0,0],"tip":{"radius_mm":0,"std_radius_mm":0.01}})");
  });
  const Cell cell = read();
  EXPECT_EQ(cell.tool_tips.at("pin").radius_m, 0.0);
  EXPECT_DOUBLE_EQ(cell.tool_tips.at("pin").std_radius_m, 1e-5);
  EXPECT_EQ(cell.tool_tips.at("pin").noise_m, cell.touch_noise_m) << "as uncertain as a touch of the probe";
  edit(kCell, [](json& cell) { cell["schema"] = "touchcal/cell/5"; });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/tools/gripper/tip");
  edit(kCell, [](json& cell) {
    cell["schema"] = "touchcal/cell/6";
    cell["tools"]["pin"]["tip"].erase("std_radius_mm");
  });
  const ConfigError missing = error_of([&] { static_cast<void>(read()); });
  EXPECT_EQ(missing.pointer(), "/tools/pin/tip");
  EXPECT_THAT(missing.what(), HasSubstr("std_radius_mm"));
}

}  // namespace
}  // namespace cell
