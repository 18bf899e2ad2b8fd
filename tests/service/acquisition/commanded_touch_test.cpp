#include "service/acquisition/commanded_touch.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(CommandedTouch, ACommandComesBackFromItsTextToTheBit) {
  calib::PlannedTouch touch{
      .face = 3, .role = calib::TouchRole::kHeldOut, .predicted_position_error_m = 1.0 / 3.0};
  touch.joints << 0.1, -0.2, 1.0 / 3.0, 0.4, -0.5, 1e-17;
  touch.clear_joints = touch.joints / 7.0;
  touch.approach_joints = touch.joints / 11.0;
  touch.search_end_joints = touch.joints / 13.0;
  const std::vector<calib::JointVector> way{touch.joints, touch.clear_joints};
  const auto [back, way_back] = command_from_text(command_text(touch, way)).value();
  EXPECT_EQ(way_back, way);
  EXPECT_EQ(back.face, touch.face);
  EXPECT_EQ(back.role, touch.role);
  EXPECT_EQ(back.predicted_position_error_m, touch.predicted_position_error_m);
  EXPECT_EQ(back.joints, touch.joints);
  EXPECT_EQ(back.clear_joints, touch.clear_joints);
  EXPECT_EQ(back.approach_joints, touch.approach_joints);
  EXPECT_EQ(back.search_end_joints, touch.search_end_joints);
}

TEST(CommandedTouch, TextThatIsNoCommandGivesNone) {
  for (const char* text : {"", "{}", "[1]", R"({"face":1,"role":0,"joints_rad":[1]})"})
    EXPECT_FALSE(command_from_text(text)) << text;
}

}  // namespace
}  // namespace cell
