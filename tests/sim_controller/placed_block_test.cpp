// The block on its stand: what is touched there, and who may bring it.
#include "sim_controller/placed_block.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.hpp"
#include "cell_with_stand.hpp"
#include "ride.hpp"
#include "whole_path.hpp"

namespace sim::testing {
namespace {

using ::testing::HasSubstr;

constexpr int kTop = 2;

/// What a search at 8 mm/s goes in a latch step.
constexpr double kTripStepMetres = 1.01 * 0.008 * kLatchSeconds;

Plant quiet_at_stand(const cell::Truth& truth) {
  Plant plant = make_plants(cell_with_stand(), truth).at(kStand);
  plant.touch_noise_m = 0.0;
  plant.hidden.repeatability_rad.setZero();
  return plant;
}

/// Where the ball of the nominal arm is when the touch trips, above the contact plane as the daemon knows it.
double early_at_stand_m(const cell::Truth& truth, int face) {
  const AimedTouch touch = touch_on_stand(face);
  Ride ride(quiet_at_stand(truth));
  const auto joints = ride.search(touch.motion);
  EXPECT_TRUE(joints) << face << ride.collision;
  return calib::signed_distance_m(touch.contact_plane,
                                  tip_m(cell_at_stand().arm.model, joints.value_or(touch.motion.search_end)));
}

const calib::Box& obstacle(const Plant& plant, const std::string& name) {
  return *std::ranges::find(plant.scene.obstacles, name, &calib::Box::name);
}

TEST(PlacedBlock, IsTouchedOnItsStandWhereTheDaemonHasItsFaces) {
  for (const int face : {0, 1, 2}) {  // the fourth looks away from the arm there
    const double early_m = early_at_stand_m({}, face);
    EXPECT_LE(early_m, 1e-8) << face;
    EXPECT_GE(early_m, -kTripStepMetres) << face;
  }
}

TEST(PlacedBlock, KeepsItsTrueOffsetsAndHasThoseOfThePlaceBesideThem) {
  cell::Truth truth;
  truth.face_offsets_m = {0.0, 0.0, 0.4e-3, 0.0, 0.0};
  truth.places = {{.name = kStand, .shift_m = {0.0, -1e-3, 0.0}}};  // up
  EXPECT_NEAR(early_at_stand_m(truth, kTop), 1.4e-3, kTripStepMetres);
  truth.places[0].turn_rad = {2e-3, 0.0, 0.0};  // about its own origin, 150 mm below the middle of the top
  EXPECT_NEAR(early_at_stand_m(truth, kTop), 1.4e-3, 10.0 * kTripStepMetres);
}

TEST(PlacedBlock, StandsHigherByWhatItsWarmthMakesOfTheStep) {
  cell::Truth truth;
  truth.warming.block_warmer_k = 10.0;
  const double of_cube_m = 0.15 * 10.0 * 2.36e-5, of_step_m = 0.3 * 10.0 * 2.36e-5;
  EXPECT_NEAR(early_at_stand_m(truth, kTop), of_cube_m + of_step_m, kTripStepMetres);
}

TEST(PlacedBlock, LeavesPlateAndTableWhereTheyAre) {
  cell::Truth truth;
  truth.face_offsets_m = {0.0, 0.0, 0.0, 0.0, 1e-3};
  const PlantByPlace plants = make_plants(cell_with_stand(), truth);
  const Plant &first = plants.at(cell::kFirstPlace), &there = plants.at(kStand);
  ASSERT_EQ(plants.size(), 2U);
  EXPECT_EQ(obstacle(there, "block").min_m, obstacle(first, "block").min_m);
  for (const char* name : {"plate", "table"})
    EXPECT_NEAR(obstacle(there, name).min_m.y(), obstacle(first, name).min_m.y() + 0.3, 1e-9) << name;
  EXPECT_EQ(make_plants(read_cell("edf"), {}).size(), 1U) << "a block without further places";
  truth.places = {{.name = "shelf"}};
  EXPECT_THROW(make_plants(cell_with_stand(), truth), std::exception);
}

/// A controller whose arm rests at its start posture.
class BroughtBlock : public ::testing::Test {
 protected:
  std::string refusal(const std::string& place) {
    return bring_block(plants_, place, bench_.plant, bench_.state.cabinet).value_or("");
  }
  const PlantByPlace plants_ = make_plants(cell_with_stand(), {});
  Bench bench_ = Bench::ready(plants_.at(cell::kFirstPlace), {.speed = kSpeedMax});
};

TEST_F(BroughtBlock, IsTouchedWhereItStandsNow) {
  const cs8::Touch on_stand = touch_command(touch_on_stand(kTop).motion);
  EXPECT_EQ(refusal(kStand), "");
  bench_.send(1, on_stand);
  EXPECT_EQ(bench_.result<cs8::TouchResult>().outcome, cs8::Outcome::kContact);
  EXPECT_EQ(refusal(cell::kFirstPlace), "") << "the arm is back in the air";
  bench_.send(0, cs8::ResultAcknowledge{1});
  bench_.send(2, on_stand);
  EXPECT_EQ(bench_.result<cs8::TouchResult>().outcome, cs8::Outcome::kNoContact);
}

TEST_F(BroughtBlock, HasOnlyThePlacesOfItsFile) {
  EXPECT_EQ(refusal("shelf"), R"(the block has no place "shelf"; give one of "first", "stand")");
}

TEST_F(BroughtBlock, StaysWhileTheArmMovesOrWhereTheArmIsInTheWay) {
  Bench slow = Bench::ready(plants_.at(cell::kFirstPlace), {.speed = 1.0});
  slow.send(1, travel_command(slow.plant.start_joints + calib::JointVector::Constant(0.1)));
  slow.pass(milliseconds(100));
  EXPECT_EQ(bring_block(plants_, kStand, slow.plant, slow.state.cabinet), "the arm moves");

  const AimedTouch over_top = aimed_touch(cell_with_stand(), {.face = kTop, .tilt_rad = 0.1});
  Bench above = Bench::ready(plants_.at(cell::kFirstPlace), {.speed = kSpeedMax});
  above.send(1, travel_command(over_top.motion.waypoints.back()));
  above.result<cs8::MoveResult>();
  EXPECT_THAT(bring_block(plants_, kStand, above.plant, above.state.cabinet).value_or(""),
              HasSubstr("the arm is in the way: "));
  EXPECT_NEAR(obstacle(above.plant, "plate").min_m.y(), 0.0, 1e-12) << "nothing has moved";
}

}  // namespace
}  // namespace sim::testing
