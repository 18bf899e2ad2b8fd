#include "calib_core/observability/observation_matrix.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "calib_core/numerics/halton.hpp"
#include "tests/calib_core/paper.hpp"

namespace calib {
namespace {

std::vector<Touch> some_touches() {
  const JointRanges ranges{JointVector::Constant(-1.5), JointVector::Constant(1.5)};
  std::vector<Touch> touches;
  for (int i = 0; i < 20; ++i) touches.push_back({.face = i % 4, .joints = halton_posture(i + 1, ranges)});
  return touches;
}

TEST(Observation, TouchesMovedTogetherAreWhereTheyAreMovedToOneByOne) {
  const KinematicModel model = paper::nominal();
  const std::vector<ContactSurface> planes = paper::planes();
  for (const std::size_t count : {1U, 6U, 20U}) {
    auto touches = some_touches();
    touches.resize(count);
    for (Touch& touch : touches) {
      touch = moved_onto_plane(model, planes[static_cast<std::size_t>(touch.face)], touch);
      touch.joints += JointVector::Constant(0.01);  // some ten millimetres off
    }
    const std::vector<Touch> moved = moved_onto_planes(model, planes, touches);
    ASSERT_EQ(moved.size(), count);
    EXPECT_LT(signed_distances_m(model, planes, moved).cwiseAbs().maxCoeff(), 1e-14);
    for (std::size_t i = 0; i < count; ++i) {
      const ContactSurface& plane = planes[static_cast<std::size_t>(touches[i].face)];
      EXPECT_LT((moved[i].joints - moved_onto_plane(model, plane, touches[i]).joints).norm(), 1e-13) << i;
    }
  }
}

TEST(Observation, PlaneCoefficientsAreEquationSixOfThePaper) {
  // Table II's coefficients, typed from the paper's geometry: a . x + 1 = 0.
  const std::vector<Eigen::Vector3d> coefficients{
      {0, 0, 1 / 0.075}, {1 / 0.075, 0, 0}, {0, 1 / 0.15, 0}, {0, 0, -1 / 0.075}};
  const auto touches = some_touches();
  const KinematicModel model = paper::nominal();
  const Observation observation = observe(model, paper::planes(), touches, Formulation::kPlaneCoefficients);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Chain chain = forward_chain(model, touches[i].joints);
    const Eigen::Vector3d& abc = coefficients[static_cast<std::size_t>(touches[i].face)];
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(observation.output_error[row], -1.0 - abc.dot(chain.tip_in_block_m()), 1e-12);
    EXPECT_LT((observation.matrix.row(row) - abc.transpose() * tip_derivatives(model, chain)).norm(), 1e-10);
  }
}

TEST(Observation, SignedDistancesAreMinusTheOutputError) {
  const auto touches = some_touches();
  const KinematicModel model = paper::nominal();
  const Observation observation = observe(model, paper::planes(), touches, Formulation::kSignedDistance);
  const Eigen::VectorXd distances = signed_distances_m(model, paper::planes(), touches);
  EXPECT_LT((observation.output_error + distances).norm(), 1e-14);
}

TEST(MovedOntoPlane, PutsTheBallCentreOnTheContactPlane) {
  const KinematicModel model = paper::nominal();
  Touch touch{.face = 0, .joints = halton_posture(7, {JointVector::Constant(-1.0), JointVector::Ones()})};
  const double height_m = forward_kinematics(model, touch.joints).translation().z() + 0.01;
  const ContactSurface plane{Eigen::Vector3d::UnitZ(), height_m};
  const Touch moved = moved_onto_plane(model, plane, touch);
  EXPECT_NEAR(forward_kinematics(model, moved.joints).translation().z(), height_m, 1e-13);
}

}  // namespace
}  // namespace calib
