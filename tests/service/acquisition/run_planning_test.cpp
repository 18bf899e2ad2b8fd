#include "service/acquisition/run_planning.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

class RunPlanningTest : public ::testing::Test, public OwnersBench {
 protected:
  RunPlanningTest() { status.enter(State::kStarting); }

  ActiveRun active_ = begun_run();
  std::optional<BlockPose> place_;
  PlanCache plans_{io.get_executor(), io.get_executor(), cell_of_owners()};
  RunPlanning planning_{cell_of_owners(), place_, queue, plans_, preparation, status, wake};
};

TEST_F(RunPlanningTest, TheRunTheStoreAndThePreparationFollowTheSamePlan) {
  run(plans_.plan("few"));
  EXPECT_TRUE(run(planning_.plan(active_)));
  EXPECT_EQ(active_.run.next()->joints, plan_of_owners().touches.touches[0].joints);
  EXPECT_EQ(store.run(active_.run.id()).value().plan_id, plan_of_owners().id);
  EXPECT_EQ(preparation.aim().touch_count(), 0u);
  EXPECT_FALSE(active_.place_check) << "the block was not located";
}

TEST_F(RunPlanningTest, ALocatedBlockIsCheckedInTheRun) {
  run(plans_.plan("few"));
  place_.emplace();
  place_->cell_from_block.setIdentity();
  EXPECT_TRUE(run(planning_.plan(active_)));
  EXPECT_TRUE(active_.place_check);
}

TEST_F(RunPlanningTest, APlanThatALockKeepsFromBeingStoredHoldsTheRunUntilItIsGone) {
  run(plans_.plan("few"));
  SQLite::Database other((folder.path() / "touchcal.sqlite").string(), SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  EXPECT_FALSE(run(planning_.plan(active_)));
  EXPECT_GE(time.since_begin(), kLockPatience) << "it was waited for";
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(faults, ::testing::ElementsAre("store_failed"));
  EXPECT_FALSE(active_.run.next()) << "it has no plan: it is planned again";
  other.exec("ROLLBACK");
  status.enter(State::kUnholding);
  EXPECT_TRUE(run(planning_.plan(active_)));
  EXPECT_EQ(store.run(active_.run.id()).value().plan_id, plan_of_owners().id);
}

TEST_F(RunPlanningTest, AStopDoesNotWaitForThePlanner) {
  wake.on_wait = [this] { status.enter(State::kStopping); };
  EXPECT_FALSE(run(planning_.plan(active_)));
  EXPECT_EQ(wake.wait_count, 1);
  EXPECT_TRUE(faults.empty());
}

}  // namespace
}  // namespace cell
