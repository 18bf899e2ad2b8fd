#include "calib_core/kinematics/inverse_kinematics.hpp"

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
    for (std::size_t i = 0; i < solutions.size(); ++i) {
      ASSERT_TRUE(ranges.contains(solutions[i]));
      ASSERT_LT(pose_error(model, solutions[i], pose), 2 * kPoseErrorMax) << joints.transpose();
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_GT((solutions[i] - solutions[j]).norm(), 1e-6) << "twice: " << joints.transpose();
      }
    }
  }
}

/// Without the whole turns that lie between them.
double turned_distance(const JointVector& a, const JointVector& b) {
  JointVector apart = a - b;
  for (double& angle : apart) angle = std::remainder(angle, kTurn);
  return apart.norm();
}

TEST(InverseKinematics, FindsThePostureEachPoseWasMadeFrom) {
  expect_every_posture_found(paper::nominal(), 100'000, 1e-4);
}

TEST(InverseKinematics, FindsEveryPostureThatNewtonFindsFromAnywhere) {
  std::mt19937_64 chance(2);
  const KinematicModel model = paper::nominal();
  const JointRanges everywhere{JointVector::Constant(-kTurn / 2), JointVector::Constant(kTurn / 2)};
  const InverseKinematics inverse(model);
  int met = 0, there = 0;
  for (int i = 0; i < 50; ++i) {
    const JointVector joints = random_joints(chance, everywhere);
    if (!is_regular(model, joints, 1e-3)) continue;
    const Eigen::Isometry3d pose = forward_kinematics(model, joints);
    const Postures found = inverse.solve(pose);
    std::vector<bool> is_met(found.size(), false);
    for (int start = 0; start < 100; ++start) {
      const auto reached = solve_near(model, pose, random_joints(chance, everywhere));
      if (!reached) continue;
      const auto known = std::ranges::find_if(
          found, [&](const JointVector& each) { return turned_distance(each, *reached) < 1e-6; });
      ASSERT_NE(known, found.end()) << reached->transpose();
      is_met[static_cast<std::size_t>(known - found.begin())] = true;
    }
    met += static_cast<int>(std::ranges::count(is_met, true));
    there += static_cast<int>(found.size());
  }
  EXPECT_GT(met, there * 9 / 10) << "Newton met too few to say that there are no others";
}

TEST(InverseKinematics, FollowsTheBranchItStartedOn) {
  std::mt19937_64 chance(3);
  const InverseKinematics inverse(paper::nominal());
  const JointRanges ranges = tx90::joint_ranges();
  for (int i = 0; i < 10'000; ++i) {
    const JointVector joints = random_joints(chance, ranges);
    if (!is_regular(paper::nominal(), joints, 1e-4)) continue;
    const auto followed = inverse.follow(forward_kinematics(paper::nominal(), joints), joints);
    ASSERT_TRUE(followed);
    ASSERT_LT((*followed - joints).norm(), 1e-9) << joints.transpose();
  }
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

void expect_reached_once(const JointVector& joints) {
  const KinematicModel model = paper::nominal();
  const Eigen::Isometry3d pose = forward_kinematics(model, joints);
  const Postures found = InverseKinematics(model).solve(pose);
  EXPECT_FALSE(found.empty()) << joints.transpose();
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT(pose_error(model, found[i], pose), kPoseErrorMax) << joints.transpose();
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT((found[i] - found[j]).norm(), 1e-12);
  }
}

TEST(InverseKinematics, ReachesPosesWhereBranchesMeet) {
  expect_reached_once(tx90::degrees(20, 10, 0, 30, 40, 50));    // the elbow straight
  expect_reached_once(tx90::degrees(20, 10, 0, 30, 0, 50));     // the wrist too
  expect_reached_once(tx90::degrees(20, 10, 70, 30, 180, 50));  // the wrist folded
  // The wrist's centre over joint 1's axis: as near to it as the shoulder's offset allows.
  const auto reach_m = [](double joint2_rad) {
    return 0.050 + 0.425 * (std::sin(joint2_rad) + std::sin(joint2_rad + radians_from_degrees(60)));
  };
  double low = radians_from_degrees(-60), high = 0.0;
  for (int i = 0; i < 60; ++i) (reach_m(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
  JointVector over_axis = tx90::degrees(20, 0, 60, 30, 40, 50);
  over_axis[1] = low;
  expect_reached_once(over_axis);
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

/// The postures of 200 poses that are not among those found.
int postures_missed(const KinematicModel& model) {
  std::mt19937_64 chance(4);
  const JointRanges everywhere{JointVector::Constant(-kTurn / 2), JointVector::Constant(kTurn / 2)};
  int missed = 0;
  for (int tried = 0; tried < 200;) {
    const JointVector joints = random_joints(chance, everywhere);
    if (!is_regular(model, joints, 1e-3)) continue;
    ++tried;
    missed += nearest(inverse_kinematics(model, everywhere, forward_kinematics(model, joints)), joints) < 1e-6
                  ? 0
                  : 1;
  }
  return missed;
}

TEST(InverseKinematics, FindsPosturesOfAnArmWithoutASphericalWrist) {
  KinematicModel parallel_wrist = paper::nominal();
  parallel_wrist.links[5].alpha_rad = 0.0;
  parallel_wrist.links[5].d_m = 0.1;
  EXPECT_LE(postures_missed(parallel_wrist), 2);
  KinematicModel offset_wrist = paper::nominal();
  offset_wrist.links[5].r_m = 0.1;
  offset_wrist.links[6].d_m = 0.06;
  EXPECT_LE(postures_missed(offset_wrist), 2);
  KinematicModel short_forearm = paper::nominal();
  short_forearm.links[4] = {.alpha_rad = short_forearm.links[4].alpha_rad};
  short_forearm.links[5].r_m = 0.3;
  EXPECT_LE(postures_missed(short_forearm), 2);
}

TEST(InverseKinematics, HasNothingForAnArmThatSlides) {
  KinematicModel prismatic = paper::nominal();
  prismatic.joint_types[2] = JointType::kPrismatic;
  const Eigen::Isometry3d pose = forward_kinematics(prismatic, tx90::park_joints());
  EXPECT_TRUE(inverse_kinematics(prismatic, tx90::joint_ranges(), pose).empty());
}

}  // namespace
}  // namespace calib
