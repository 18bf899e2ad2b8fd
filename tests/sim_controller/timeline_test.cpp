#include "sim_controller/timeline.hpp"

#include <gtest/gtest.h>

#include "aimed_touch.hpp"
#include "sim_controller/contact.hpp"

namespace sim {
namespace {

using cs8::Outcome;
using cs8::Phase;
using testing::aimed_touch;
using testing::tip_m;

calib::JointVector degrees(std::array<double, 6> values) {
  calib::JointVector joints;
  for (std::size_t i = 0; i < 6; ++i)
    joints[static_cast<Eigen::Index>(i)] = calib::radians_from_degrees(values[i]);
  return joints;
}

std::vector<Phase> phases(const Timeline& timeline) {
  std::vector<Phase> list;
  for (const Leg& leg : timeline.legs) list.push_back(leg.phase);
  return list;
}

TEST(Touch, TravelsApproachesSearchesAndGoesBackToItsClearPosture) {
  const Plant plant = testing::true_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {});
  const Timeline timeline = touch_timeline(plant, plant.start_joints, touch.motion, 0.0);
  EXPECT_EQ(timeline.outcome, Outcome::kContact);
  EXPECT_EQ(timeline.phase, Phase::kIdle);
  EXPECT_EQ(phases(timeline), (std::vector{Phase::kTravel, Phase::kApproach, Phase::kSearch, Phase::kRetract,
                                           Phase::kRetract}));
  EXPECT_TRUE(timeline.way_out.empty());
  const Place end = place_at(timeline, timeline.duration_s(), plant.start_joints);
  EXPECT_LT((end.joints - touch.motion.waypoints.back()).norm(), 1e-12);
  EXPECT_GT(trip_gap_m(plant, end.joints, 0.0), 0.0);
}

TEST(Touch, StopsBehindTheEdgeByTheStoppingDistance) {
  const Plant plant = testing::true_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {});
  const Timeline timeline = touch_timeline(plant, plant.start_joints, touch.motion, 0.0);
  ASSERT_TRUE(timeline.capture);
  const double expected_m = stopping_distance_m(touch.motion.search_speed_m_s, kStopLatencySeconds);
  EXPECT_NEAR(timeline.capture->overtravel_m, expected_m, 1e-7);
  EXPECT_NEAR(tip_distance_m(plant, timeline.capture->contact, timeline.capture->stopped), expected_m, 1e-7);
}

TEST(Touch, WhoseArmStopsTooLateIsOvertravel) {
  Plant plant = testing::true_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {});
  plant.stop_latency_s = 1.1 * plant.overtravel_m / touch.motion.search_speed_m_s;
  const Timeline timeline = touch_timeline(plant, plant.start_joints, touch.motion, 0.0);
  EXPECT_EQ(timeline.outcome, Outcome::kOvertravel);
  EXPECT_TRUE(timeline.capture);
}

TEST(Touch, ThatMeetsTheFaceInItsApproachIsUnexpectedAndKnowsTheWayBackToClear) {
  const cell::Cell cell = testing::read_cell("demo");
  const Plant plant = testing::true_plant("demo");
  auto touch = aimed_touch(cell, {});
  touch.motion.approach = touch.motion.search_end;
  const Timeline timeline = touch_timeline(plant, plant.start_joints, touch.motion, 0.0);
  EXPECT_EQ(timeline.outcome, Outcome::kUnexpectedContact);
  EXPECT_EQ(timeline.phase, Phase::kApproach);
  EXPECT_FALSE(timeline.capture);
  const calib::JointVector end = place_at(timeline, timeline.duration_s(), plant.start_joints).joints;
  EXPECT_LE(trip_gap_m(plant, end, 0.0), 0.0);
  EXPECT_GT(trip_gap_m(plant, end, 0.0), -1e-8);
  ASSERT_EQ(timeline.way_out.size(), 1u);
  EXPECT_LT((timeline.way_out.front().at(1.0) - touch.motion.waypoints.back()).norm(), 1e-12);
}

TEST(Travel, ThatMeetsTheBlockIsUnexpectedAndKnowsNoWayBack) {
  const Plant plant = testing::true_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {});
  const Timeline timeline = travel_timeline(plant, plant.start_joints, {touch.motion.search_end}, 0.25);
  EXPECT_EQ(timeline.outcome, Outcome::kUnexpectedContact);
  EXPECT_EQ(timeline.phase, Phase::kTravel);
  EXPECT_TRUE(timeline.way_out.empty());
}

