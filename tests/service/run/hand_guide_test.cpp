#include "service/run/hand_guide.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(HandGuide, NamesAreThoseOfTheApi) {
  EXPECT_EQ(hand_activity_name(HandActivity::kLocate), "locate");
  EXPECT_EQ(hand_activity_name(HandActivity::kGuided), "guided");
  EXPECT_EQ(hand_step_name(HandStep::kTouch), "touch");
  EXPECT_EQ(hand_step_name(HandStep::kUndo), "undo");
  EXPECT_EQ(hand_step_name(HandStep::kPass), "pass");
  EXPECT_EQ(hand_step_name(HandStep::kPassing), "passing");
}

}  // namespace
}  // namespace cell
