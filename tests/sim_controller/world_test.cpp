#include "sim_controller/world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/gravity.hpp"
#include "quiet_cell.hpp"
#include "whole_path.hpp"

namespace sim {
namespace {

using namespace testing;

/// Resolution of a trip: what a search at 8 mm/s goes in a latch step.
constexpr double kStepMetres = 0.008 * kLatchSeconds;

/// The commanded joints of a trip; the touch must be met.
calib::JointVector trip(const Plant& plant, const AimedTouch& touch) {
  Ride ride(plant);
  const auto joints = ride.search(touch.motion);
  EXPECT_TRUE(joints) << ride.collision;
  return joints.value_or(touch.motion.search_end);
}

/// Where the controller believes the ball's centre to be at a trip, above the nominal contact plane: how much
/// earlier than believed it trips.
double early_m(const cell::Truth& truth, const AimedTouch& touch) {
  const Plant plant = quiet_plant(truth);
  return calib::signed_distance_m(touch.contact_plane, tip_m(plant.nominal, trip(plant, touch)));
}

/// The push on the ball at a touch, in the tool's frame.
Eigen::Vector3d push_in_tool(const Plant& plant, const AimedTouch& touch) {
  return calib::forward_kinematics(plant.nominal, touch.motion.approach).linear().transpose() *
         touch.face.plane.outward;
}

/// How far above the plane a small turn of the joints lifts the ball.
double lift_m(const Plant& plant, const AimedTouch& touch, const calib::JointVector& at,
              const calib::JointVector& turn_rad) {
  const auto chain = calib::forward_chain(plant.nominal, at);
  return touch.face.plane.outward.dot(calib::tip_jacobian(plant.nominal, chain) * turn_rad);
}

TEST(World, TripsWhereTheWholePathSaysToALatchStep) {
  for (const char* name : {"edf", "demo"}) {
    const cell::Cell cell = testing::read_cell(name);
    Ride ride(testing::true_plant(name));
    for (int face = 0; face < static_cast<int>(cell.block.faces.size()); ++face) {
      const AimedTouch touch = aimed_touch(cell, {.face = face, .tilt_rad = 0.6});
      const auto found = ride.search(touch.motion);
      ASSERT_TRUE(found) << name << face << ride.collision;
      ASSERT_NE(ride.world.noise_m, 0.0);
      const Path path = straight_line(ride.plant, touch.motion.approach, touch.motion.search_end).path;
      const auto expected = testing::find_trip(ride.plant, path, ride.world.noise_m);
      ASSERT_TRUE(expected);
      const double late_m =
          (tip_m(ride.plant.nominal, *found) - tip_m(ride.plant.nominal, path.front())).norm() -
          (tip_m(ride.plant.nominal, posture(path, *expected)) - tip_m(ride.plant.nominal, path.front()))
              .norm();
      EXPECT_GE(late_m, -1e-8) << name << face;
      EXPECT_LE(late_m, 1.01 * kStepMetres) << name << face;
    }
  }
}

TEST(World, OfNothingHiddenTripsOnTheNominalContactPlane) {
  for (const int face : {0, 2, 4}) {
    const double early = early_m({}, aimed_touch(demo(), {.face = face, .tilt_rad = 0.6}));
    EXPECT_LE(early, 1e-8);
    EXPECT_GE(early, -1.01 * kStepMetres);
  }
}

TEST(World, DroopsByComplianceTimesTheMomentOfTheMasses) {
  const AimedTouch touch = aimed_touch(demo(), {});
  cell::Truth truth;
  truth.droop = cell::Droop{{0.0, 1e-6, 3e-6}};
  const Plant plant = quiet_plant(truth);
  const calib::JointVector at = trip(plant, touch);
  const calib::JointVector moments_nm =
      calib::gravity_torques_nm(plant.nominal, calib::forward_chain(plant.nominal, at));
  calib::JointVector turn_rad = calib::JointVector::Zero();
  turn_rad[1] = 1e-6 * moments_nm[1];
  turn_rad[2] = 3e-6 * moments_nm[2];
  const double expected_m = -lift_m(plant, touch, at, turn_rad);
  EXPECT_GT(std::abs(expected_m), 50e-6);
  EXPECT_NEAR(early_m(truth, touch), expected_m, kStepMetres + 1e-3 * std::abs(expected_m));
}

TEST(World, RippleShiftsATripByTheSineOfTheJoint) {
  const AimedTouch touch = aimed_touch(demo(), {});
  for (const double phase_rad : {0.0, 0.5 * std::numbers::pi, std::numbers::pi}) {
    cell::Truth truth;
    truth.ripple[1] = {.amplitude_rad = 3e-5, .periods_per_turn = 100, .phase_rad = phase_rad};
    truth.ripple[2] = {.amplitude_rad = 2e-5, .periods_per_turn = 80, .phase_rad = phase_rad};
    const Plant plant = quiet_plant(truth);
    const calib::JointVector at = trip(plant, touch);
    calib::JointVector turn_rad = calib::JointVector::Zero();
    turn_rad[1] = 3e-5 * std::sin(100 * at[1] + phase_rad);
    turn_rad[2] = 2e-5 * std::sin(80 * at[2] + phase_rad);
    EXPECT_NEAR(early_m(truth, touch), -lift_m(plant, touch, at, turn_rad), 1.05 * kStepMetres);
  }
}

TEST(World, BacklashLagsByHalfItsWidthBehindTheLastDirection) {
  const AimedTouch touch = aimed_touch(demo(), {});
  cell::Truth truth;
  truth.backlash_rad[1] = 2e-4;
  truth.backlash_rad[2] = 1e-4;
  const Plant plant = quiet_plant(truth);
  const calib::JointVector at = trip(plant, touch);
  const calib::JointVector way = touch.motion.search_end - touch.motion.approach;
  ASSERT_GT(std::abs(way[1]), 1e-3);
  const calib::JointVector lag_rad = -0.5 * truth.backlash_rad.cwiseProduct(way.cwiseSign());
  const double expected_m = -lift_m(plant, touch, at, lag_rad);
  EXPECT_GT(std::abs(expected_m), 10e-6);
  EXPECT_NEAR(early_m(truth, touch), expected_m, 1.05 * kStepMetres);
}

TEST(World, ComesToOnePostureFromBothSidesWithTheWholeBacklashBetween) {
  cell::Truth truth;
  truth.backlash_rad[3] = 3e-4;
  Ride ride(quiet_plant(truth));
  const calib::JointVector middle = ride.plant.start_joints;
  const calib::JointVector step = 0.05 * calib::JointVector::Unit(3);
  const auto come_from = [&](const calib::JointVector& side) {
    ride.go(side, 0.1);
    ride.go(middle, 0.1);
    return true_tip_m(ride.plant, ride.world, middle);
  };
  const Eigen::Vector3d from_above = come_from(middle + step), from_below = come_from(middle - step);
  const auto chain = calib::forward_chain(ride.plant.truth, middle);
  const Eigen::Vector3d expected = calib::tip_jacobian(ride.plant.truth, chain).col(3) * 3e-4;
  EXPECT_GT(expected.norm(), 50e-6);
  EXPECT_LT((from_above - from_below - expected).norm(), 1e-7);
  // A way shorter than the play moves nothing.
  ride.go(middle - 1e-4 * calib::JointVector::Unit(3), 0.1);
  ride.go(middle, 0.1);
  EXPECT_LT((true_tip_m(ride.plant, ride.world, middle) - from_below).norm(), 1e-12);
}

TEST(World, AWarmArmIsLongerByItsExpansion) {
  const AimedTouch touch = aimed_touch(demo(), {});
  cell::Truth truth;
  truth.warming = {.arm_expansion_per_k = 2.3e-5, .arm_rise_k = 10.0, .arm_time_constant_s = 1800.0};
  Ride ride(quiet_plant(truth));
  pass(ride.plant, ride.world, 1e6);
  const auto warm = ride.search(touch.motion);
  ASSERT_TRUE(warm);
  // All that lies between the shoulder and the wrist grows about the shoulder.
  const auto chain = calib::forward_chain(ride.plant.nominal, *warm);
  const Eigen::Vector3d reach =
      chain.block_from_frame[6].translation() - chain.block_from_frame[1].translation();
  const double expected_m = -touch.face.plane.outward.dot(2.3e-4 * reach);
  EXPECT_GT(std::abs(expected_m), 20e-6);
  EXPECT_NEAR(calib::signed_distance_m(touch.contact_plane, tip_m(ride.plant.nominal, *warm)), expected_m,
              1.05 * kStepMetres);
}

TEST(World, WarmsUpWithItsTimeConstantWhilePoweredAndCoolsDownAfter) {
  cell::Truth truth;
  truth.warming = {.arm_expansion_per_k = 2.3e-5, .arm_rise_k = 8.0, .arm_time_constant_s = 100.0};
  Ride ride(quiet_plant(truth));
  for (int tick = 0; tick < 25'000; ++tick) ride.tick();  // 100 s
  EXPECT_NEAR(ride.world.rise_k, 8.0 * (1.0 - std::exp(-1.0)), 1e-6);
  const double warm_k = ride.world.rise_k;
  ride.world.powered = false;
  pass(ride.plant, ride.world, 200.0);
  EXPECT_NEAR(ride.world.rise_k, warm_k * std::exp(-2.0), 1e-9);
}

TEST(World, AWarmBlocksTopIsHigherByItsExpansion) {
  cell::Truth truth;
  truth.warming.block_warmer_k = 5.0;
  const double top_m = demo().block.faces[2].plane.offset_m;
  EXPECT_NEAR(early_m(truth, aimed_touch(demo(), {.face = 2})),
              5.0 * demo().block.thermal_expansion_per_k.value() * top_m, 1.05 * kStepMetres);
}

TEST(World, EachFaceTripsEarlierByItsOwnOffset) {
  cell::Truth truth;
  truth.face_offsets_m = {40e-6, -30e-6, 20e-6, -50e-6, 60e-6};
  for (int face = 0; face < 5; ++face) {
    EXPECT_NEAR(early_m(truth, aimed_touch(demo(), {.face = face, .tilt_rad = 0.6})),
                truth.face_offsets_m[static_cast<std::size_t>(face)], 1.05 * kStepMetres)
        << face;
  }
}

TEST(World, ALargerBallTripsEarlierAndALongerPretravelLater) {
  const AimedTouch touch = aimed_touch(demo(), {});
  cell::Truth truth;
  truth.probe.stylus_radius_m = demo().probe.stylus.radius_m + 25e-6;
  EXPECT_NEAR(early_m(truth, touch), 25e-6, 1.05 * kStepMetres);
  truth.probe.pretravel_m = demo().probe.stylus.pretravel_m + 40e-6;
  EXPECT_NEAR(early_m(truth, touch), -15e-6, 1.05 * kStepMetres);
}

TEST(World, PretravelGrowsWithTheStylusTilt) {
  cell::Truth truth;
  truth.probe.pretravel_tilt_m = 80e-6;
  for (const double tilt_rad : {0.0, 0.4, 0.9}) {
    EXPECT_NEAR(early_m(truth, aimed_touch(demo(), {.tilt_rad = tilt_rad})),
                -80e-6 * std::sin(tilt_rad) * std::sin(tilt_rad), 1.05 * kStepMetres)
        << tilt_rad;
  }
}

TEST(World, PretravelHasThreeLobesAroundTheStylus) {
  const double tilt_rad = 0.8;
  const AimedTouch touch = aimed_touch(demo(), {.tilt_rad = tilt_rad});
  const Eigen::Vector3d push = push_in_tool(quiet_plant({}), touch);
  const double direction_rad = std::atan2(push.y(), push.x());
  const double sideways = std::sin(tilt_rad) * std::sin(tilt_rad);
  for (int sixth = 0; sixth < 6; ++sixth) {  // on a lobe, between two, on the next
    cell::Truth truth;
    truth.probe.lobes_m = 50e-6;
    truth.probe.lobe_direction_rad = direction_rad + sixth * std::numbers::pi / 3.0;
    EXPECT_NEAR(early_m(truth, touch), (sixth % 2 == 0 ? -1.0 : 1.0) * 50e-6 * sideways, 1.1 * kStepMetres)
        << sixth;
  }
}

// The simulator's formula against that of the core, which identifies: what a probe's file says of the probe
// puts the contact where it is.
TEST(World, TripsWhereTheDistanceOfAKnownProbeIsNothing) {
  const calib::SidewaysPretravel known{.tilt_m = 80e-6, .lobes_m = 50e-6, .lobe_direction_rad = 0.7};
  cell::Truth truth;
  truth.probe.pretravel_tilt_m = known.tilt_m;
  truth.probe.lobes_m = known.lobes_m;
  truth.probe.lobe_direction_rad = known.lobe_direction_rad;
  const Plant plant = quiet_plant(truth);
  calib::Stylus stylus = demo().probe.stylus;
  stylus.sideways = known;
  for (int face = 0; face < 5; ++face) {
    const AimedTouch touch = aimed_touch(demo(), {.face = face, .tilt_rad = 0.8});
    const Eigen::Isometry3d tip = calib::forward_kinematics(plant.nominal, trip(plant, touch));
    EXPECT_NEAR(calib::signed_distance_m(calib::contact_plane(touch.face, stylus), tip), 0.0,
                1.1 * kStepMetres);
    EXPECT_GT(std::abs(calib::signed_distance_m(touch.contact_plane, tip)), 10e-6)
        << "by one pre-travel for all";
  }
}

TEST(World, DrawsNoiseAndStopOfEachSearchWithTheirStandardDeviations) {
  cell::Truth truth = real_truth();
  const Plant plant = make_plant(demo(), truth);
  World world = make_world(plant);
  std::mt19937_64 chance(11);
  const int count = 20'000;
  double noise = 0.0;
  calib::JointVector stops = calib::JointVector::Zero();
  for (int i = 0; i < count; ++i) {
    begin_search(plant, world, chance);
    noise += world.noise_m * world.noise_m;
    stops += world.stop_error_rad.cwiseAbs2();
  }
  const double within = 4.0 / std::sqrt(2.0 * count);  // four deviations of a standard deviation's estimate
  EXPECT_NEAR(std::sqrt(noise / count) / truth.probe.noise_m.value(), 1.0, within);
  const calib::JointVector deviations = (stops / count).cwiseSqrt().cwiseQuotient(truth.repeatability_rad);
  EXPECT_LT((deviations.array() - 1.0).abs().maxCoeff(), within);
}

TEST(World, OfTheRealTruthComesBackToAPointAtReachWithin30Micrometres) {
  const Plant plant = make_plant(demo(), real_truth());
  World world = make_world(plant);
  std::mt19937_64 chance(12);
  // Arm stretched out sideways: the maker's figure is for the whole reach.
  calib::JointVector stretched = calib::JointVector::Zero();
  stretched[1] = 0.5 * std::numbers::pi;
  std::vector<Eigen::Vector3d> tips;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < 2000; ++i) {
    begin_search(plant, world, chance);
    tips.push_back(true_tip_m(plant, world, stretched));
    mean += tips.back() / 2000.0;
  }
  // ISO 9283: mean distance from the mean place and three of its standard deviations.
  double sum = 0.0, squares = 0.0;
  for (const Eigen::Vector3d& tip : tips) {
    const double distance_m = (tip - mean).norm();
    sum += distance_m;
    squares += distance_m * distance_m;
  }
  const double mean_m = sum / 2000.0;
  const double repeatability_m = mean_m + 3.0 * std::sqrt(squares / 2000.0 - mean_m * mean_m);
  EXPECT_GT(repeatability_m, 20e-6);
  EXPECT_LT(repeatability_m, 40e-6);
}

TEST(World, EncodersReadToTheirStep) {
  cell::Truth truth;
  const calib::JointVector joints = calib::JointVector::LinSpaced(-1.23456789, 2.3456789);
  EXPECT_EQ(encoder_reading(quiet_plant(truth), joints), joints);
  truth.encoder_step_rad = calib::radians_from_degrees(1e-4);
  const calib::JointVector read = encoder_reading(quiet_plant(truth), joints);
  EXPECT_GT((read - joints).cwiseAbs().maxCoeff(), 0.0);
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    const double steps = read[joint] / truth.encoder_step_rad;
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
    EXPECT_LE(std::abs(read[joint] - joints[joint]), 0.5001 * truth.encoder_step_rad);
  }
}

}  // namespace
}  // namespace sim