TEST(Travel, ThatBringsTheForearmIntoTheTableIsACollisionThatNamesBoth) {
  const Plant plant = testing::true_plant("demo");
  const calib::JointVector aside = degrees({60, 0, 60, 0, 90, 0});
  const calib::JointVector low = degrees({60, 130, 0, 0, -100, 0});
  const Timeline timeline = travel_timeline(plant, plant.start_joints, {aside, low}, 0.25);
  EXPECT_EQ(timeline.outcome, Outcome::kCollision);
  EXPECT_EQ(timeline.phase, Phase::kTravel);
  EXPECT_EQ(timeline.collision, "forearm hit table");
  const calib::JointVector end = place_at(timeline, timeline.duration_s(), plant.start_joints).joints;
  EXPECT_TRUE(calib::find_clash(plant.scene, calib::forward_chain(plant.truth, end), 0.0));
  EXPECT_FALSE(calib::find_clash(
      plant.scene, calib::forward_chain(plant.truth, timeline.legs.back().stretch.at(0.97)), 0.0));
}

TEST(Touch, WhoseStemMeetsSomethingBeforeTheBallIsACollision) {
  const cell::Cell cell = testing::read_cell("demo");
  Plant plant = testing::perfect_plant("demo");
  const auto touch = aimed_touch(cell, {.tilt_rad = 0.5});
  const Eigen::Isometry3d tool = calib::forward_kinematics(plant.truth, touch.motion.approach);
  const Eigen::Vector3d on_stem = tool * Eigen::Vector3d(0, 0, -0.03) + 0.010 * -touch.face.plane.outward;
  plant.scene.obstacles = {
      {"peg", on_stem - Eigen::Vector3d::Constant(0.0005), on_stem + Eigen::Vector3d::Constant(0.0005)}};
  const Timeline timeline = touch_timeline(plant, touch.motion.waypoints.back(), touch.motion, 0.0);
  EXPECT_EQ(timeline.outcome, Outcome::kCollision);
  EXPECT_EQ(timeline.phase, Phase::kSearch);
  EXPECT_EQ(timeline.collision, "stem hit peg");
  EXPECT_FALSE(timeline.capture);
}

TEST(Touch, WhoseLineTheArmCannotFollowIsAMotionErrorWithAWayBack) {
  const Plant plant = testing::perfect_plant("demo");
  auto touch = aimed_touch(testing::read_cell("demo"), {});
  touch.motion.search_end[3] += calib::radians_from_degrees(180);  // the other branch of the wrist
  touch.motion.search_end[4] = -touch.motion.search_end[4];
  touch.motion.search_end[5] += calib::radians_from_degrees(180);
  Plant empty = plant;
  empty.scene.obstacles.clear();
  empty.trip_distance_m = -1.0;
  const Timeline timeline = touch_timeline(empty, touch.motion.waypoints.back(), touch.motion, 0.0);
  EXPECT_EQ(timeline.outcome, Outcome::kMotionError);
  EXPECT_EQ(timeline.error_number, kImpossibleMoveError);
  EXPECT_EQ(timeline.phase, Phase::kSearch);
  EXPECT_EQ(timeline.way_out.size(), 2u);
}

TEST(PlaceAt, MovesThroughThePhasesInTime) {
  const Plant plant = testing::true_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {});
  const Timeline timeline = touch_timeline(plant, plant.start_joints, touch.motion, 0.0);
  double time_s = 0.0;
  for (const Leg& leg : timeline.legs) {
    const Place place = place_at(timeline, time_s + 0.5 * leg.duration_s, plant.start_joints);
    EXPECT_EQ(place.phase, leg.phase);
    EXPECT_NEAR(place.share, 0.5, 1e-9);
    time_s += leg.duration_s;
  }
}

TEST(WayOut, FromAnyPlaceNearTheFaceEndsInTheClearPosture) {
  const Plant plant = testing::true_plant("demo");
  const auto touch = aimed_touch(testing::read_cell("demo"), {});
  const Timeline timeline = touch_timeline(plant, plant.start_joints, touch.motion, 0.0);
  for (std::size_t leg = 0; leg < timeline.legs.size(); ++leg) {
    const auto way = way_out_from(timeline.legs, leg, 0.4);
    if (timeline.legs[leg].phase == Phase::kTravel) {
      EXPECT_TRUE(way.empty());
      continue;
    }
    ASSERT_FALSE(way.empty());
    EXPECT_LT((way.front().at(0.0) - timeline.legs[leg].stretch.at(0.4)).norm(), 1e-12);
    EXPECT_LT((way.back().at(1.0) - touch.motion.waypoints.back()).norm(), 1e-12);
    for (std::size_t i = 0; i + 1 < way.size(); ++i)
      EXPECT_LT((way[i].at(1.0) - way[i + 1].at(0.0)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace sim
