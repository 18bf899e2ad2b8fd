#include "calib_core/inverse_kinematics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

JointVector random_joints(std::mt19937_64& chance, const JointRanges& ranges) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  JointVector joints;
  for (double& joint : joints) joint = share(chance);
  return ranges.lower + (ranges.upper - ranges.lower).cwiseProduct(joints);
}

double pose_error(const KinematicModel& model, const JointVector& joints, const Eigen::Isometry3d& wanted) {
  return (forward_kinematics(model, joints).matrix() - wanted.matrix()).norm();
}

double nearest(const std::vector<JointVector>& solutions, const JointVector& wanted) {
  double distance = HUGE_VAL;
  for (const JointVector& joints : solutions) distance = std::min(distance, (joints - wanted).norm());
  return distance;
}

/// Away from the postures where two branches meet, where the determinant vanishes.
bool is_regular(const KinematicModel& model, const JointVector& joints, double determinant_min) {
  return std::abs(pose_jacobian(model, forward_chain(model, joints)).determinant()) > determinant_min;
}

void expect_every_posture_found(const KinematicModel& model, int count, double determinant_min) {
  std::mt19937_64 chance(1);
  const JointRanges ranges = tx90::joint_ranges();
  int tried = 0;
  while (tried < count) {
    const JointVector joints = random_joints(chance, ranges);
    if (!is_regular(model, joints, determinant_min)) continue;
    ++tried;
    const Eigen::Isometry3d pose = forward_kinematics(model, joints);
    const auto solutions = inverse_kinematics(model, ranges, pose);
    ASSERT_LT(nearest(solutions, joints), 1e-9) << joints.transpose();
    for (const JointVector& solution : solutions) {
      ASSERT_TRUE(ranges.contains(solution));
      ASSERT_LT(pose_error(model, solution, pose), 2 * kPoseErrorMax) << joints.transpose();
    }
  }
}

TEST(InverseKinematics, FindsThePostureEachPoseWasMadeFrom) {
  expect_every_posture_found(paper::nominal(), 20000, 1e-4);
}

TEST(InverseKinematics, FindsItForEverySignAndOffsetOfTheFamily) {
  KinematicModel other = paper::nominal();
  other.links[0].theta_rad = 0.7;
  other.links[1].beta_rad = 0.2;
  other.links[2].alpha_rad *= -1.0;
  other.links[2].r_m = 0.03;
  other.links[4].alpha_rad *= -1.0;
  other.links[4].d_m = -0.06;
  other.links[5].alpha_rad *= -1.0;
  other.links[7] = {.alpha_rad = 0.4, .d_m = 0.05, .theta_rad = 1.0, .r_m = 0.2, .beta_rad = -0.3};
  other.gains = {1.0, -1.0, 1.0, 1.0, 1.0, -1.0};
  expect_every_posture_found(other, 5000, 1e-4);
}

TEST(InverseKinematics, PolishesTheClosedFormForAnArmWithErrors) {
  // Nearer to a singular posture the pose may be out of reach of the arm without the errors.
  expect_every_posture_found(apply(paper::nominal(), paper::table3()), 2000, 1e-2);
}

TEST(InverseKinematics, GivesTwoShouldersTwoElbowsAndTwoWrists) {
  const KinematicModel model = paper::nominal();
  const JointVector half_turn = JointVector::Constant(std::numbers::pi);
  const Eigen::Isometry3d pose = forward_kinematics(model, tx90::degrees(20, 10, 70, 30, 40, 50));
  EXPECT_EQ(inverse_kinematics(model, {-half_turn, half_turn}, pose).size(), 8u);
}

TEST(InverseKinematics, GivesEveryWholeTurnThatFitsIntoTheRanges) {
  const KinematicModel model = paper::nominal();
  const JointVector joints = tx90::degrees(20, 10, 70, 120, 40, -150);
  const auto solutions = inverse_kinematics(model, tx90::joint_ranges(), forward_kinematics(model, joints));
  for (const double turn4 : {0.0, -kTurn}) {
    for (const double turn6 : {0.0, kTurn}) {
      const JointVector turned = joints + turn4 * JointVector::Unit(3) + turn6 * JointVector::Unit(5);
      EXPECT_LT(nearest(solutions, turned), 1e-9) << turned.transpose();
    }
  }
}

