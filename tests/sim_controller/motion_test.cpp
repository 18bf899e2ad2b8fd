#include "sim_controller/motion.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "aimed_touch.hpp"

namespace sim {
namespace {

using testing::aimed_touch;
using testing::tip_m;

TEST(Plant, SearchSpeedLimitIsTheSpeedThatStopsWithinHalfTheOvertravel) {
  const Plant plant = testing::perfect_plant("demo");
  EXPECT_NEAR(stopping_distance_m(search_speed_max_m_s(plant.overtravel_m), kStopLatencySeconds),
              plant.overtravel_m / 2.0, 1e-12);
}

TEST(Plant, StopsAnEighthOfAMillimetreBehindTheEdgeAtTheProbesSpeed) {
  // v^2 / (2 a) plus a cycle's delay: at 8 mm/s and 500 mm/s^2 about 0.13 mm.
  EXPECT_NEAR(stopping_distance_m(0.008, 0.008), 0.128e-3, 1e-9);
}

TEST(StraightLine, KeepsDirectionAndOrientationBetweenItsKnotsToo) {
  const Plant plant = testing::true_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {.face = 0, .tilt_rad = 0.7});
  const ToolPath line = straight_line(plant, touch.motion.approach, touch.motion.search_end);
  ASSERT_TRUE(line.complete);
  EXPECT_NEAR(line.length_m, 2.0 * testing::kStandoffMetres, 1e-9);
  const Eigen::Isometry3d start = calib::forward_kinematics(plant.nominal, touch.motion.approach);
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Isometry3d here = calib::forward_kinematics(plant.nominal, posture(line.path, i / 100.0));
    const Eigen::Vector3d expected =
        start.translation() - touch.face.plane.outward * (line.length_m * i / 100.0);
    EXPECT_LT((here.translation() - expected).norm(), 1e-6);
    EXPECT_LT(Eigen::AngleAxisd(start.linear().transpose() * here.linear()).angle(), 1e-6);
  }
}

TEST(StraightLine, CannotChangeTheArmsBranch) {
  const Plant plant = testing::perfect_plant("demo");
  calib::JointVector bent;
  bent << 0.0, 0.6, 0.3, 0.2, 0.5, 0.1;
  calib::JointVector turned_wrist = bent;
  turned_wrist[3] += std::numbers::pi;
  turned_wrist[4] = -bent[4];
  turned_wrist[5] += std::numbers::pi;
  ASSERT_LT(tip_distance_m(plant, bent, turned_wrist), 1e-9);
  EXPECT_FALSE(straight_line(plant, bent, turned_wrist).complete);
}

TEST(StraightLine, EndsWhereAJointReachesItsLimit) {
  Plant plant = testing::perfect_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {});
  const ToolPath whole = straight_line(plant, touch.motion.approach, touch.motion.search_end);
  const calib::JointVector middle = posture(whole.path, 0.5);
  (middle[1] > touch.motion.approach[1] ? plant.joint_ranges.upper : plant.joint_ranges.lower)[1] = middle[1];
  const ToolPath cut = straight_line(plant, touch.motion.approach, touch.motion.search_end);
  EXPECT_FALSE(cut.complete);
  EXPECT_NEAR(cut.length_m, 0.5 * whole.length_m, 1.01 * kLineSpacingMetres);
  EXPECT_TRUE(plant.joint_ranges.contains(cut.path.back()));
}

TEST(PathSlope, OfATurnOfJoint1IsItsArc) {
  const Plant plant = testing::perfect_plant("demo");
  const calib::JointVector& from = plant.start_joints;
  calib::JointVector to = from;
  to[0] += 1.0;
  calib::JointVector across = from;
  across[0] += std::numbers::pi;
  const double radius_m = tip_distance_m(plant, from, across) / 2.0;
  const PathSlope slope = path_slope(plant, {{from, to}});
  EXPECT_GE(slope.tip_m, radius_m);
  EXPECT_LT(slope.tip_m, 1.005 * radius_m);
  EXPECT_NEAR(slope.joint_seconds, 1.0 / plant.joint_speeds_max[0], 1e-12);
  const PathSlope quarter_back = path_slope(plant, {{from, to}, 0.75, 0.5});
  EXPECT_NEAR(quarter_back.tip_m, slope.tip_m / 4.0, 1e-12);
  EXPECT_NEAR(quarter_back.joint_seconds, slope.joint_seconds / 4.0, 1e-12);
}

TEST(PathSlope, OfALineIsItsLength) {
  const Plant plant = testing::perfect_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {.face = 0, .tilt_rad = 0.7});
  const ToolPath line = straight_line(plant, touch.motion.approach, touch.motion.search_end);
  EXPECT_NEAR(path_slope(plant, {line.path}).tip_m, line.length_m, 2e-3 * line.length_m);
}

TEST(SweepBound, IsNeverLessThanTheWayOfTheTip) {
  const Plant plant = testing::true_plant("demo");
  std::mt19937_64 chance(5);
  const auto random_joints = [&chance, &plant] {
    calib::JointVector joints;
    for (double& joint : joints) joint = static_cast<double>(chance() >> 11) * 0x1p-53;
    return (plant.joint_ranges.lower.array() +
            joints.array() * (plant.joint_ranges.upper - plant.joint_ranges.lower).array())
        .matrix()
        .eval();
  };
  for (int i = 0; i < 1000; ++i) {
    const calib::JointVector from = random_joints();
    const calib::JointVector to = from + 0.05 * (random_joints() - from);
    EXPECT_LE((tip_m(plant.truth, to) - tip_m(plant.truth, from)).norm(), sweep_bound_m(plant, from, to));
  }
}

}  // namespace
}  // namespace sim
