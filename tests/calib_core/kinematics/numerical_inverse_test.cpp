#include "calib_core/kinematics/numerical_inverse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;
constexpr double kSideways = kWholeTurn / 4.0;
/// |det| of the pose's Jacobian: nearer to a singular posture two postures meet.
constexpr double kRegularDeterminant = 1e-3;

double pose_miss(const KinematicModel& model, const JointVector& joints, const Eigen::Isometry3d& wanted) {
  return (forward_kinematics(model, joints).matrix() - wanted.matrix()).norm();
}

JointVector any_joints(std::mt19937_64& chance, double half_range_rad = kWholeTurn / 2.0) {
  std::uniform_real_distribution<double> within(-half_range_rad, half_range_rad);
  JointVector joints;
  for (double& joint : joints) joint = within(chance);
  return joints;
}

/// Joints of a posture that is no singular one.
JointVector regular_joints(const KinematicModel& model, std::mt19937_64& chance) {
  for (;;) {
    JointVector joints = any_joints(chance);
    const double determinant = pose_jacobian(model, forward_chain(model, joints)).determinant();
    if (std::abs(determinant) > kRegularDeterminant) return joints;
  }
}

/// The largest angle between two postures, without whole turns.
double apart_rad(const KinematicModel& model, const JointVector& a, const JointVector& b) {
  double largest = 0.0;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const double gain = model.gains[static_cast<std::size_t>(joint)];
    largest = std::max(largest, std::abs(std::remainder(gain * (a[joint] - b[joint]), kWholeTurn)));
  }
  return largest;
}

bool contains(const KinematicModel& model, const Postures& found, const JointVector& joints) {
  return std::ranges::any_of(
      found, [&](const JointVector& other) { return apart_rad(model, other, joints) < 1e-6; });
}

/// Axes 2, 3 and 4 are parallel and no three axes meet.
KinematicModel with_three_parallel_axes() {
  KinematicModel model;
  model.links[1] = {.alpha_rad = kSideways, .d_m = -0.5, .r_m = 0.09};
  model.links[2] = {.alpha_rad = kSideways};
  model.links[3] = {.d_m = -0.425};
  model.links[4] = {.d_m = -0.392, .r_m = 0.109};
  model.links[5] = {.alpha_rad = kSideways, .r_m = 0.095};
  model.links[6] = {.alpha_rad = -kSideways, .r_m = 0.082};
  model.links[7] = {.r_m = 0.219};
  return model;
}

/// The forearm turns as a wrist does, but its axes miss each other by 40 to 60 mm.
KinematicModel with_offset_wrist() {
  KinematicModel model = paper::nominal();
  model.links[5].d_m = 0.06;
  model.links[5].r_m = 0.05;
  model.links[6].d_m = 0.04;
  return model;
}

/// No two axes are parallel or meet.
KinematicModel of_random_geometry(std::mt19937_64& chance) {
  std::uniform_real_distribution<double> length_m(-0.4, 0.4), angle_rad(0.5, 2.6);
  KinematicModel model;
  for (std::size_t frame = 1; frame < kFrameCount; ++frame) {
    model.links[frame] = {.alpha_rad = angle_rad(chance),
                          .d_m = length_m(chance),
                          .theta_rad = angle_rad(chance),
                          .r_m = length_m(chance)};
  }
  return model;
}

struct RoundTrips {
  int tried = 0;
  int missed = 0;
  std::size_t most = 0;
};

/// Every posture that is found reaches its pose, is no other one and lies within half a turn of 0.
void tally_round_trips(const KinematicModel& model, int count, std::mt19937_64& chance, RoundTrips& tally) {
  const NumericalInverse inverse(model);
  for (int i = 0; i < count; ++i) {
    const JointVector joints = regular_joints(model, chance);
    const Eigen::Isometry3d pose = forward_kinematics(model, joints);
    const Postures found = inverse.solve(pose);
    ++tally.tried;
    tally.missed += contains(model, found, joints) ? 0 : 1;
    tally.most = std::max(tally.most, found.size());
    for (std::size_t a = 0; a < found.size(); ++a) {
      ASSERT_LT(pose_miss(model, found[a], pose), 2 * kPoseErrorMax) << joints.transpose();
      for (int joint = 0; joint < kJointCount; ++joint) {
        const double gain = model.gains[static_cast<std::size_t>(joint)];
        ASSERT_LE(std::abs(gain * found[a][joint]), kWholeTurn / 2.0 + 1e-9);
      }
      for (std::size_t b = 0; b < a; ++b)
        ASSERT_GT(apart_rad(model, found[a], found[b]), 1e-3) << joints.transpose();
    }
  }
}