TEST(InverseKinematics, ReachesThePoseWithTheWristStraight) {
  const KinematicModel model = paper::nominal();
  const Eigen::Isometry3d pose = forward_kinematics(model, tx90::degrees(20, 10, 70, 30, 0, 50));
  const auto solutions = inverse_kinematics(model, tx90::joint_ranges(), pose);
  ASSERT_FALSE(solutions.empty());
  for (const JointVector& joints : solutions) EXPECT_LT(pose_error(model, joints, pose), 2 * kPoseErrorMax);
}

TEST(InverseKinematics, HasNothingForAPoseOutOfReach) {
  const KinematicModel model = paper::nominal();
  Eigen::Isometry3d far = forward_kinematics(model, tx90::park_joints());
  far.translation().x() += 2.0;
  EXPECT_TRUE(inverse_kinematics(model, tx90::joint_ranges(), far).empty());
  Eigen::Isometry3d in_the_column = forward_kinematics(model, tx90::park_joints());
  in_the_column.translation() += forward_chain(model, tx90::park_joints()).block_from_frame[1].translation() -
                                 forward_chain(model, tx90::park_joints()).block_from_frame[4].translation();
  EXPECT_TRUE(inverse_kinematics(model, tx90::joint_ranges(), in_the_column).empty());
}

TEST(InverseKinematics, HasNothingForAnArmOfAnotherKind) {
  const Eigen::Isometry3d pose = forward_kinematics(paper::nominal(), tx90::park_joints());
  KinematicModel parallel_wrist = paper::nominal();
  parallel_wrist.links[5].alpha_rad = 0.0;
  EXPECT_TRUE(inverse_kinematics(parallel_wrist, tx90::joint_ranges(), pose).empty());
  KinematicModel prismatic = paper::nominal();
  prismatic.joint_types[2] = JointType::kPrismatic;
  EXPECT_TRUE(inverse_kinematics(prismatic, tx90::joint_ranges(), pose).empty());
}

TEST(SolveNear, FollowsAStraightLineOnTheSameBranch) {
  const KinematicModel model = apply(paper::nominal(), paper::table3());
  const JointVector start = tx90::degrees(20, 10, 70, 30, 40, 50);
  Eigen::Isometry3d pose = forward_kinematics(model, start);
  JointVector joints = start;
  for (int millimetre = 0; millimetre < 40; ++millimetre) {
    pose.translation().z() += 1e-3;
    const auto next = solve_near(model, pose, joints);
    ASSERT_TRUE(next);
    EXPECT_LT(pose_error(model, *next, pose), 2 * kPoseErrorMax);
    EXPECT_LT((*next - joints).norm(), 0.02);
    joints = *next;
  }
}

TEST(SolveNear, HasNothingForAPoseOutOfReach) {
  const KinematicModel model = paper::nominal();
  Eigen::Isometry3d far = forward_kinematics(model, tx90::park_joints());
  far.translation().x() += 2.0;
  EXPECT_FALSE(solve_near(model, far, tx90::park_joints()));
}

TEST(PoseJacobian, MatchesDifferences) {
  const KinematicModel model = apply(paper::nominal(), paper::table3());
  const JointVector joints = tx90::degrees(20, 10, 70, 30, 40, 50);
  const Chain chain = forward_chain(model, joints);
  const auto jacobian = pose_jacobian(model, chain);
  constexpr double kStep = 1e-5;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto ahead = forward_kinematics(model, joints + kStep * JointVector::Unit(joint));
    const auto behind = forward_kinematics(model, joints - kStep * JointVector::Unit(joint));
    const Eigen::AngleAxisd turn(ahead.linear() * behind.linear().transpose());
    Eigen::Matrix<double, 6, 1> numeric;
    numeric << ahead.translation() - behind.translation(), turn.angle() * turn.axis();
    EXPECT_LT((jacobian.col(joint) - numeric / (2 * kStep)).norm(), 1e-8) << joint;
  }
}

}  // namespace
}  // namespace calib
