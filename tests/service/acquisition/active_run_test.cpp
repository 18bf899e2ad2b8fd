#include "service/acquisition/active_run.hpp"

#include <gtest/gtest.h>

#include "service/run/calibrated_arm.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

class ActiveRunTest : public ::testing::Test, public OwnersBench {
 protected:
  /// All touches of Table III, exact.
  ActiveRun touched_run() {
    ActiveRun active = begun_run("edf-25");
    int number = 0;
    for (const calib::Touch& touch : table3_touches())
      active.run.add(
          {.number = ++number, .plane = touch.face + 1, .role = touch.role, .joints = to_wire(touch.joints)});
    active.run.identify();
    return active;
  }
};

TEST_F(ActiveRunTest, OutcomesHaveTheWordsOfTheStore) {
  EXPECT_EQ(run_outcome_name(RunOutcome::kComplete), "complete");
  EXPECT_EQ(run_outcome_name(RunOutcome::kStopped), "stopped");
  EXPECT_EQ(run_outcome_name(RunOutcome::kAborted), "aborted");
  EXPECT_EQ(run_outcome_name(RunOutcome::kInterrupted), "interrupted");
}

TEST_F(ActiveRunTest, OnlyACompleteRunIsJudged) {
  ActiveRun active = touched_run();
  for (const RunOutcome outcome : {RunOutcome::kStopped, RunOutcome::kAborted, RunOutcome::kInterrupted}) {
    EXPECT_EQ(conclude(active, outcome, regions), Verdict::kIncomplete);
    EXPECT_FALSE(active.finished);
  }
  EXPECT_NE(conclude(active, RunOutcome::kComplete, regions), Verdict::kIncomplete);
  EXPECT_TRUE(active.finished);
}

TEST_F(ActiveRunTest, TheArmOfARunIsThatOfItsLatestResult) {
  EXPECT_FALSE(arm_json(planned_run(), cell_of_owners()));
  const ActiveRun active = touched_run();
  EXPECT_EQ(arm_json(active, cell_of_owners()),
            calibrated_arm_document(cell_of_owners(), active.run.latest()));
}

TEST_F(ActiveRunTest, ARunWithATouchLeftOutOrWithoutAResultIsIncomplete) {
  ActiveRun untouched = planned_run();
  EXPECT_EQ(conclude(untouched, RunOutcome::kComplete, regions), Verdict::kIncomplete);
  EXPECT_FALSE(result_json(untouched, regions));
  ActiveRun active = touched_run();
  active.run.set_plan(plan_of_owners().touches);
  active.run.skip_next();
  EXPECT_TRUE(active.run.skipped_count() == 0 ||
              conclude(active, RunOutcome::kComplete, regions) == Verdict::kIncomplete);
  EXPECT_TRUE(result_json(active, regions)) << "what was identified is there to be read";
}

}  // namespace
}  // namespace cell
