#include "service/store/run_outcome.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(RunOutcome, NamesAreThoseOfTheDatabaseAndTheApi) {
  EXPECT_EQ(run_outcome_name(RunOutcome::kRunning), "running");
  EXPECT_EQ(run_outcome_name(RunOutcome::kComplete), "complete");
  EXPECT_EQ(run_outcome_name(RunOutcome::kStopped), "stopped");
  EXPECT_EQ(run_outcome_name(RunOutcome::kAborted), "aborted");
  EXPECT_EQ(run_outcome_name(RunOutcome::kInterrupted), "interrupted");
}

TEST(RunOutcome, EveryNameLeadsBackAndAnotherTextToNothing) {
  for (int i = 0; i <= static_cast<int>(RunOutcome::kInterrupted); ++i) {
    const auto outcome = static_cast<RunOutcome>(i);
    EXPECT_EQ(run_outcome_named(run_outcome_name(outcome)), outcome);
  }
  for (int i = 0; i <= static_cast<int>(Verdict::kIncomplete); ++i) {
    const auto verdict = static_cast<Verdict>(i);
    EXPECT_EQ(verdict_named(verdict_name(verdict)), verdict);
  }
  EXPECT_EQ(run_outcome_named("over"), std::nullopt);
  EXPECT_EQ(verdict_named(""), std::nullopt);
}

}  // namespace
}  // namespace cell
