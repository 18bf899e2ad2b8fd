// What probe and bodies of the world meet.
#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "quiet_cell.hpp"
#include "ride.hpp"
#include "whole_path.hpp"

namespace sim {
namespace {

using namespace testing;

TEST(World, LetsGoOfTheBallOnTheWayBackAndTripsAgain) {
  const AimedTouch touch = aimed_touch(demo(), {});
  Ride ride(quiet_plant(real_truth()));
  for (int again = 0; again < 3; ++again) {
    ASSERT_TRUE(ride.search(touch.motion));
    EXPECT_EQ(ride.world.probe.inputs, (ProbeInputs{true, false}));
    movel(ride.plant, ride.drives, ride.drives.joints, 0.008);
    reset_motion(ride.drives);
    while (!is_settled(ride.drives)) ride.tick();
    EXPECT_TRUE(ride.world.deflected);
    ride.go(touch.motion.approach, 0.02);
    EXPECT_EQ(ride.world.probe.inputs, ProbeInputs{});
  }
  EXPECT_EQ(ride.edges, 3);
  EXPECT_EQ(ride.collision, "");
}

TEST(World, AProbeThatNeverTouchesEndsWithItsStemInTheBlock) {
  const AimedTouch touch = aimed_touch(demo(), {.tilt_rad = 0.0});
  Ride ride(quiet_plant({}));
  ride.world.probe.troubles.stylus = StylusTrouble::kNeverTouches;
  EXPECT_FALSE(ride.search(touch.motion));
  EXPECT_EQ(ride.collision, "stem hit block");
  EXPECT_EQ(ride.edges, 0);
}

TEST(World, AStylusYieldsUpToItsOvertravel) {
  const AimedTouch touch = aimed_touch(demo(), {.tilt_rad = 0.0});
  Ride ride(quiet_plant({}));
  ride.world.probe.troubles.stylus = StylusTrouble::kNeverTouches;
  ride.put(touch.motion.approach);
  movel(ride.plant, ride.drives, touch.motion.search_end, 0.008);
  Sensed seen;
  while (!is_empty(ride.drives) && !seen.collision) seen = ride.tick();
  ASSERT_TRUE(seen.collision);
  const double depth_m =
      -calib::signed_distance_m(touch.contact_plane, tip_m(ride.plant.nominal, ride.last.to));
  EXPECT_NEAR(depth_m, ride.plant.overtravel_m, 2.0 * 0.008 * kTickSeconds);
}

TEST(World, SeesABodyHitWithinATickOfWhereItDoes) {
  Plant plant = testing::true_plant("demo");
  const calib::JointVector target = plant.start_joints + calib::JointVector::Constant(0.4);
  const Path path{plant.start_joints, target};
  const Eigen::Vector3d holder_m =
      calib::forward_kinematics(plant.truth, posture(path, 0.8)) * Eigen::Vector3d(0.0, 0.0, -0.15);
  plant.scene.obstacles = {
      {"shelf", holder_m - Eigen::Vector3d::Constant(0.01), holder_m + Eigen::Vector3d::Constant(0.01)}};
  Ride ride(plant);
  const auto hit = testing::find_hit(plant, path, 1.0);
  ASSERT_TRUE(hit);
  movej(plant, ride.drives, target, 0.25);
  Sensed seen;
  while (!is_empty(ride.drives) && !seen.collision) seen = ride.tick();
  ASSERT_TRUE(seen.collision);
  EXPECT_EQ(*seen.collision, hit->clash.body + " hit " + hit->clash.other);
  const double away_m =
      (tip_m(plant.nominal, ride.last.to) - tip_m(plant.nominal, posture(path, hit->progress))).norm();
  EXPECT_LE(away_m, 0.25 * kTickSeconds + testing::kCollisionStepMetres);
}

TEST(World, AnArmThatIsPutElsewhereFeelsWhatIsThere) {
  const AimedTouch touch = aimed_touch(demo(), {});
  Ride ride(quiet_plant({}));
  EXPECT_EQ(ride.tick().inputs, ProbeInputs{});
  Eigen::Isometry3d deeper = calib::forward_kinematics(ride.plant.nominal, touch.motion.approach);
  deeper.translation() -= (testing::kStandoffMetres + 1e-4) * touch.face.plane.outward;
  ride.put(*calib::solve_near(ride.plant.nominal, deeper, touch.motion.approach));
  EXPECT_EQ(ride.tick().inputs, (ProbeInputs{true, false}));
  ride.put(ride.plant.start_joints);
  EXPECT_EQ(ride.tick().inputs, ProbeInputs{});
}

/// What is remembered of free ways must never change what is seen.
TEST(World, SeesTheSameWhenItLooksAtEveryStep) {
  const Plant plant = make_plant(demo(), real_truth());
  std::mt19937_64 chance(5);
  std::uniform_real_distribution<double> turn(-0.02, 0.02);
  int touched = 0, hits = 0;
  for (int face = 0; face < 5; ++face) {
    const AimedTouch touch = aimed_touch(demo(), {.face = face, .tilt_rad = 0.6});
    Drives drives{.joints = touch.motion.search_end};
    World world = make_world(plant);
    for (int move = 0; move < 25; ++move) {
      calib::JointVector target = 0.5 * (touch.motion.approach + touch.motion.search_end);
      for (int joint = 0; joint < calib::kJointCount; ++joint) target[joint] += turn(chance);
      begin_search(plant, world, chance);
      movej(plant, drives, target, 0.1);
      while (!is_empty(drives)) {
        const Sensed seen = sense_as_by_looking(plant, world, tick(drives, 100.0, true));
        ASSERT_FALSE(::testing::Test::HasFailure());
        touched += seen.edges;
        hits += seen.collision.has_value();
      }
    }
  }
  EXPECT_GT(touched, 20) << "the moves meet too little";
  EXPECT_GT(hits, 0);
}

}  // namespace
}  // namespace sim