TEST(NumericalInverse, FindsThePostureEachPoseWasMadeFromWithThreeParallelAxes) {
  std::mt19937_64 chance(1);
  RoundTrips tally;
  tally_round_trips(with_three_parallel_axes(), 2000, chance, tally);
  EXPECT_LE(tally.missed, 1);
  EXPECT_EQ(tally.most, 8u);
}

TEST(NumericalInverse, FindsItWithAnOffsetWrist) {
  std::mt19937_64 chance(2);
  RoundTrips tally;
  tally_round_trips(with_offset_wrist(), 2000, chance, tally);
  EXPECT_LE(tally.missed, 6);
  EXPECT_GT(tally.most, 8u);
}

TEST(NumericalInverse, FindsItForArmsOfRandomGeometry) {
  std::mt19937_64 chance(3);
  RoundTrips tally;
  for (int arm = 0; arm < 40; ++arm) tally_round_trips(of_random_geometry(chance), 100, chance, tally);
  EXPECT_LE(tally.missed, tally.tried * 3 / 1000);
}

TEST(NumericalInverse, FindsItForAnArmWithErrorsWithGearsAndUnderItsWeight) {
  std::mt19937_64 chance(4);
  KinematicModel model = apply(with_three_parallel_axes(), paper::table3());
  model.gains = {1.0, -1.0, 1.001, 0.5, 1.0, -2.0};
  model.masses[3] = {.mass_kg = 8.0, .center_in_frame_m = {-0.2, 0.0, 0.0}};
  model.compliance_rad_per_nm = {0.0, 1e-5, 1e-5, 0.0, 0.0, 0.0};
  model.harmonics_rad[2] = {1e-4, 2e-4};
  RoundTrips tally;
  tally_round_trips(model, 300, chance, tally);
  EXPECT_LE(tally.missed, 1);
}

TEST(NumericalInverse, AgreesWithTheClosedFormWhereThereIsOne) {
  std::mt19937_64 chance(5);
  const KinematicModel model = paper::nominal();
  const NumericalInverse numerical(model);
  const InverseKinematics closed(model);
  int there = 0, met = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Isometry3d pose = forward_kinematics(model, regular_joints(model, chance));
    const Postures all = closed.solve(pose), found = numerical.solve(pose);
    for (const JointVector& joints : found) ASSERT_TRUE(contains(model, all, joints)) << joints.transpose();
    there += static_cast<int>(all.size());
    met += static_cast<int>(found.size());
  }
  EXPECT_GE(met, there - there / 500);
}

TEST(NumericalInverse, GivesTheSameForTheSamePose) {
  std::mt19937_64 chance(6);
  const KinematicModel model = with_offset_wrist();
  const Eigen::Isometry3d pose = forward_kinematics(model, regular_joints(model, chance));
  const Postures once = NumericalInverse(model).solve(pose), again = NumericalInverse(model).solve(pose);
  ASSERT_FALSE(once.empty());
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i], again[i]);
}

TEST(NumericalInverse, ReachesASingularPose) {
  const KinematicModel model = with_three_parallel_axes();
  const Eigen::Isometry3d pose = forward_kinematics(model, tx90::degrees(20, -60, 70, 30, 0, 50));
  const Postures found = NumericalInverse(model).solve(pose);
  EXPECT_FALSE(found.empty());
  for (const JointVector& joints : found) EXPECT_LT(pose_miss(model, joints, pose), 2 * kPoseErrorMax);
}

TEST(NumericalInverse, HasNothingForAPoseOutOfReach) {
  std::mt19937_64 chance(7);
  const KinematicModel model = with_three_parallel_axes();
  const NumericalInverse inverse(model);
  for (int i = 0; i < 100; ++i) {
    Eigen::Isometry3d far = forward_kinematics(model, any_joints(chance));
    far.translation().x() += 3.0;
    EXPECT_TRUE(inverse.solve(far).empty());
  }
}

TEST(NumericalInverse, TakesRevoluteJointsOnly) {
  KinematicModel model = paper::nominal();
  model.joint_types[4] = JointType::kPrismatic;
  EXPECT_THROW(NumericalInverse{model}, std::logic_error);
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
    EXPECT_LT(pose_miss(model, *next, pose), 2 * kPoseErrorMax);
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
