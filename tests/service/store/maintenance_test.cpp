#include "service/store/maintenance.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>

#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class StoreMaintenance : public ::testing::Test {
 protected:
  /// A run of one touch that ended; its id.
  std::int64_t add_run(const std::string& began, Verdict verdict) {
    const std::int64_t run = store_.begin_run({.recipe = "edf-25", .started_at = began});
    store_.set_plan(run, 1, "plan of " + began, "{}");
    store_.set_open_command(run, {.session = 1, .sequence = 1, .touch_json = "{}"});
    store_.append_touch(run, {.number = 1, .plane = 1, .captured_at = "t"});
    if (verdict != Verdict::kNone)
      store_.finish_run(run, {.outcome = RunOutcome::kComplete, .verdict = verdict, .ended_at = "end"});
    return run;
  }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  std::filesystem::path copy_ = folder_.path() / "copy.sqlite";
  RunStore store_{file_};
};

TEST_F(StoreMaintenance, ABackupOfADatabaseInUseHasAllThatIsStored) {
  const std::int64_t run = add_run("start", Verdict::kAccepted);
  back_up(file_, copy_);
  add_run("later", Verdict::kNone);
  EXPECT_THAT(find_damage(copy_), IsEmpty());
  const RunStore copy(copy_);
  EXPECT_EQ(copy.runs(10).size(), 1u);
  EXPECT_EQ(copy.touches(run).size(), 1u);
}

TEST_F(StoreMaintenance, ABackupHasThePlaceOfTheBlockBesideIt) {
  back_up(file_, copy_);
  const std::filesystem::path place = folder_.path() / "copy.sqlite.place.json";
  EXPECT_FALSE(std::filesystem::exists(place)) << "none was found yet";
  std::filesystem::remove(copy_);
  folder_.write("place.json", "where it stands");
  back_up(file_, copy_);
  EXPECT_EQ(bytes_of(place), "where it stands");
  std::filesystem::remove(copy_);
  EXPECT_THROW(back_up(file_, copy_), std::runtime_error) << "the place of another backup is not replaced";
  EXPECT_FALSE(std::filesystem::exists(copy_));
}

TEST_F(StoreMaintenance, ABackupNeverReplacesAFileAndLeavesNoHalfOne) {
  EXPECT_THROW(back_up(folder_.path() / "gone.sqlite", copy_), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(copy_));
  folder_.write("copy.sqlite", "mine");
  EXPECT_THROW(back_up(file_, copy_), std::runtime_error);
  EXPECT_EQ(bytes_of(copy_), "mine");
}

/// Runs `check` in a process of its own that may not write; true when it holds there. As root, that takes
/// another user.
bool holds_without_rights(const std::function<bool()>& check) {
  constexpr uid_t kNobody = 65534;
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && seteuid(kNobody) != 0) _exit(2);
    _exit(check() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(ReadOnlyStore, IsCheckedAsItIsAndALogThatIsNotInItYetIsNoDamage) {
  namespace fs = std::filesystem;
  const Folder folder;
  const fs::path file = folder.path() / "touchcal.sqlite";
  const auto forbid_writing = [&] {
    for (const auto& entry : fs::directory_iterator(folder.path()))
      fs::permissions(entry.path(), fs::perms(0444));
    fs::permissions(folder.path(), fs::perms(0555));
  };
  { RunStore(file).begin_run({.recipe = "edf-25", .started_at = "start"}); }
  forbid_writing();
  EXPECT_TRUE(holds_without_rights([&] { return find_damage(file).empty(); }));
  fs::permissions(folder.path(), fs::perms(0755));
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec("UPDATE runs SET recipe = 'quick'");
  forbid_writing();
  EXPECT_TRUE(holds_without_rights([&] { return find_damage(file).size() == 1; }));
  fs::permissions(folder.path(), fs::perms(0755));
  folder.write("touchcal.sqlite-wal", "commits of a daemon that was killed");
  forbid_writing();
  EXPECT_TRUE(holds_without_rights([&] {
    try {
      find_damage(file);
    } catch (const StoreNotChecked& error) {
      return std::string(error.what()).find("writable") != std::string::npos;
    }
    return false;
  }));
  fs::permissions(folder.path(), fs::perms(0755));
}

TEST(LostStore, IsNoticedInAStateDirectoryThatWasInUse) {
  for (const bool empty : {false, true}) {
    const Folder folder;
    EXPECT_NO_THROW(refuse_lost_store(folder.path() / "none"));
    if (empty) folder.write("touchcal.sqlite", "");
    EXPECT_NO_THROW(refuse_lost_store(folder.path())) << "a first start, or one that was cut short";
    folder.write("operate.token", "a");
    EXPECT_NO_THROW(refuse_lost_store(folder.path())) << "a token of one's own";
    folder.write("view.token", "b");
    try {
      refuse_lost_store(folder.path());
      ADD_FAILURE() << "it would begin as if nothing had been";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr("touchcal.sqlite"), HasSubstr(empty ? "is empty" : "is missing"),
                        HasSubstr("restore the last backup")));
    }
    std::filesystem::remove(folder.path() / "touchcal.sqlite");
    const RunStore made(folder.path() / "touchcal.sqlite");
    EXPECT_NO_THROW(refuse_lost_store(folder.path()));
  }
  const Folder folder;
  folder.write("place.json", "{}");
  EXPECT_THROW(refuse_lost_store(folder.path()), std::runtime_error);
}

