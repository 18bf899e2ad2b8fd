#include "calib_core/qualification/turned_touches.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

const std::vector<ContactSurface> kSurfaces(2, {Eigen::Vector3d::UnitX(), 0.0});
constexpr double kQuarterTurn = 1.5707963267948966;

Touch turned_by(double joint_6_rad, int face = 0) {
  JointVector joints = tx90::park_joints();
  joints[kJointCount - 1] += joint_6_rad;
  return {.face = face, .joints = joints};
}

TEST(TurnedTouches, AreOfOnePlaceAndTheRepeatsOfOneTurn) {
  std::vector<Touch> touches{turned_by(0.0), turned_by(kQuarterTurn), turned_by(0.01),
                             turned_by(-kQuarterTurn), turned_by(0.0, 1)};
  touches.push_back(turned_by(0.0));
  touches.back().joints[1] += 0.1;  // elsewhere
  const TurnedTouches turned = turned_touches(paper::nominal(), kSurfaces, touches);
  EXPECT_EQ(turned.all, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(turned.repeats, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(turned.directions, 3);
}

TEST(TurnedTouches, OfNoTouchesAreNone) {
  const TurnedTouches turned = turned_touches(paper::nominal(), kSurfaces, {});
  EXPECT_TRUE(turned.all.empty() && turned.repeats.empty());
  EXPECT_EQ(turned.directions, 0);
}

}  // namespace
}  // namespace calib
