// The balls of a star stylus: which of them trips, and where.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.hpp"
#include "sim_controller/contact.hpp"
#include "star_cell.hpp"

namespace sim::testing {
namespace {

constexpr int kTopFace = 2;
/// Slow enough for a micrometre.
constexpr double kSlowMetresPerSecond = 0.002;
/// What that goes in a latch step, and what the true arm goes beyond the nominal one.
constexpr double kSlowStepMetres = 1.02 * kSlowMetresPerSecond * kLatchSeconds;

const TipTouch& left_on_top() {
  static const TipTouch touch = touch_with(tip_named("left"), kTopFace);
  return touch;
}

/// The commanded joints of a trip; the touch must be met, and nothing else.
calib::JointVector slow_trip(Ride& ride, const TipTouch& touch) {
  const auto joints = ride.search(touch.approach, touch.search_end, kSlowMetresPerSecond);
  EXPECT_TRUE(joints);
  EXPECT_EQ(ride.collision, "");
  return joints.value_or(touch.search_end);
}

/// The first body that hits something, in a search that nothing stops; "" for none.
std::string until_collision(Ride& ride, const TipTouch& touch) {
  ride.put(touch.approach);
  movel(ride.plant, ride.drives, touch.search_end, 0.008);
  while (!is_empty(ride.drives)) {
    const Sensed seen = ride.tick();
    ride.edges += seen.edges;
    if (seen.collision) return *seen.collision;
  }
  return "";
}

/// How much earlier than by the files the left ball of a nominal arm trips on the block's top.
double left_early_m(const cell::Truth& truth) {
  Ride ride(quiet_star(truth));
  const calib::JointVector at = slow_trip(ride, left_on_top());
  const Eigen::Vector3d ball_m = calib::forward_kinematics(star().arm.model, at) * tip_named("left").center_m;
  const double file_trip_m = 2e-3 - 10e-6;
  return calib::signed_distance_m(left_on_top().face.plane, ball_m) - file_trip_m;
}

TEST(StarStylus, TripsWhereTheTrueBallIsItsRadiusLessThePretravelFromTheFace) {
  // The file's truth and probe, by hand, in mm: 30, 0, -45 and 0, -30, -45 with their shifts.
  const Eigen::Vector3d left_m(30.28e-3, -0.17e-3, -44.86e-3), back_m(-0.24e-3, -30.18e-3, -45.22e-3);
  const auto expect_trip = [](const char* tip, const Eigen::Vector3d& center_m, double radius_m, int face) {
    const TipTouch touch = touch_with(tip_named(tip), face);
    Ride ride(quiet_star(star_truth()));
    const calib::JointVector at = slow_trip(ride, touch);
    const Eigen::Vector3d ball_m = calib::forward_kinematics(ride.plant.truth, at) * center_m;
    const double late_m = radius_m - 10e-6 - calib::signed_distance_m(touch.face.plane, ball_m);
    EXPECT_GE(late_m, -1e-9) << tip << face;
    EXPECT_LE(late_m, kSlowStepMetres) << tip << face;
  };
  for (const int face : {0, kTopFace, 4}) expect_trip("left", left_m, 2.003e-3, face);
  for (const int face : {0, kTopFace}) expect_trip("back", back_m, 1.996e-3, face);
}

TEST(StarStylus, TripsEarlierByTheShiftOfItsBallAlongTheSearch) {
  EXPECT_NEAR(left_early_m({}), 0.0, kSlowStepMetres);
  cell::Truth truth;
  truth.tips = {
      {.name = "left", .shift_m = {0.3e-3, 0.0, 0.0}}};  // along the stem, 25 degrees off the search
  EXPECT_NEAR(left_early_m(truth), 0.3e-3 * std::cos(kLeanRad), kSlowStepMetres);
  truth.tips[0].radius_m = 2.1e-3;
  EXPECT_NEAR(left_early_m(truth), 0.3e-3 * std::cos(kLeanRad) + 0.1e-3, kSlowStepMetres);
  truth.tips = {{.name = "right", .shift_m = {0.3e-3, 0.0, 0.0}}};
  EXPECT_NEAR(left_early_m(truth), 0.0, kSlowStepMetres) << "another ball";
}

TEST(StarStylus, HasThePretravelOfThePushInFrame7) {
  cell::Truth truth;
  truth.probe.pretravel_m = 20e-6;       // 10 um more than the file has
  truth.probe.pretravel_tilt_m = 80e-6;  // of a push across; this one is 65 degrees off the stylus axis
  EXPECT_NEAR(left_early_m(truth), -10e-6 - std::pow(std::sin(calib::radians_from_degrees(65.0)), 2) * 80e-6,
              kSlowStepMetres);
}

TEST(StarStylus, TripsByTheBallThatTouchesWhileTheFirstOneIsInTheAir) {
  Ride ride(quiet_star({}));
  const calib::JointVector at = slow_trip(ride, left_on_top());
  const Eigen::Isometry3d tool = calib::forward_kinematics(ride.plant.truth, at);
  for (const calib::Box& solid : ride.plant.scene.obstacles)
    EXPECT_GT(box_distance_m(solid, tool.translation()), 9e-3) << solid.name;
  ride.plant.tips.clear();
  ride.edges = 0;
  EXPECT_EQ(until_collision(ride, left_on_top()), "left stem hit block");
  EXPECT_EQ(ride.edges, 0);
}

TEST(StarStylus, TouchesWithItsFirstBallAsAProbeWithOne) {
  const cell::Cell one_tip = read_cell("demo");
  const AimedTouch touch = aimed_touch(one_tip, {.face = kTopFace, .tilt_rad = 0.1});
  Ride with_one(make_plant(one_tip, star_truth().errors)), with_star(quiet_star(star_truth()));
  with_one.plant.touch_noise_m = 0.0;
  const auto expected = with_one.search(touch.motion);
  ASSERT_TRUE(expected);
  EXPECT_EQ(with_star.search(touch.motion), expected);
}

TEST(StarStylus, CollidesWithAStemThatMeetsSomethingBesideItsBall) {
  Ride ride(quiet_star({}));
  const TipTouch& touch = left_on_top();
  const Eigen::Isometry3d tool = calib::forward_kinematics(ride.plant.truth, touch.approach);
  const Eigen::Vector3d under_m =
      tool * Eigen::Vector3d(20e-3, 0.0, -45e-3) + 7e-3 * tool.linear() * touch.way_in_tool;
  const Eigen::Vector3d half_m = Eigen::Vector3d::Constant(1e-3);
  ride.plant.scene.obstacles = {{"peg", under_m - half_m, under_m + half_m}};
  EXPECT_EQ(until_collision(ride, touch), "left stem hit peg");
  EXPECT_EQ(ride.edges, 0);
}

TEST(StarStylus, YieldsUpToItsOvertravel) {
  Ride ride(quiet_star({}));
  const TipTouch& touch = left_on_top();
  ride.world.probe.troubles.stylus = StylusTrouble::kNeverTouches;
  EXPECT_THAT(until_collision(ride, touch), ::testing::EndsWith(" hit block"));
  const Eigen::Vector3d ball_m =
      calib::forward_kinematics(ride.plant.nominal, ride.last.to) * tip_named("left").center_m;
  const double depth_m = 1.99e-3 - calib::signed_distance_m(touch.face.plane, ball_m);
  EXPECT_NEAR(depth_m, ride.plant.overtravel_m, 2.0 * 0.008 * kTickSeconds);
}

TEST(StarStylus, HasLeversThatBoundTheMotionOfEveryBall) {
  Plant plant = make_plant(star(), star_truth());
  plant.tips.push_back({{0.1, 0.0, 0.17}, 2e-3});  // farther out than the first one
  const World world = make_world(plant);
  std::mt19937_64 chance(3);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  double closest = 0.0;
  for (int sample = 0; sample < 2000; ++sample) {
    calib::JointVector from, turn;
    for (int joint = 0; joint < calib::kJointCount; ++joint) {
      from[joint] = 2.0 * anywhere(chance);
      turn[joint] = sample % 7 == 6 || sample % 7 == joint ? 1e-3 * anywhere(chance) : 0.0;
    }
    const Eigen::Isometry3d before = true_chain(plant, world, from).block_from_frame.back();
    const Eigen::Isometry3d after = true_chain(plant, world, from + turn).block_from_frame.back();
    const double bound_m = world.tip_levers_m.dot(turn.cwiseAbs());
    for (const TipBall& tip : plant.tips) {
      const double way_m = (after * tip.center_m - before * tip.center_m).norm();
      EXPECT_LE(way_m, bound_m);
      closest = std::max(closest, way_m / bound_m);
    }
  }
  EXPECT_GT(closest, 0.5) << "bounds that are much too wide cost time";
}

/// What is remembered of free ways must never change what is seen.
TEST(StarStylus, SeesTheSameWhenTheWorldLooksAtEveryStep) {
  const Plant plant = make_plant(star(), star_truth());
  std::mt19937_64 chance(5);
  std::uniform_real_distribution<double> turn(-0.02, 0.02);
  int touched = 0, hits = 0;
  const TipTouch& touch = left_on_top();
  Drives drives{.joints = touch.search_end};
  World world = make_world(plant);
  for (int move = 0; move < 150; ++move) {
    calib::JointVector target = 0.5 * (touch.approach + touch.search_end);
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
  EXPECT_GT(touched, 10) << "the moves meet too little";
  EXPECT_GT(hits, 0);
}

TEST(StarStylus, IsAtEveryPlaceOfTheBlockTheSame) {
  const PlantByPlace plants = make_plants(star(), star_truth());
  ASSERT_EQ(plants.size(), 2U);
  const std::vector<TipBall>& first = plants.at(cell::kFirstPlace).tips;
  const std::vector<TipBall>& there = plants.at("stand").tips;
  ASSERT_EQ(first.size(), 4U);
  ASSERT_EQ(there.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(there[i].center_m, first[i].center_m);
  cell::Truth truth;
  truth.tips = {{.name = "up"}};
  EXPECT_THROW(make_plants(star(), truth), cell::ConfigError);
}

}  // namespace
}  // namespace sim::testing
