#include "calib_core/compensation/arm_sides.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/numerical_inverse.hpp"
#include "calib_core/numerics/halton.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

TEST(ArmSides, OfATx90AreItsJointsThreeAndFiveAndTheShoulderOfItsController) {
  const KinematicModel model = paper::nominal();
  int behind = 0;
  for (int i = 1; i <= 500; ++i) {
    const JointVector joints = halton_posture(i, tx90::joint_ranges());
    const ArmBend bend = arm_bend(forward_chain(model, joints));
    EXPECT_NEAR(bend.elbow_rad, joints[2], 1e-12);
    EXPECT_NEAR(bend.wrist_rad, joints[4], 1e-12);
    // The shoulder of a VAL3 config, by the arm's lengths.
    const bool ahead = 0.050 + 0.425 * std::sin(joints[1]) + 0.425 * std::sin(joints[1] + joints[2]) >= 0.0;
    const ArmSides wanted{
        .ahead = ahead, .elbow_positive = joints[2] >= 0.0, .wrist_positive = joints[4] >= 0.0};
    EXPECT_EQ(bend.sides, wanted) << joints.transpose();
    behind += ahead ? 0 : 1;
  }
  EXPECT_GT(behind, 50);
}

/// The elbow of an arm whose forearm is bent by its own offset d4 is not stretched where joint 3 is 0.
TEST(ArmSides, TakeTheStretchedElbowFromTheArmsOwnGeometry) {
  KinematicModel model = paper::nominal();
  model.links[4].d_m = 0.1;
  const double bent_rad = std::atan2(0.1, 0.425);
  const JointVector at_zero = tx90::degrees(10.0, 20.0, 0.0, 30.0, 40.0, 50.0);
  EXPECT_NEAR(std::abs(arm_bend(forward_chain(model, at_zero)).elbow_rad), bent_rad, 1e-12);
  // There it really loses a direction: the determinant changes its sign, and at joint 3 = 0 it does not.
  const auto determinant = [&model, at_zero](double joint3_rad) {
    JointVector joints = at_zero;
    joints[2] = joint3_rad;
    return pose_jacobian(model, forward_chain(model, joints)).determinant();
  };
  const double stretched_rad = -arm_bend(forward_chain(model, at_zero)).elbow_rad;
  EXPECT_LT(determinant(stretched_rad - 0.01) * determinant(stretched_rad + 0.01), 0.0);
  EXPECT_GT(determinant(-0.01) * determinant(0.01), 0.0);
}

TEST(ArmSides, OfParallelAxesLoseADirectionWhereTheArmIsStretchedToo) {
  KinematicModel model;
  model.links[2] = {.alpha_rad = kHalfTurn / 2.0};
  model.links[3] = {.d_m = -0.425};
  model.links[4] = {.d_m = -0.392, .r_m = 0.109};
  model.links[5] = {.alpha_rad = kHalfTurn / 2.0, .r_m = 0.095};
  model.links[6] = {.alpha_rad = -kHalfTurn / 2.0, .r_m = 0.082};
  const JointVector joints = tx90::degrees(10.0, -40.0, 25.0, 35.0, 50.0, 15.0);
  EXPECT_NEAR(arm_bend(forward_chain(model, joints)).elbow_rad, joints[2], 1e-12);
  JointVector stretched = joints;
  stretched[2] = 0.0;
  const auto determinant = [&model](const JointVector& at) {
    return std::abs(pose_jacobian(model, forward_chain(model, at)).determinant());
  };
  EXPECT_LT(determinant(stretched), 1e-12);
  EXPECT_GT(determinant(joints), 1e-3);
}

TEST(ArmSides, MarginsCountFromTheStraightAndFromTheFoldedEnd) {
  const ArmBend bend{.elbow_rad = -radians_from_degrees(178.0), .wrist_rad = radians_from_degrees(3.0)};
  EXPECT_NEAR(bend.elbow_margin_rad(), radians_from_degrees(2.0), 1e-12);
  EXPECT_NEAR(bend.wrist_margin_rad(), radians_from_degrees(3.0), 1e-12);
}

TEST(ArmSides, AnArmWithoutAForearmHasNoStretchedElbow) {
  KinematicModel model = paper::nominal();
  model.links[4].r_m = 0.0;
  const ArmBend bend = arm_bend(forward_chain(model, tx90::degrees(0.0, 10.0, 0.0, 0.0, 30.0, 0.0)));
  EXPECT_NEAR(bend.elbow_margin_rad(), kHalfTurn / 2.0, 1e-12);
}

}  // namespace
}  // namespace calib
