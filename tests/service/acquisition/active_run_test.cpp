#include "service/acquisition/active_run.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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
    const Conclusion broken_off = conclude(active, outcome, regions);
    EXPECT_EQ(broken_off.verdict, Verdict::kIncomplete);
    EXPECT_FALSE(broken_off.finished);
  }
  const Conclusion complete = conclude(active, RunOutcome::kComplete, regions);
  EXPECT_TRUE(complete.finished);
  const bool accepted = nlohmann::json::parse(complete.result_json.value()).at("verdict").at("accepted");
  EXPECT_EQ(complete.verdict, accepted ? Verdict::kAccepted : Verdict::kRejected);
}

TEST_F(ActiveRunTest, WithoutAnOutcomeItsDocumentsAreThoseOfARunThatGoesOn) {
  ActiveRun active = touched_run();
  for (const bool finished : {false, true}) {
    active.finished = finished;
    const Conclusion as_it_is = conclude(active, std::nullopt, regions);
    EXPECT_EQ(as_it_is.verdict, Verdict::kIncomplete);
    EXPECT_EQ(as_it_is.finished, finished);
    EXPECT_EQ(as_it_is.result_json, result_json(active, regions));
    EXPECT_EQ(as_it_is.arm_json, arm_json(active, cell_of_owners()));
  }
}

TEST_F(ActiveRunTest, TheArmOfARunIsThatOfItsLatestResult) {
  EXPECT_FALSE(arm_json(planned_run(), cell_of_owners()));
  const ActiveRun active = touched_run();
  EXPECT_EQ(arm_json(active, cell_of_owners()),
            calibrated_arm_document(cell_of_owners(), active.run.latest()));
}

TEST_F(ActiveRunTest, ARunWithATouchLeftOutOrWithoutAResultIsIncomplete) {
  const ActiveRun untouched = planned_run();
  EXPECT_EQ(conclude(untouched, RunOutcome::kComplete, regions).verdict, Verdict::kIncomplete);
  EXPECT_FALSE(result_json(untouched, regions));
  ActiveRun active = touched_run();
  active.run.set_plan(plan_of_owners().touches);
  active.run.skip_next();
  EXPECT_TRUE(active.run.skipped_count() == 0 ||
              conclude(active, RunOutcome::kComplete, regions).verdict == Verdict::kIncomplete);
  EXPECT_TRUE(result_json(active, regions)) << "what was identified is there to be read";
}

}  // namespace
}  // namespace cell
