#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/paper.hpp"

/// Nothing in the core knows the TX90: other arms and other planes, errors put in, touches made, errors
/// found.
namespace calib {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kLengthErrorMetres = 0.5e-3;
constexpr double kAngleErrorRadians = 1e-3;

/// The same structure as the TX90, shorter, and no offset between the first two axes.
KinematicModel tx60_like() {
  KinematicModel model = paper::nominal();
  model.links[2].d_m = 0.0;
  model.links[3].d_m = 0.290;
  model.links[3].r_m = 0.020;
  model.links[4].r_m = 0.310;
  model.links[7].r_m = 0.250;
  return model;
}

/// Axes 2, 3 and 4 are parallel: d, r, alpha and theta alone cannot turn axis 3 about y.
KinematicModel three_parallel_axes() {
  KinematicModel model = paper::nominal();
  model.links[2] = {.alpha_rad = kQuarter};
  model.links[3] = {.d_m = -0.425};
  model.links[4] = {.d_m = -0.392, .r_m = 0.133};
  model.links[5] = {.alpha_rad = kQuarter, .r_m = 0.100};
  model.links[6] = {.alpha_rad = -kQuarter};
  return model;
}

/// Also axis 1 parallel to z of the block: where the arm stands is told by theta0, r0, alpha1, d1 and beta1.
KinematicModel upright_on_the_block() {
  KinematicModel model = three_parallel_axes();
  model.links[0] = {};
  model.links[1] = {.d_m = -0.5, .r_m = 0.089};
  return model;
}

/// Joint 3 pushes the forearm along its axis instead of turning it.
KinematicModel with_prismatic_joint() {
  KinematicModel model = paper::nominal();
  model.joint_types[2] = JointType::kPrismatic;
  model.links[3] = {.alpha_rad = kQuarter, .d_m = 0.050, .r_m = 0.400};
  model.links[4] = {.r_m = 0.100};
  return model;
}

/// Neither orthogonal nor alike, two of them through the origin.
std::vector<ContactSurface> oblique_planes() {
  return {{Eigen::Vector3d(0.3, -0.2, 1.0).normalized(), 0.06},
          {Eigen::Vector3d(-1.0, 0.4, 0.2).normalized(), 0.0},
          {Eigen::Vector3d(0.1, -1.0, -0.3).normalized(), 0.15},
          {Eigen::Vector3d(0.5, 0.6, -0.7).normalized(), 0.0}};
}

struct ArmCase {
  std::string name;
  KinematicModel nominal;
  std::vector<ContactSurface> planes;
  int identifiable_count = 0;
};

IdentificationProblem problem_of(const ArmCase& arm, std::vector<Touch> touches) {
  return {arm.nominal, exact_artefact(arm.planes), std::move(touches)};
}

JointVector random_joints(const KinematicModel& model, std::mt19937& chance) {
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  JointVector joints;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const bool turns = model.joint_types[static_cast<std::size_t>(joint)] == JointType::kRevolute;
    joints[joint] = (turns ? 0.7 * std::numbers::pi : 0.2) * within(chance);
  }
  return joints;
}

/// Errors of a real arm's size on the given parameters.
ErrorVector random_errors(const std::vector<int>& columns, std::mt19937& chance) {
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  ErrorVector errors = ErrorVector::Zero();
  for (const int column : columns) {
    const bool is_length = error_parameters()[static_cast<std::size_t>(column)].is_length();
    errors[column] = (is_length ? kLengthErrorMetres : kAngleErrorRadians) * within(chance);
  }
  return errors;
}

/// Exact touches of the true arm, postures by chance, each moved onto its plane.
std::vector<Touch> exact_touches(const KinematicModel& truth, const std::vector<ContactSurface>& planes,
                                 std::mt19937& chance) {
  constexpr std::size_t kTouchesPerFace = 25;
  std::vector<Touch> touches;
  while (touches.size() < kTouchesPerFace * planes.size()) {
    const std::size_t face = touches.size() % planes.size();
    const Touch start{.face = static_cast<int>(face), .joints = random_joints(truth, chance)};
    const Touch touch = moved_onto_plane(truth, planes[face], start);
    const double distance_m =
        signed_distance_m(planes[face], forward_kinematics(truth, touch.joints).translation());
    const bool wound_up = (touch.joints - start.joints).cwiseAbs().maxCoeff() > 1.0;
    if (std::abs(distance_m) < 1e-14 && !wound_up) touches.push_back(touch);
  }
  return touches;
}