TEST(LostStore, IsNoticedBesideWhatIsLeftThereOnceItWasBegun) {
  const Folder folder;
  folder.write("operate.token", "a");
  EXPECT_NO_THROW(refuse_lost_store(folder.path())) << "prepared for its first start";
  { const RunStore made(folder.path() / "touchcal.sqlite"); }
  mark_begun(folder.path());
  mark_begun(folder.path());
  EXPECT_NO_THROW(refuse_lost_store(folder.path()));
  std::filesystem::remove(folder.path() / "touchcal.sqlite");
  try {
    refuse_lost_store(folder.path());
    ADD_FAILURE() << "it would begin as if nothing had been";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("touchcal.sqlite: is missing"), HasSubstr("touchcal.begun"),
                                    HasSubstr("restore the last backup")));
  }
}

TEST_F(StoreMaintenance, AFileOfANewerVersionIsNotCalledDamaged) {
  SQLite::Database(file_.string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 77");
  try {
    find_damage(file_);
    ADD_FAILURE() << "nobody can say";
  } catch (const StoreNotChecked& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr(file_.string()), HasSubstr("a newer touchcald wrote it (schema 77"),
                      HasSubstr("verify it with that version")));
  }
}

TEST_F(StoreMaintenance, WhatIsNoTouchOrBelongsToNoRunIsTold) {
  const std::int64_t run = add_run("start", Verdict::kAccepted);
  EXPECT_THAT(find_damage(file_), IsEmpty());
  store_.append_touch(run, {.number = 2, .plane = 0, .captured_at = "t"});
  EXPECT_THAT(find_damage(file_), ElementsAre(HasSubstr("touch 2")));
  store_.database()->exec("PRAGMA foreign_keys = OFF; UPDATE touches SET run_id = 99 WHERE number = 1");
  EXPECT_THAT(find_damage(file_), AllOf(Contains(HasSubstr("touch 2")), Contains(HasSubstr("belongs to no")),
                                        Contains(HasSubstr("run 99, number 1"))));
}

