#include "service/store/internal/lock_wait.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

using namespace std::chrono_literals;

/// Another program locks the file; the time that is waited for it is made up.
class LockWaitTest : public ::testing::Test {
 protected:
  LockWaitTest() {
    run_ = store_.begin_run({.recipe = "edf-25", .started_at = "start"});
    other_.exec("BEGIN IMMEDIATE");
  }
  void sleep(std::chrono::milliseconds time) {
    waited_ += time;
    if (waited_ >= unlock_at_) other_.exec("ROLLBACK");
  }
  /// How long a write waits; whether it went through is in `stored_`.
  std::chrono::milliseconds wait_of_a_write() {
    waited_ = 0ms;
    try {
      store_.set_touches_total(run_, ++total_);  // reads before it writes
      stored_ = true;
    } catch (const SQLite::Exception&) {
      stored_ = false;
    }
    return waited_;
  }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  std::chrono::milliseconds waited_{0};
  std::chrono::milliseconds unlock_at_ = 1h;
  std::chrono::steady_clock::time_point now_;
  RunStore store_{
      file_,
      {.sleep = [this](std::chrono::milliseconds time) { sleep(time); }, .now = [this] { return now_; }}};
  SQLite::Database other_{file_.string(), SQLite::OPEN_READWRITE};
  std::int64_t run_ = 0;
  int total_ = 0;
  bool stored_ = false;
};

TEST_F(LockWaitTest, AWriteGoesThroughOnceAnotherProgramHasLetGo) {
  unlock_at_ = 800ms;
  EXPECT_EQ(wait_of_a_write(), unlock_at_);
  EXPECT_TRUE(stored_);
  EXPECT_EQ(store_.run(run_)->touches_total, total_);
}

TEST_F(LockWaitTest, BehindALockThatLastsOnlyTheFirstWriteWaitsLong) {
  EXPECT_EQ(wait_of_a_write(), kLockPatience);
  EXPECT_FALSE(stored_);
  EXPECT_EQ(wait_of_a_write(), row::LockWait::kLockLook);
  EXPECT_FALSE(stored_);
  other_.exec("ROLLBACK");
  EXPECT_EQ(wait_of_a_write(), 0ms);
  EXPECT_TRUE(stored_);
  other_.exec("BEGIN IMMEDIATE");
  EXPECT_EQ(wait_of_a_write(), kLockPatience) << "it is another lock";
}

TEST_F(LockWaitTest, ALockThatIsMetLaterIsWaitedForAlsoWhereNothingWasWrittenBetween) {
  EXPECT_EQ(wait_of_a_write(), kLockPatience);
  now_ += kLockLapse - 1ms;
  EXPECT_EQ(wait_of_a_write(), row::LockWait::kLockLook);
  now_ += 1ms;
  unlock_at_ = 800ms;
  EXPECT_EQ(wait_of_a_write(), unlock_at_);
  EXPECT_TRUE(stored_);
}

TEST_F(LockWaitTest, ABeginDoesNotWaitLongForAReaderBeforeItRestartsTheLog) {
  other_.exec("ROLLBACK; BEGIN");
  EXPECT_EQ(other_.execAndGet("SELECT count(*) FROM runs").getInt(), 1);
  waited_ = 0ms;
  store_.begin_run({.recipe = "edf-25", .started_at = "later"});
  EXPECT_EQ(waited_, row::LockWait::kLockLook);
}

TEST_F(LockWaitTest, AConnectionThatOutlivesTheStoreWaitsAsOneThatReads) {
  SharedDatabase left;
  {
    RunStore store(file_);
    left = store.database();
  }
  EXPECT_THROW(left->exec("DELETE FROM plans"), SQLite::Exception);
}

}  // namespace
}  // namespace cell