/// Largest distance between the tips of two arms over postures by chance.
double tip_difference_m(const KinematicModel& one, const KinematicModel& other, std::mt19937& chance) {
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    const JointVector joints = random_joints(one, chance);
    largest = std::max(largest, (forward_kinematics(one, joints).translation() -
                                 forward_kinematics(other, joints).translation())
                                    .norm());
  }
  return largest;
}

std::vector<int> all_parameters() {
  std::vector<int> columns(kErrorParameterCount);
  for (int i = 0; i < kErrorParameterCount; ++i) columns[static_cast<std::size_t>(i)] = i;
  return columns;
}

class AnyArm : public ::testing::TestWithParam<ArmCase> {
 protected:
  std::mt19937 chance_{7};
};

TEST_P(AnyArm, ShowsTheErrorsThatWerePutIn) {
  const ArmCase& arm = GetParam();
  const std::vector<int> columns = attainable_set(arm.nominal, exact_artefact(arm.planes), {}).columns;
  EXPECT_EQ(static_cast<int>(columns.size()), arm.identifiable_count);
  const ErrorVector errors = random_errors(columns, chance_);
  const KinematicModel truth = apply(arm.nominal, errors);

  const auto result = identify(problem_of(arm, exact_touches(truth, arm.planes, chance_)), {});

  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns, columns);
  EXPECT_LT((result.errors.head<kErrorParameterCount>() - errors).norm(), 1e-9);
  EXPECT_GT(tip_difference_m(arm.nominal, truth, chance_), 1e-3);
  EXPECT_LT(tip_difference_m(result.calibrated, truth, chance_), 1e-9);
}

TEST_P(AnyArm, CarriesTheErrorsThatCannotBeSeenInThoseThatCan) {
  const ArmCase& arm = GetParam();
  const ErrorVector errors = random_errors(all_parameters(), chance_);
  const auto tip_missed_m = [&](double share) {
    const KinematicModel truth = apply(arm.nominal, share * errors);
    const auto result = identify(problem_of(arm, exact_touches(truth, arm.planes, chance_)), {});
    EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    EXPECT_EQ(static_cast<int>(result.identifiable.columns.size()), arm.identifiable_count);
    return tip_difference_m(result.calibrated, truth, chance_);
  };
  // A tip that has left joint 6's axis shows two more. They are products of errors: a tenth of the errors
  // misses by a hundredth.
  const double missed_m = tip_missed_m(1.0);
  EXPECT_LT(missed_m, kLengthErrorMetres / 100.0);
  EXPECT_LT(tip_missed_m(0.1), missed_m / 30.0);
}

// Stylus on the last axis: 25. The place of a prismatic joint's axis has no effect: two fewer.
INSTANTIATE_TEST_SUITE_P(
    Cases, AnyArm,
    ::testing::Values(ArmCase{"Tx90OnObliquePlanes", paper::nominal(), oblique_planes(), 25},
                      ArmCase{"Tx60Like", tx60_like(), paper::planes(), 25},
                      ArmCase{"Tx60LikeOnObliquePlanes", tx60_like(), oblique_planes(), 25},
                      ArmCase{"ThreeParallelAxes", three_parallel_axes(), paper::planes(), 25},
                      ArmCase{"UprightOnTheBlock", upright_on_the_block(), paper::planes(), 25},
                      ArmCase{"PrismaticJoint", with_prismatic_joint(), paper::planes(), 23},
                      ArmCase{"PrismaticJointOnObliquePlanes", with_prismatic_joint(), oblique_planes(), 23}),
    [](const auto& info) { return info.param.name; });

TEST(ThreeParallelAxes, NeedHayatisBeta) {
  const auto identifiable =
      attainable_set(three_parallel_axes(), exact_artefact(paper::planes()), {}).columns;
  for (const char* name : {"beta3", "beta4"}) {
    EXPECT_TRUE(std::ranges::binary_search(identifiable, error_parameter_index(name).value())) << name;
  }
  IdentifiabilityOptions without_beta;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    if (error_parameters()[static_cast<std::size_t>(i)].kind == ParameterKind::kBeta)
      without_beta.excluded.push_back(i);
  }
  EXPECT_EQ(
      attainable_set(three_parallel_axes(), exact_artefact(paper::planes()), without_beta).columns.size(),
      identifiable.size() - 2);
}

}  // namespace
}  // namespace calib
