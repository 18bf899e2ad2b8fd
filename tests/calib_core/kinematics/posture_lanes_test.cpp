#include "calib_core/kinematics/posture_lanes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "calib_core/numerics/halton.hpp"
#include "tests/calib_core/paper.hpp"

namespace calib {
namespace {

/// An arm with errors, a joint that turns the other way and a mass on most frames.
KinematicModel rigid_arm() {
  KinematicModel model = apply(paper::nominal(), paper::table3());
  model.gains[2] = -1.0;
  model.masses[2] = {20.0, {0.25, 0.0, 0.1}};
  model.masses[3] = {10.0, {0.0, 0.05, 0.0}};
  model.masses[6] = {2.0, {0.0, 0.01, 0.05}};
  model.masses[7] = {0.5, {0.0, 0.0, -0.1}};
  return model;
}

KinematicModel bending_arm() {
  KinematicModel model = rigid_arm();
  model.compliance_rad_per_nm = {0.0, 1e-6, 3e-6, 5e-6, 0.0, 1e-5};
  for (std::size_t joint = 0; joint < kJointCount; ++joint) model.harmonics_rad[joint] = {5e-5, -3e-5};
  for (std::size_t joint = 0; joint < kJointCount; ++joint) model.second_harmonics_rad[joint] = {-2e-5, 4e-5};
  return model;
}

/// One joint far enough round that its phases go to the library, one without periods.
KinematicModel rippled_arm() {
  KinematicModel model = bending_arm();
  model.ripple_periods_per_turn = {118.0, 97.25, 0.0, 72.0, 900.0, 48.0};
  for (std::size_t joint = 0; joint < kJointCount; ++joint) model.ripples_rad[joint] = {2e-5, -3e-5};
  return model;
}

KinematicModel sliding_arm() {
  KinematicModel model = rippled_arm();
  model.joint_types[1] = model.joint_types[4] = JointType::kPrismatic;
  return model;
}

/// Where joint 1 carries a moment too.
KinematicModel wall_arm() {
  KinematicModel model = bending_arm();
  model.down_in_frame_1 = Eigen::Vector3d(0.6, -0.8, 0.0);
  model.compliance_rad_per_nm[0] = 2e-6;
  return model;
}

class LanesOfAnArm : public ::testing::TestWithParam<KinematicModel> {};

/// Chains and derivatives in lanes against those of one posture after the other.
void expect_as_one_by_one(const LaneArithmetic& arithmetic, const KinematicModel& model) {
  const PreparedModel prepared = prepare(model);
  const JointRanges ranges{JointVector::Constant(-6.0), JointVector::Constant(6.0)};
  const Eigen::Vector3d outward = Eigen::Vector3d(0.3, -0.8, 0.5).normalized();
  std::array<ContactSurface, kLaneCount> surfaces;  // two of the first tip, two of others
  surfaces[1].ball_m = {0.04, 0.0, -0.02};
  surfaces[2].ball_m = {0.0, -0.04, -0.02};
  for (int block = 0; block < 25; ++block) {
    PostureLanes postures;
    BallLanes balls;
    for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
      postures.set(lane, halton_posture(1 + 4 * block + static_cast<int>(lane), ranges));
      balls.outward.set(lane, static_cast<double>(lane + 1) * outward);
    }
    ChainLanes chains;
    ArmRowLanes rows;
    arithmetic.turn(model.gains, postures);
    arithmetic.forward_chains(prepared, postures, chains);
    for (std::size_t lane = 0; lane < kLaneCount; ++lane)
      balls.center_m.set(lane, ball_at_m(surfaces[lane], chains, lane));
    arithmetic.distance_derivatives(prepared, chains, balls, rows);
    for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
      const Chain chain =
          forward_chain(prepared, halton_posture(1 + 4 * block + static_cast<int>(lane), ranges));
      for (std::size_t frame = 0; frame < kFrameCount; ++frame) {
        const Eigen::Matrix4d wanted = chain.block_from_frame[frame].matrix();
        const ChainLanes::Frame& here = chains.frames[frame];
        EXPECT_LT((here.x.of(lane) - wanted.col(0).head<3>()).norm(), 1e-14);
        EXPECT_LT((here.y.of(lane) - wanted.col(1).head<3>()).norm(), 1e-14);
        EXPECT_LT((here.z.of(lane) - wanted.col(2).head<3>()).norm(), 1e-14);
        EXPECT_LT((here.origin_m.of(lane) - wanted.col(3).head<3>()).norm(), 1e-13);
      }
      const ArmRow wanted =
          distance_derivatives(prepared, chain, ball_at_m(surfaces[lane], chain.block_from_frame.back()),
                               static_cast<double>(lane + 1) * outward);
      for (int column = 0; column < kArmParameterCount; ++column) {
        EXPECT_NEAR(rows[static_cast<std::size_t>(column)].of[lane], wanted[column],
                    1e-13 * std::max(1.0, std::abs(wanted[column])))
            << arm_parameter_name(column) << " in lane " << lane;
      }
    }
  }
}

