#include "calib_core/uncertainty/left_out_effects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "tests/calib_core/block_study.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr int kEffects = 12;
constexpr double kPriorShare = 1.0 / 6.0;

/// The median share over many arms whose effects have `scale` times their declared deviations; the touches
/// show a declared deviation `shown` standard deviations of their noise large.
double median_share(double scale, double shown) {
  UniformChance chance(3);
  const Eigen::MatrixXd mixed =
      Eigen::MatrixXd::NullaryExpr(kEffects, kEffects, [&] { return study::normal(chance); });
  const Eigen::MatrixXd information =
      shown * shown * (Eigen::MatrixXd::Identity(kEffects, kEffects) + 0.1 * mixed * mixed.transpose());
  const Eigen::MatrixXd root = information.llt().matrixL();
  std::vector<double> shares;
  for (int arm = 0; arm < 101; ++arm) {
    const auto drawn = [&] {
      return Eigen::VectorXd::NullaryExpr(kEffects, [&] { return study::normal(chance); }).eval();
    };
    const Eigen::VectorXd score = information * (scale * drawn()) + root * drawn();
    shares.push_back(mean_variance_share({information, score}, {}, kPriorShare));
  }
  std::ranges::nth_element(shares, shares.begin() + 50);
  return shares[50];
}

TEST(LeftOutEffects, AreOfTheSizeThatTheResidualsLeaveThem) {
  EXPECT_LT(median_share(0.0, 3.0), 0.05);
  EXPECT_NEAR(median_share(0.5, 3.0), 0.25, 0.08);
  EXPECT_GT(median_share(1.0, 3.0), 0.5);
  EXPECT_NEAR(median_share(2.0, 3.0), 4.0, 1.5) << "the declared deviations are too small";
}

/// As median_share(), where the noise is known from the same residuals alone: so many degrees with the
/// effects.
double median_share_beside(double scale, double shown, double degrees) {
  UniformChance chance(5);
  const Eigen::MatrixXd information = shown * shown * Eigen::MatrixXd::Identity(kEffects, kEffects);
  std::vector<double> shares;
  for (int arm = 0; arm < 101; ++arm) {
    Eigen::VectorXd score(kEffects);
    for (double& value : score)
      value = shown * shown * scale * study::normal(chance) + shown * study::normal(chance);
    double squares = score.squaredNorm() / (shown * shown);
    for (int k = kEffects; k < degrees; ++k) squares += std::pow(study::normal(chance), 2);
    const NoiseEvidence noise{squares, degrees, squares / degrees};
    shares.push_back(mean_variance_share({information, score}, noise, kPriorShare));
  }
  std::ranges::nth_element(shares, shares.begin() + 50);
  return shares[50];
}

TEST(LeftOutEffects, DoNotPassForNoise) {
  EXPECT_GT(median_share_beside(3.0, 4.0, 30.0), 4.0);
  EXPECT_GT(median_share_beside(3.0, 4.0, 24.0), 4.0);
  EXPECT_NEAR(median_share_beside(1.0, 4.0, 30.0), 1.0, 0.3);
  EXPECT_LT(median_share_beside(0.0, 4.0, 30.0), 0.05);
  const Eigen::MatrixXd information = Eigen::MatrixXd::Identity(kEffects, kEffects);
  const GroupEvidence group{information, Eigen::VectorXd::Constant(kEffects, 5.0)};
  EXPECT_EQ(mean_variance_share(group, {100.0, 13.0, 7.0}, kPriorShare),
            mean_variance_share(group, {.otherwise = 7.0}, kPriorShare))
      << "too few degrees are left";
}

TEST(LeftOutEffects, StayAsTheyAreExpectedWhereTheTouchesSayNothing) {
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(kEffects, kEffects);
  EXPECT_NEAR(mean_variance_share({nothing, Eigen::VectorXd::Zero(kEffects)}, {}, kPriorShare), kPriorShare,
              1e-3);
  EXPECT_NEAR(median_share(1.0, 0.01), kPriorShare, 0.01);
}

TEST(SearchDirections, AreThoseInWhichTheJointsTurn) {
  const KinematicModel model = paper::nominal();
  const JointVector joints = (JointVector() << 0.3, 0.4, 1.1, 0.5, 0.8, -0.4).finished();
  const Eigen::Vector3d outward = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  constexpr double kStepMetres = 1e-4;
  Eigen::Isometry3d deeper = forward_kinematics(model, joints);
  deeper.translation() -= kStepMetres * outward;
  const auto reached = solve_near(model, deeper, joints);
  ASSERT_TRUE(reached);
  const JointVector directions = search_directions(model, forward_chain(model, joints), outward);
  for (int joint = 0; joint < kJointCount; ++joint)
    EXPECT_EQ(directions[joint], (*reached)[joint] > joints[joint] ? 1.0 : -1.0) << joint;
}

TEST(SearchDirections, AreNoneInASingularPosture) {
  const KinematicModel model = paper::nominal();
  const JointVector straight = (JointVector() << 0.3, 0.4, 1.1, 0.0, 0.0, 0.0).finished();
  for (const double direction : search_directions(model, forward_chain(model, straight), {0.0, -1.0, 0.0}))
    EXPECT_TRUE(direction == 0.0 || std::abs(direction) == 1.0);
}

}  // namespace
}  // namespace calib
