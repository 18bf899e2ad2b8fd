#include "service/setup/park_posture.hpp"

#include <gtest/gtest.h>

#include "tests/service/setup/made_cell.hpp"

namespace cell {
namespace {

TEST(ParkPosture, IsClearWithinTheRangesAndLooksAtTheBlock) {
  for (const char* arm : {"tx90", "three-parallel"}) {
    SetupAnswers answers;
    answers.base = BasePlace{{-600.0, -150.0, 0.0}, {90.0, 0.0, 0.0}};
    const Cell scene = setup_scene(answers, arm_to_set_up(arm));
    EXPECT_TRUE(scene.arm.joint_ranges.contains(scene.park_joints)) << arm;
    EXPECT_FALSE(park_clash(scene)) << arm;
    const Eigen::Isometry3d ball = calib::forward_kinematics(scene.arm.model, scene.park_joints);
    EXPECT_LT(ball.translation().y(), -0.15) << arm << ": over the block";
    EXPECT_GT(ball.linear()(1, 2), 0.5) << arm << ": the stylus points down";
  }
}

TEST(ParkPosture, OfTheSameSceneIsTheSame) {
  SetupAnswers answers;
  answers.base = BasePlace{{-600.0, -150.0, 0.0}, {90.0, 0.0, 0.0}};
  const SetupArm arm = arm_to_set_up("three-parallel");
  EXPECT_EQ(setup_scene(answers, arm).park_joints, setup_scene(answers, arm).park_joints);
}

TEST(ParkPosture, ReachIsTheSumOfTheLengths) {
  EXPECT_NEAR(reach_of(arm_to_set_up("tx90").arm.model), 0.05 + std::hypot(0.425, 0.05) + 0.425 + 0.3189,
              1e-12);
}

}  // namespace
}  // namespace cell
