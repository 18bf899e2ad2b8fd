#include "service/store/refused_result.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "service/store/damaged_store.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RefusedResultTest : public ::testing::Test {
 protected:
  static RefusedResult refused(std::uint32_t sequence) {
    return {.session = 7,
            .sequence = sequence,
            .joints = {1, -2'000'000, 3, -4, 180'000'000, -6},
            .reason = "the reported contact cannot belong to the touch that was asked for",
            .at = "2026-01-31T08:15:30.250Z"};
  }
  void end() {
    store_.finish_run(run_,
                      {.outcome = RunOutcome::kAborted, .verdict = Verdict::kIncomplete, .ended_at = "e"});
  }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  std::int64_t run_ = store_.begin_run({.recipe = "edf-25", .started_at = "start"});
};

TEST_F(RefusedResultTest, WhatIsKeptComesBackWithItsRunOldestFirst) {
  const std::int64_t other = store_.begin_run({.recipe = "edf-25", .started_at = "later"});
  EXPECT_TRUE(keep_refused(store_, run_, refused(1)));
  EXPECT_TRUE(keep_refused(store_, other, refused(2)));
  EXPECT_TRUE(keep_refused(store_, run_, refused(3)));
  const RunStore reopened(file_);
  EXPECT_THAT(refused_results(reopened, run_), ElementsAre(refused(1), refused(3)));
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

TEST_F(RefusedResultTest, ARunHasABoundedNumberOfThem) {
  std::uint32_t sequence = 0;
  for (int i = 0; i < kRefusedKept; ++i) EXPECT_TRUE(keep_refused(store_, run_, refused(++sequence)));
  EXPECT_FALSE(keep_refused(store_, run_, refused(++sequence)));
  EXPECT_EQ(refused_results(store_, run_).size(), static_cast<std::size_t>(kRefusedKept));
}

TEST_F(RefusedResultTest, OneThatComesAfterTheEndBelongsToTheRun) {
  end();
  EXPECT_TRUE(keep_refused(store_, run_, refused(1)));
  EXPECT_EQ(refused_results(store_, run_).size(), 1u);
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

TEST_F(RefusedResultTest, ARowThatWasChangedOrTakenOutIsNotTold) {
  keep_refused(store_, run_, refused(1));
  keep_refused(store_, run_, refused(2));
  end();
  store_.database()->exec("UPDATE refused_results SET j3_microdeg = 4 WHERE sequence = 2");
  EXPECT_THROW(static_cast<void>(refused_results(store_, run_)), DamagedStore);
  EXPECT_THAT(find_damage(file_), ElementsAre(HasSubstr("table refused_results, run 1, number 2")));
  store_.database()->exec("DELETE FROM refused_results WHERE sequence = 2");
  EXPECT_THROW(static_cast<void>(refused_results(store_, run_)), DamagedStore);
  EXPECT_THAT(find_damage(file_), ElementsAre(HasSubstr("run 1")));
}

TEST_F(RefusedResultTest, ATouchThatCountsIsNotRefusedWhereTheControllerTellsItAgain) {
  store_.append_touch(run_, {.number = 1, .captured_at = "t", .session = 7, .sequence = 1});
  store_.append_touch(run_, {.number = 2, .captured_at = "t", .session = 7, .sequence = 2});
  store_.withdraw_touch(run_, 2, "outlier");
  EXPECT_TRUE(keep_refused(store_, run_, refused(1)));
  EXPECT_TRUE(keep_refused(store_, run_, refused(2)));
  EXPECT_THAT(refused_results(store_, run_), IsEmpty());
}

TEST_F(RefusedResultTest, AnAnswerThatNobodyAskedForBelongsToTheRunWhoseCommandItAnswersElseToTheNewest) {
  store_.set_open_command(run_, {.session = 7, .sequence = 9, .touch_json = "{}"});
  end();
  const std::int64_t newest = store_.begin_run({.recipe = "edf-25", .started_at = "later"});
  EXPECT_EQ(run_of_answer(store_, 7, 9), run_);
  EXPECT_EQ(run_of_answer(store_, 8, 9), newest) << "another session of the controller";
  EXPECT_EQ(run_of_answer(store_, 7, 10), newest);
  EXPECT_FALSE(run_of_answer(RunStore(folder_.path() / "empty.sqlite"), 7, 9));
}

}  // namespace
}  // namespace cell
