#include "tests/simulation/disk.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "service/store/run_store.hpp"

namespace simulation {
namespace {

class DiskTest : public ::testing::Test {
 protected:
  int write(std::size_t offset, const std::string& text) {
    return disk_.write(file_, offset, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  [[nodiscard]] std::string text() const { return {file_.bytes.begin(), file_.bytes.end()}; }

  VirtualClock clock_;
  Disk disk_{clock_, 1};
  Disk::File& file_ = disk_.files()["file"];
};

TEST_F(DiskTest, WhatWasSyncedIsThereWhenThePowerFailsAndAKillLosesNothing) {
  write(0, "synced");
  disk_.sync(file_);
  write(0, "SYNCED and more");
  disk_.freeze();
  disk_.start_again(false);
  EXPECT_EQ(text(), "SYNCED and more");
}

TEST_F(DiskTest, OfWhatWasNotSyncedEachWriteIsThereOrIsNot) {
  int lost = 0, kept = 0;
  for (int i = 0; i < 100; ++i) {
    file_.bytes.clear();
    write(0, "....");
    disk_.sync(file_);
    write(1, "a");
    write(5, "b");
    disk_.freeze();
    disk_.start_again(true);
    ASSERT_GE(file_.bytes.size(), 4u);
    EXPECT_EQ(file_.bytes[0], '.');
    EXPECT_TRUE(file_.bytes[1] == '.' || file_.bytes[1] == 'a');
    (file_.bytes[1] == 'a' ? kept : lost) += 1;
  }
  EXPECT_GT(lost, 20);
  EXPECT_GT(kept, 20);
}

TEST_F(DiskTest, TroublesAreToldAsSqliteWantsThem) {
  disk_.trouble = DiskTrouble::kFull;
  EXPECT_EQ(write(0, "x"), SQLITE_FULL);
  disk_.trouble = DiskTrouble::kWritesShort;
  EXPECT_EQ(write(0, "abcd"), SQLITE_IOERR_WRITE);
  EXPECT_EQ(text(), "ab");
  disk_.trouble = DiskTrouble::kSyncFails;
  EXPECT_EQ(disk_.sync(file_), SQLITE_IOERR_FSYNC);
  disk_.trouble = DiskTrouble::kSyncLies;
  EXPECT_EQ(disk_.sync(file_), SQLITE_OK);
  EXPECT_FALSE(file_.unsynced.empty());
}

TEST_F(DiskTest, AStoreOnItOutlivesAPowerFailureWithAllThatWasCommitted) {
  for (int failures = 0; failures < 5; ++failures) {
    {
      cell::RunStore store("store.sqlite");
      ASSERT_EQ(store.runs(100).size(), static_cast<std::size_t>(failures));
      store.begin_run({.recipe = "few", .started_at = "now"});
      disk_.freeze();
    }
    disk_.start_again(true);
  }
}

/// The last connection that closes a file takes its log into the file; one before it must not.
TEST_F(DiskTest, AReaderSeesWhatIsCommittedAndMayComeAndGo) {
  cell::RunStore store("store.sqlite");
  for (int runs = 1; runs <= 3; ++runs) {
    store.begin_run({.recipe = "few", .started_at = "now"});
    const auto reader = cell::RunStore::reader("store.sqlite");
    EXPECT_EQ(reader->runs(100).size(), static_cast<std::size_t>(runs));
    store.begin_run({.recipe = "few", .started_at = "now"});
    EXPECT_EQ(cell::RunStore::reader("store.sqlite")->runs(100).size(), reader->runs(100).size());
    store.withdraw_run(store.runs(1).front().id);
    EXPECT_GT(disk_.files()["store.sqlite-wal"].bytes.size(), 0u);
  }
  EXPECT_EQ(store.runs(100).size(), 3u);
}

TEST_F(DiskTest, ACommandThatWasMadeDurableOutlivesAPowerFailure) {
  for (std::uint32_t number = 1; number <= 10; ++number) {
    std::int64_t run = 0;
    {
      cell::RunStore store("store.sqlite");
      run = store.begin_run({.recipe = "few", .started_at = "now"});
      store.set_open_command(run, {.session = 1, .sequence = number, .touch_json = "{}"});
      ASSERT_TRUE(store.make_durable(run));
      disk_.freeze();
    }
    disk_.start_again(true);
    const auto open = cell::RunStore("store.sqlite").open_command(run);
    ASSERT_TRUE(open);
    EXPECT_EQ(open->sequence, number);
  }
}

}  // namespace
}  // namespace simulation
