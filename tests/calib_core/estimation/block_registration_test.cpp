#include "calib_core/estimation/block_registration.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "calib_core/geometry/rotation.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/observability/observation_matrix.hpp"
#include "tests/calib_core/block_study.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr double kTouchStdMetres = 1e-4;
constexpr Stylus kBall{.radius_m = 0.003, .pretravel_m = 1e-5};

/// On the face, along its edges, in half extents.
struct Spot {
  int face;
  double u, v;
};
constexpr std::array<Spot, 6> kSpots{Spot{2, -0.6, -0.6}, {2, 0.6, -0.6}, {2, 0.0, 0.6},
                                     {0, -0.6, 0.0},      {0, 0.6, 0.0},  {1, 0.0, 0.0}};

Eigen::Isometry3d move_of(const Eigen::Vector3d& shift_m, double yaw_rad, double tilt_rad = 0.0) {
  return Eigen::Translation3d(shift_m) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX());
}

/// 40 mm and 5 degrees off, leaning a little.
Eigen::Isometry3d moved_block() { return move_of({0.032, 0.004, -0.024}, radians_from_degrees(5.0), 0.004); }

/// An arm before a block that was moved.
KinematicModel arm_before(const Eigen::Isometry3d& old_from_new, const ErrorVector& errors) {
  KinematicModel arm = paper::nominal();
  set_block_pose(arm, old_from_new.inverse() * block_pose_of(arm));
  return apply(arm, errors);
}

/// A person jogs the arm's ball onto the spot, the stylus leaning 20 degrees out of the normal.
JointVector joints_on(const KinematicModel& arm, const Spot& spot) {
  const Face face = tx90::faces()[static_cast<std::size_t>(spot.face)];
  const Eigen::Vector3d point_m = face.center_m + spot.u * face.half_extent_m.x() * face.edge_u +
                                  spot.v * face.half_extent_m.y() * face.edge_v() +
                                  (kBall.radius_m - kBall.pretravel_m) * face.plane.outward;
  const Eigen::Vector3d inward = -face.plane.outward;
  for (double turn = 0.0; turn < 6.3; turn += 0.3) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = point_m;
    pose.linear() =
        (Eigen::AngleAxisd(0.35, face.edge_u) * shortest_rotation(Eigen::Vector3d::UnitZ(), inward) *
         Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    const auto postures = inverse_kinematics(arm, tx90::joint_ranges(), pose);
    if (!postures.empty()) return postures.front();
  }
  throw std::runtime_error("out of reach");
}

BlockRegistrationProblem problem_of(const KinematicModel& arm) {
  BlockRegistrationProblem problem{.nominal = paper::nominal(),
                                   .faces = tx90::faces(),
                                   .stylus = kBall,
                                   .touches = {},
                                   .tilt_max_rad = radians_from_degrees(45.0)};
  for (const Spot& spot : kSpots)
    problem.touches.push_back({spot.face, joints_on(arm, spot), kTouchStdMetres});
  return problem;
}

BlockRegistration fit(const BlockRegistrationProblem& problem) {
  auto outcome = register_block(problem);
  if (auto* refusal = std::get_if<BlockRegistrationRefusal>(&outcome))
    throw std::runtime_error(refusal->message);
  return std::get<BlockRegistration>(std::move(outcome));
}

std::string refusal(const BlockRegistrationProblem& problem) {
  const auto outcome = register_block(problem);
  const auto* refused = std::get_if<BlockRegistrationRefusal>(&outcome);
  return refused ? refused->message : "";
}

/// How much the found move differs from the true one: metres above radians.
Eigen::Matrix<double, 6, 1> difference(const Eigen::Isometry3d& found, const Eigen::Isometry3d& is) {
  const Eigen::Isometry3d off = is.inverse() * found;
  const Eigen::AngleAxisd turn(off.linear());
  Eigen::Matrix<double, 6, 1> both;
  both << off.translation(), turn.axis() * turn.angle();
  return both;
}

