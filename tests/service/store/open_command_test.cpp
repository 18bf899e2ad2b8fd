// The command that is open at the controller: on the disk before the arm moves, until its answer is.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

StoredTouch answered(int number) {
  return {.number = number,
          .plane = 1 + number % 4,
          .joints = {number, -2, 3, -4, 5, -6},
          .captured_at = "2026-01-31T08:15:30.250Z"};
}

class OpenCommandTest : public ::testing::Test {
 protected:
  std::int64_t begin() {
    return store_->begin_run({.recipe = "edf-25", .touches_total = 140, .started_at = "start"});
  }
  void reopen() {
    store_.reset();
    store_.emplace(file_, LockTime{.sleep = sleep_no_time});
  }

  static void sleep_no_time(std::chrono::milliseconds) {}

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  std::optional<RunStore> store_{std::in_place, file_, LockTime{.sleep = sleep_no_time}};
};

TEST_F(OpenCommandTest, NoCommandIsKeptInAFileThatWasMovedOrReplaced) {
  const std::int64_t run = begin();
  const OpenCommand command{.session = 1, .sequence = 1, .touch_json = "{}"};
  const std::filesystem::path moved = file_.string() + ".moved";
  std::filesystem::rename(file_, moved);
  EXPECT_THROW(store_->set_open_command(run, command), std::runtime_error);
  folder_.write("touchcal.sqlite", "another");
  EXPECT_THROW(store_->set_open_command(run, command), std::runtime_error);
  std::filesystem::rename(moved, file_);
  EXPECT_NO_THROW(store_->set_open_command(run, command));
}

TEST_F(OpenCommandTest, AfterALockOfAnotherProgramWhatIsWrittenReachesTheFile) {
  const std::int64_t run = begin();
  SQLite::Database other(file_.string(), SQLite::OPEN_READWRITE);
  const std::vector<std::function<void()>> meeting_the_lock{
      [&] { store_->set_open_command(run, {.session = 1, .sequence = 1, .touch_json = "{}"}); },
      [&] {
        if (!store_->make_durable(run)) throw SQLite::Exception("as it tells");
      },
      [&] { store_->append_touch(run, answered(1)); }};
  int stored = 0;
  for (const auto& write : meeting_the_lock) {
    other.exec("BEGIN IMMEDIATE");
    EXPECT_THROW(write(), SQLite::Exception);
    other.exec("ROLLBACK");
    store_->append_touch(run, answered(++stored));
    EXPECT_EQ(other.execAndGet("SELECT count(*) FROM touches").getInt(), stored);
    store_->set_touches_total(run, 10 + stored);
    EXPECT_EQ(other.execAndGet("SELECT touches_total FROM runs").getInt(), 10 + stored);
  }
}

TEST_F(OpenCommandTest, WhatMakesACommandDurableIsWrittenToTheLogWhichASyncGoesWith) {
  const std::int64_t run = begin();
  const OpenCommand command{.session = 7, .sequence = 9, .touch_json = "{}"};
  store_->set_open_command(run, command);
  const auto log = [this] {
    std::ifstream in(file_.string() + "-wal", std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string before = log();
  EXPECT_TRUE(store_->make_durable(run));
  EXPECT_NE(log(), before) << "a commit that writes nothing syncs nothing";
  EXPECT_EQ(store_->open_command(run).value().session, command.session);
  EXPECT_EQ(store_->open_command(run).value().sequence, command.sequence);
}

TEST_F(OpenCommandTest, ACommandIsOpenUntilItsAnswerIsStored) {
  const std::int64_t run = begin();
  EXPECT_FALSE(store_->open_command(run));
  store_->set_open_command(run, {.session = 7, .sequence = 9, .aimed_with = 2, .touch_json = "{\"a\":1}"});
  store_->make_durable(run);
  reopen();
  const OpenCommand open = store_->open_command(run).value();
  EXPECT_EQ(open.session, 7u);
  EXPECT_EQ(open.sequence, 9u);
  EXPECT_EQ(open.aimed_with, 2);
  EXPECT_EQ(open.touch_json, "{\"a\":1}");
  StoredTouch answer = answered(1);
  answer.session = 7;
  answer.sequence = 8;
  store_->append_touch(run, answer);
  EXPECT_TRUE(store_->open_command(run)) << "that was the answer to another";
  answer = answered(2);
  answer.session = 7;
  answer.sequence = 9;
  store_->append_touch(run, answer);
  EXPECT_FALSE(store_->open_command(run));
  StoredTouch again = answer;
  again.sequence = 10;
  store_->replace_touch(run, again, "outlier");
  EXPECT_FALSE(store_->open_command(run)) << "its touch is kept apart, and it was answered";
}

}  // namespace
}  // namespace cell
