#include "service/acquisition/touch_ways.hpp"

#include <gtest/gtest.h>

#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

class TouchWaysTest : public ::testing::Test, public OwnersBench {
 protected:
  /// The first touch of the plan is commanded.
  void send_first() {
    ASSERT_TRUE(find_way_of_plan(preparation, active_.run, park_).is_there);
    first_ = preparation.send_next().touch;
  }

  ActiveRun active_ = planned_run();
  ReferenceMonitor reference_;
  calib::PlannedTouch first_;
  const calib::JointVector park_ = cell_of_owners().park_joints;
};

TEST_F(TouchWaysTest, TheNextTouchOfThePlanIsReadyWhereThereIsAWayToIt) {
  EXPECT_TRUE(find_way_of_plan(preparation, active_.run, park_).is_there);
  EXPECT_TRUE(preparation.is_ready_from(park_));
}

TEST_F(TouchWaysTest, AnArmInsideTheBlockHasNoWayAndCannotLeave) {
  const calib::JointVector& inside = plan_of_owners().touches.touches[5].search_end_joints;
  const WayOfPlan way = find_way_of_plan(preparation, active_.run, inside);
  EXPECT_FALSE(way.is_there || way.can_leave);
  send_first();
  preparation.forget_made();
  const WayBesidePlan beside =
      find_way_beside_plan(preparation, calib::AimedTouch{first_, preparation.problem()}, inside);
  EXPECT_FALSE(beside.touch || beside.can_leave);
}

TEST_F(TouchWaysTest, BehindTheTouchUnderWayComesTheNextOneOfThePlan) {
  send_first();
  const LookAhead ahead = look_ahead(preparation, active_.run, reference_);
  EXPECT_TRUE(preparation.is_ready_from(first_.clear_joints));
  EXPECT_EQ(preparation.next()->planned, plan_of_owners().touches.touches[1].joints);
  EXPECT_FALSE(ahead.to_reference);
  EXPECT_EQ(ahead.dropped, 0);
}

TEST_F(TouchWaysTest, AContactThatIsNoSurpriseLeavesWhatWasPrepared) {
  send_first();
  look_ahead(preparation, active_.run, reference_);
  const calib::Touch expected{.face = first_.face, .joints = first_.joints};
  const AimBehindContact aim = aim_behind(preparation, active_.run, expected, reference_);
  EXPECT_FALSE(aim.is_surprise || aim.contradicted);
  EXPECT_EQ(preparation.next().value().aimed_with, 0) << "before that contact";
  EXPECT_EQ(preparation.aim().touch_count(), 1U);
}

TEST_F(TouchWaysTest, BehindASurpriseTheNextTouchIsAimedAnew) {
  send_first();
  look_ahead(preparation, active_.run, reference_);
  const calib::JointVector off = first_.joints + 4.0 * (first_.approach_joints - first_.joints);
  const AimBehindContact aim =
      aim_behind(preparation, active_.run, {.face = first_.face, .joints = off}, reference_);
  EXPECT_TRUE(aim.is_surprise);
  EXPECT_TRUE(aim.contradicted || preparation.next().value().aimed_with == 1);
}

}  // namespace
}  // namespace cell