TEST_P(LanesOfAnArm, AreWhatItsPosturesGiveOneByOne) { expect_as_one_by_one(lane_arithmetic(), GetParam()); }

TEST_P(LanesOfAnArm, AreTheSameInNarrowRegisters) {
  expect_as_one_by_one(narrow_lane_arithmetic(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Rigid, LanesOfAnArm, ::testing::Values(paper::nominal(), rigid_arm()));
INSTANTIATE_TEST_SUITE_P(Bending, LanesOfAnArm, ::testing::Values(bending_arm()));
INSTANTIATE_TEST_SUITE_P(OnAWall, LanesOfAnArm, ::testing::Values(wall_arm()));
INSTANTIATE_TEST_SUITE_P(Rippled, LanesOfAnArm, ::testing::Values(rippled_arm()));
INSTANTIATE_TEST_SUITE_P(Sliding, LanesOfAnArm, ::testing::Values(sliding_arm()));

/// Sine and cosine of these angles, one in each lane.
std::array<CosSin, kLaneCount> turned(const LaneArithmetic& arithmetic,
                                      const std::array<double, 4>& angles_rad) {
  PostureLanes postures;
  for (std::size_t lane = 0; lane < kLaneCount; ++lane)
    postures.set(lane, JointVector::Constant(angles_rad[lane]));
  arithmetic.turn({1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, postures);
  std::array<CosSin, kLaneCount> result;
  for (std::size_t lane = 0; lane < kLaneCount; ++lane)
    result[lane] = {postures.turned[3].cos.of[lane], postures.turned[3].sin.of[lane]};
  return result;
}

TEST(LaneArithmetic, TurnsByAnyAngleAsTheLibraryDoes) {
  constexpr int kSteps = 20'000;
  for (const LaneArithmetic* arithmetic : {&lane_arithmetic(), &narrow_lane_arithmetic()}) {
    for (int i = -kSteps; i <= kSteps; ++i) {
      // Through all quarters, at their ends, and far off.
      const double angle = 0.00137 * i;
      const std::array<double, 4> angles{angle, 0.25 * std::numbers::pi * i, 0.04 * angle * i, -angle};
      const auto result = turned(*arithmetic, angles);
      for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
        ASSERT_NEAR(result[lane].cos, std::cos(angles[lane]), 3e-16) << angles[lane];
        ASSERT_NEAR(result[lane].sin, std::sin(angles[lane]), 3e-16) << angles[lane];
      }
    }
  }
}

TEST(LaneArithmetic, LeavesWhatIsNoNumberToTheLaneThatHasIt) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto result = turned(lane_arithmetic(), {0.5, nothing, 1e300, 0.0});
  EXPECT_EQ(result[0].sin, std::sin(0.5));
  EXPECT_TRUE(std::isnan(result[1].cos));
  EXPECT_EQ(result[2].cos, std::cos(1e300));
  EXPECT_EQ(result[3].cos, 1.0);
}

TEST(LaneArithmetic, BlocksCoverEveryPostureOnce) {
  for (std::size_t total = 0; total < 10; ++total) {
    std::size_t next = 0;
    for_each_block(total, [&](std::size_t first, std::size_t count) {
      EXPECT_EQ(first, next);
      EXPECT_GE(count, 1U);
      EXPECT_LE(count, kLaneCount);
      next = first + count;
    });
    EXPECT_EQ(next, total);
  }
}

}  // namespace
}  // namespace calib