TEST(BlockPlace, ABlockThatWasMovedIsFoundWhereItStands) {
  const Eigen::Isometry3d is = moved_block();
  const KinematicModel arm = arm_before(is, ErrorVector::Zero());
  const BlockRegistration found = fit(problem_of(arm));
  EXPECT_LT(difference(found.old_from_new, is).norm(), 1e-8);
  EXPECT_LT(found.residual_rms_m, 1e-9);
  EXPECT_LT((block_pose_of(found.model).matrix() - block_pose_of(arm).matrix()).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(BlockPlace, AnyPlaceCanBeSetAndReadBack) {
  KinematicModel arm = paper::nominal();
  arm.links[1].beta_rad = 0.01;
  const Eigen::Isometry3d pose = move_of({0.3, -0.2, 0.5}, 0.4, -0.3) * block_pose_of(arm);
  set_block_pose(arm, pose);
  EXPECT_LT((block_pose_of(arm).matrix() - pose.matrix()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(arm.links[1].beta_rad, 0.0);
}

/// The arm's own errors and the triggers' noise, drawn again and again: the places that are found spread as
/// the covariance says.
TEST(BlockPlace, TheUncertaintyIsTheSpreadOfPlacesThatAreFound) {
  constexpr int kDraws = 400;
  constexpr double kArmLengthStd = 3e-4, kArmAngleStd = 5e-4;
  const Eigen::Isometry3d is = moved_block();
  ErrorTolerances arm_errors{};
  for (std::size_t i = 0; i < arm_errors.size(); ++i) {
    if (error_parameters()[i].group() != ParameterGroup::kBlockPose)
      arm_errors[i] = error_parameters()[i].is_length() ? kArmLengthStd : kArmAngleStd;
  }
  UniformChance chance(6);
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(6, 6), told;
  for (int draw = 0; draw < kDraws; ++draw) {
    ErrorVector errors = ErrorVector::Zero();
    for (int i = 0; i < kErrorParameterCount; ++i)
      errors[i] = arm_errors[static_cast<std::size_t>(i)].value_or(0.0) * study::normal(chance);
    const KinematicModel arm = arm_before(is, errors);
    BlockRegistrationProblem problem = problem_of(arm_before(is, ErrorVector::Zero()));
    problem.arm_errors = arm_errors;
    for (RegistrationTouch& touch : problem.touches) {
      ContactSurface met = contact_plane(problem.faces[static_cast<std::size_t>(touch.face)], kBall);
      met.offset_m += kTouchStdMetres * study::normal(chance);
      touch.joints = moved_onto_plane(arm, met, {.face = touch.face, .joints = touch.joints}).joints;
    }
    const BlockRegistration found = fit(problem);
    const auto off = difference(found.old_from_new, is);
    spread += off * off.transpose() / kDraws;
    told = found.covariance;
  }
  // A deviation from 400 draws is itself known to 1 / sqrt(800), 3.5 %.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(std::sqrt(spread(i, i) / told(i, i)), 1.0, 0.15) << i;
  // ... and in every direction: spread over told has eigenvalues about 1.
  SymmetricEigen eigen;
  eigen.compute(told);
  const Eigen::MatrixXd whitening =
      eigen.vectors() * eigen.values().cwiseSqrt().cwiseInverse().asDiagonal() * eigen.vectors().transpose();
  eigen.compute_values(whitening * spread * whitening);
  EXPECT_GT(eigen.values().minCoeff(), 0.6);
  EXPECT_LT(eigen.values().maxCoeff(), 1.5);
}

TEST(BlockPlace, TheSixParametersCarryTheUncertaintyOfTheMove) {
  const BlockRegistration found = fit(problem_of(arm_before(moved_block(), ErrorVector::Zero())));
  int told = 0;
  for (std::size_t i = 0; i < found.std_block_pose.size(); ++i) {
    const bool of_place = error_parameters()[i].group() == ParameterGroup::kBlockPose;
    EXPECT_EQ(found.std_block_pose[i].has_value(), of_place) << error_parameters()[i].name();
    if (!found.std_block_pose[i]) continue;
    ++told;
    EXPECT_GT(*found.std_block_pose[i], 0.1 * kTouchStdMetres);
    EXPECT_LT(*found.std_block_pose[i], 100 * kTouchStdMetres);
  }
  EXPECT_EQ(told, 6);
}

class BlockPlaceRefused : public ::testing::Test {
 protected:
  BlockRegistrationProblem problem_ = problem_of(arm_before(moved_block(), ErrorVector::Zero()));
  KinematicModel arm_ = arm_before(moved_block(), ErrorVector::Zero());
};

TEST_F(BlockPlaceRefused, FiveTouches) {
  problem_.touches.pop_back();
  EXPECT_NE(refusal(problem_).find("six touches"), std::string::npos);
}

TEST_F(BlockPlaceRefused, ThreeTouchesOnOneLine) {
  problem_.touches[2].joints = joints_on(arm_, {2, 0.05, -0.55});
  EXPECT_NE(refusal(problem_).find("one line"), std::string::npos) << refusal(problem_);
}

TEST_F(BlockPlaceRefused, TwoTouchesAtOnePoint) {
  problem_.touches[4].joints = joints_on(arm_, {0, -0.55, 0.0});
  EXPECT_NE(refusal(problem_).find("too near"), std::string::npos) << refusal(problem_);
}

TEST_F(BlockPlaceRefused, FacesThatWereMixedUp) {
  for (std::size_t i = 3; i < 5; ++i) {
    std::swap(problem_.touches[i].face, problem_.touches[5].face);
    EXPECT_FALSE(refusal(problem_).empty()) << i;
  }
}

TEST_F(BlockPlaceRefused, AnyFaceThatIsTakenForAnother) {
  for (std::size_t i = 0; i < problem_.touches.size(); ++i) {
    for (int face = 0; face < 4; ++face) {
      BlockRegistrationProblem mixed = problem_;
      if (mixed.touches[i].face == face) continue;
      mixed.touches[i].face = face;
      EXPECT_FALSE(refusal(mixed).empty()) << "touch " << i << " for plane " << face + 1;
    }
  }
}

TEST_F(BlockPlaceRefused, ATouchBesideItsFace) {
  problem_.touches[5].joints = joints_on(arm_, {1, 1.6, 0.0});
  EXPECT_NE(refusal(problem_).find("beside"), std::string::npos) << refusal(problem_);
}

TEST_F(BlockPlaceRefused, AllTouchesOnTwoFaces) {
  problem_.touches[5] = {0, joints_on(arm_, {0, 0.0, 0.6}), kTouchStdMetres};
  EXPECT_FALSE(refusal(problem_).empty());
}

}  // namespace
}  // namespace calib
