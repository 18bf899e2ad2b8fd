#include "service/acquisition/touch_preparation.hpp"

#include <gtest/gtest.h>

#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

class TouchPreparationTest : public ::testing::Test, public OwnersBench {
 protected:
  /// The touch that was sent last is met where it is planned.
  void meet() {
    const int number = active_.run.touches_done() + 1;
    const calib::PlannedTouch& touch = preparation.made()->touch;
    active_.run.add(
        {.number = number, .plane = touch.face + 1, .role = touch.role, .joints = contact().contact});
  }

  ActiveRun active_ = planned_run();
  const calib::JointVector park_ = cell_of_owners().park_joints;
};

TEST_F(TouchPreparationTest, TheFirstTouchIsThePlansOwnAndLeadsFromWhereTheArmStands) {
  ASSERT_TRUE(preparation.prepare_next(active_.run, park_));
  EXPECT_TRUE(preparation.is_ready_from(park_));
  const OutgoingTouch sent = preparation.send_next();
  EXPECT_EQ(sent.touch.face, plan_of_owners().touches.touches[0].face);
  EXPECT_EQ(sent.aimed_with, 0);
  EXPECT_EQ(preparation.made_path().front(), park_);
  EXPECT_EQ(preparation.made_path().back(), sent.touch.search_end_joints);
  EXPECT_FALSE(preparation.is_ready_from(park_)) << "it has left";
}

TEST_F(TouchPreparationTest, TheTouchBehindIsReadyFromTheClearPostureOfTheOneThatIsMade) {
  preparation.prepare_next(active_.run, park_);
  const OutgoingTouch sent = preparation.send_next();
  preparation.look_ahead(active_.run, 1);
  EXPECT_TRUE(preparation.is_ready_from(sent.touch.clear_joints));
}

TEST_F(TouchPreparationTest, WhatWasAimedStaysSoFromAnotherPlace) {
  preparation.prepare_next(active_.run, park_);
  preparation.send_next();
  preparation.look_ahead(active_.run, 1);
  meet();
  ASSERT_TRUE(preparation.reroute_from(park_, *active_.run.next()));
  EXPECT_TRUE(preparation.is_ready_from(park_));
  const OutgoingTouch second = preparation.send_next();
  EXPECT_EQ(second.aimed_with, 0) << "before the first contact was known";
  EXPECT_FALSE(preparation.reroute_from(park_, *active_.run.next())) << "nothing is prepared";
}

TEST_F(TouchPreparationTest, ATouchThatMissedComesAgainWithTheNominalMiss) {
  preparation.set_missed(true);
  preparation.prepare_next(active_.run, park_);
  EXPECT_EQ(preparation.send_next().aimed_with, kNominalMiss);
}

TEST_F(TouchPreparationTest, AContactOutsideItsPredictionIsASurprise) {
  preparation.prepare_next(active_.run, park_);
  const OutgoingTouch sent = preparation.send_next();
  EXPECT_FALSE(preparation.is_surprise(sent.touch.joints));
  EXPECT_TRUE(preparation.is_surprise(sent.touch.clear_joints));
}

TEST_F(TouchPreparationTest, TheAimKnowsEachContactOnce) {
  preparation.prepare_next(active_.run, park_);
  preparation.send_next();
  meet();
  EXPECT_FALSE(preparation.add_contacts(active_.run));
  EXPECT_EQ(preparation.aim().touch_count(), 1u);
  preparation.add_contacts(active_.run);
  EXPECT_EQ(preparation.aim().touch_count(), 1u);
  preparation.restart_aim();
  EXPECT_EQ(preparation.aim().touch_count(), 0u);
}

TEST_F(TouchPreparationTest, AnArmThatIsNowhereItWasLedLeavesWithNothingKnown) {
  preparation.prepare_next(active_.run, park_);
  const OutgoingTouch sent = preparation.send_next();
  EXPECT_NE(preparation.leaving(sent.touch.clear_joints).made_with, nullptr);
  EXPECT_NE(preparation.leaving(sent.touch.approach_joints).made_with, nullptr) << "it is on the way";
  EXPECT_EQ(preparation.leaving(calib::JointVector::Constant(0.3)).made_with, nullptr);
  preparation.forget_made();
  EXPECT_EQ(preparation.leaving(sent.touch.clear_joints).made_with, nullptr);
}

}  // namespace
}  // namespace cell
