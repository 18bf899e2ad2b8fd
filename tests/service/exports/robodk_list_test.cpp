#include "service/exports/robodk_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "config/targets_file.hpp"

namespace cell {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string list_of_one() {
  return robodk_list({{.name = "Target 1",
                       .world_from_tool = {450.0, -120.1234567, 300.0, 180.0, 0.0, 90.0},
                       .joints_deg = {15.0, 40.0, 80.0, 0.0, 60.0, -1e-7}}},
                     {"of the cell demo", "refused: a\nName, X"});
}

TEST(RobodkList, SaysUnitsFrameAndSignsBeforeItsHeader) {
  const std::string text = list_of_one();
  EXPECT_THAT(text, StartsWith("# of the cell demo\n# refused: a Name, X\n# X Y Z: mm; Rx Ry Rz: degrees"));
  EXPECT_THAT(text, HasSubstr("controller's world"));
  EXPECT_THAT(text,
              EndsWith("controller counts them; they say the configuration\n"
                       "Name, X, Y, Z, Rx, Ry, Rz, J1, J2, J3, J4, J5, J6\n"
                       "Target 1, 450.000000, -120.123457, 300.000000, 180.000000, 0.000000, 90.000000, "
                       "15.000000, 40.000000, 80.000000, 0.000000, 60.000000, -0.000000\n"));
}

TEST(RobodkList, IsReadAsTargets) {
  const TargetsFile file = targets_from_robodk("list.csv", list_of_one());
  ASSERT_EQ(file.targets.size(), 1U);
  const auto& pose = std::get<PoseTarget>(file.targets[0].wanted);
  EXPECT_NEAR(pose.world_from_tool.translation().y(), -0.1201234567, 1e-9);
  EXPECT_DOUBLE_EQ(pose.near_joints[1], calib::radians_from_degrees(40.0));
}

}  // namespace
}  // namespace cell
