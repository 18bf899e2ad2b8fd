#include "calib_core/motion/motion_time.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/calib_core/paper.hpp"

namespace calib {
namespace {

/// Joint 6 turns a tip on its axis: only the joint's own limits count.
class JointSixAlone : public testing::Test {
 protected:
  static PreparedModel model_with_tip_on_axis() {
    KinematicModel model = paper::nominal();
    model.links.back() = {};
    return prepare(model);
  }
  static JointVector turned(double rad) {
    JointVector joints = JointVector::Zero();
    joints[5] = rad;
    return joints;
  }
  double move_s(double rad) const { return move_time_s(model_, limits_, turned(0.0), turned(rad), 0.25); }

  const PreparedModel model_ = model_with_tip_on_axis();
  const MotionLimits limits_{.joint_speeds_max = JointVector::Ones()};
};

TEST_F(JointSixAlone, OfALongMoveReachesItsFullSpeed) {
  EXPECT_NEAR(move_s(1.0), 1.4, 1e-12);  // 1 rad at 1 rad/s, and one ramp of 0.4 s more
}

TEST_F(JointSixAlone, OfAShortMoveOnlySpeedsUpAndSlowsDown) {
  EXPECT_NEAR(move_s(0.1), 0.4, 1e-12);  // 2 sqrt(0.1 rad / 2.5 rad/s^2)
  EXPECT_EQ(move_s(0.0), 0.0);
}

TEST_F(JointSixAlone, StopsAtEachPostureOfAPathAndSettlesAtTheLast) {
  EXPECT_NEAR(path_time_s(model_, limits_, std::array{turned(0.0), turned(1.0), turned(0.9)}),
              1.4 + 0.4 + kSettlingSeconds, 1e-12);
}

TEST(StopDistance, IsLatencyAndRamp) { EXPECT_NEAR(stop_distance_m(0.008), 64e-6 + 64e-6, 1e-18); }

}  // namespace
}  // namespace calib