TEST_F(StoreMaintenance, ADatabaseWithWrittenOverPagesIsTold) {
  add_run("start", Verdict::kAccepted);
  back_up(file_, copy_);
  std::fstream bytes(copy_, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(2 * 4096);
  bytes << std::string(std::size_t{4} * 4096, 'x');
  bytes.close();
  EXPECT_FALSE(find_damage(copy_).empty());
  EXPECT_FALSE(find_damage(folder_.path() / "gone.sqlite").empty());
}

TEST_F(StoreMaintenance, ALookSeesDamagedRowsUpToASizeAndSaysWhereItDidNotLook) {
  add_run("start", Verdict::kAccepted);
  EXPECT_THAT(look_without_trace(file_).damage, IsEmpty());
  store_.database()->exec("UPDATE touches SET plane = 2");
  const StoreLook look = look_without_trace(file_);
  EXPECT_FALSE(look.unusable);
  EXPECT_TRUE(look.is_whole);
  EXPECT_EQ(look.damage, find_damage(file_));
  EXPECT_THAT(look.damage, ElementsAre(HasSubstr("table touches, run 1, number 1")));
  const StoreLook brief = look_without_trace(file_, std::filesystem::file_size(file_));
  EXPECT_FALSE(brief.is_whole) << "its log counts";
  EXPECT_THAT(brief.damage, IsEmpty());
}

TEST_F(StoreMaintenance, OldRunsGoWithAllThatIsTheirsButTheLastAcceptedAndTheRunningOneStay) {
  const std::int64_t old = add_run("2026-01-01", Verdict::kAccepted);
  const std::int64_t accepted = add_run("2026-01-02", Verdict::kAccepted);
  const std::int64_t rejected = add_run("2026-01-03", Verdict::kRejected);
  const std::int64_t running = add_run("2026-01-04", Verdict::kNone);
  const std::int64_t young = add_run("2026-03-01", Verdict::kRejected);
  for (int i = 1; i < kLastRunsKept; ++i)
    add_run(i % 2 == 0 ? "2026-03-02" : "2026-03-03", Verdict::kRejected);
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-01"), 2);
  EXPECT_FALSE(store_.run(old) || store_.run(rejected));
  EXPECT_THAT(store_.touches(old), IsEmpty());
  for (const std::int64_t kept : {accepted, running, young}) {
    EXPECT_TRUE(store_.run(kept));
    EXPECT_TRUE(store_.plan_json(kept));
  }
  EXPECT_EQ(store_.database()->execAndGet("SELECT count(*) FROM plans").getInt(), 5);
  EXPECT_THAT(find_damage(file_), IsEmpty());
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-01"), 0);
}

TEST_F(StoreMaintenance, TheChecksOfTheCalibrationThatCountsStay) {
  const auto check_of = [&](std::int64_t calibration) {
    const std::int64_t check = store_.begin_run(
        {.kind = RunKind::kCheck, .of_run = calibration, .recipe = "edf-25", .started_at = "2026-01-02"});
    store_.finish_run(check, {.verdict = Verdict::kNone, .ended_at = "2026-01-02"});
    return check;
  };
  const std::int64_t before = add_run("2026-01-01", Verdict::kAccepted);
  const std::int64_t check_before = check_of(before);
  const std::int64_t accepted = add_run("2026-01-02", Verdict::kAccepted);
  const std::int64_t reference = check_of(accepted);
  for (int i = 0; i < kLastRunsKept; ++i)
    add_run("2026-03-0" + std::to_string(1 + i % 3), Verdict::kRejected);
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-01"), 2);
  EXPECT_FALSE(store_.run(before) || store_.run(check_before));
  EXPECT_TRUE(store_.run(accepted));
  EXPECT_TRUE(store_.run(reference)) << "without it the next check would be the reference of all later ones";
}

TEST_F(StoreMaintenance, TheRoomOnTheDiskOfTheDatabaseIsTold) {
  constexpr double kOthersWriteBytes = 1e9;
  EXPECT_NEAR(static_cast<double>(disk_room_bytes(store_.database()).value()),
              static_cast<double>(std::filesystem::space(folder_.path()).available), kOthersWriteBytes);
}

TEST_F(StoreMaintenance, OfADirectoryThatWasMovedAwayNoRoomIsTold) {
  std::filesystem::path moved = folder_.path();
  moved += ".moved";
  std::filesystem::rename(folder_.path(), moved);
  EXPECT_FALSE(disk_room_bytes(store_.database()));
  std::filesystem::rename(moved, folder_.path());
}

TEST_F(StoreMaintenance, TheLastRunsStayHoweverOldTheyAre) {
  for (int i = 0; i < kLastRunsKept; ++i) add_run("2026-01-01", Verdict::kRejected);
  for (const char* day : {"2026-03-01", "2026-03-02", "2026-03-03"}) add_run(day, Verdict::kRejected);
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-01"), kDaysThatAgree);
}

TEST_F(StoreMaintenance, AClockThatHasJumpedDeletesNothing) {
  for (int i = 0; i < 2 * kLastRunsKept; ++i) add_run("2026-01-01", Verdict::kRejected);
  EXPECT_EQ(delete_runs_before(store_.database(), "2036-01-01"), 0);
}

TEST_F(StoreMaintenance, WhoKeepsADayNeedsRunsOfThatDayOnly) {
  for (int i = 0; i < 2 * kLastRunsKept; ++i) add_run("2026-01-01T08:00:00.000Z", Verdict::kRejected);
  add_run("2026-03-01T08:00:00.000Z", Verdict::kRejected);
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-28T09:00:00.000Z"), 0);
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-28T09:00:00.000Z", 1), kLastRunsKept + 1);
}

TEST_F(StoreMaintenance, OneStartWithAClockFarAheadIsNotTheWordOfTheNext) {
  for (int i = 0; i < 2 * kLastRunsKept; ++i) add_run("2026-01-01T08:00:00.000Z", Verdict::kRejected);
  for (int minute = 10; minute < 40; ++minute)
    add_run("2036-01-02T08:" + std::to_string(minute) + ":00.000Z", Verdict::kRejected);
  EXPECT_EQ(delete_runs_before(store_.database(), "2036-01-01T00:00:00.000Z"), 0);
  add_run("2036-01-03T08:00:00.000Z", Verdict::kRejected);
  EXPECT_EQ(delete_runs_before(store_.database(), "2036-01-01T00:00:00.000Z"), 0);
  add_run("2036-01-04T08:00:00.000Z", Verdict::kRejected);
  EXPECT_EQ(delete_runs_before(store_.database(), "2036-01-01T00:00:00.000Z"), 2 * kLastRunsKept)
      << "days went by";
}

}  // namespace
}  // namespace cell
