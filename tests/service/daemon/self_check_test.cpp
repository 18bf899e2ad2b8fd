#include "service/daemon/self_check.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <map>

#include "service/base/state_directory.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What a directory holds, and when each file was changed last.
std::map<std::string, std::pair<std::string, fs::file_time_type>> contents_of(const fs::path& directory) {
  std::map<std::string, std::pair<std::string, fs::file_time_type>> contents;
  for (const auto& entry : fs::directory_iterator(directory))
    contents[entry.path().filename()] = {bytes_of(entry.path()), entry.last_write_time()};
  return contents;
}

class SelfCheckTest : public ::testing::Test {
 protected:
  SelfCheckTest() { make_directory_of_owner(state_); }

  /// Looks at the state directory, which stays as it is.
  SelfCheck check() const {
    const auto before = contents_of(state_);
    SelfCheck found = check_daemon(kSourceDir / "config/cells/edf/cell.json",
                                   {.state_directory = state_, .listen = {"127.0.0.1", 0}});
    EXPECT_EQ(contents_of(state_), before);
    return found;
  }
  void expect_in_order() const {
    const SelfCheck found = check();
    EXPECT_THAT(found.bad_files, IsEmpty());
    EXPECT_THAT(found.troubles, IsEmpty());
    EXPECT_THAT(found.remarks, IsEmpty());
    EXPECT_EQ(found.not_looked_at, "");
    EXPECT_EQ(found.cell_name, "edf");
  }
  /// A database with a run, closed as at the end of a daemon.
  void store_run() const { RunStore(file_).begin_run({.recipe = "edf-25", .started_at = "start"}); }
  /// What a daemon leaves that is killed: its log and the index of that.
  void leave_as_killed() const {
    const fs::path served = folder_.path() / "served";
    make_directory_of_owner(served);
    RunStore store(served / kStoreFile);
    store.begin_run({.recipe = "edf-25", .started_at = "start"});
    fs::copy(served, state_);
    ASSERT_TRUE(fs::exists(file_.string() + "-wal") && fs::exists(file_.string() + "-shm"));
  }

  const Folder folder_;
  const fs::path state_ = folder_.path() / "state";
  const fs::path file_ = state_ / kStoreFile;
};

TEST_F(SelfCheckTest, ANewStateDirectoryIsInOrderAndStaysEmpty) { expect_in_order(); }

TEST_F(SelfCheckTest, ADatabaseAtRestIsLookedAt) {
  store_run();
  expect_in_order();
  {
    std::fstream file(file_, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(4096);
    file << std::string(3 * 4096, 'x');
  }
  EXPECT_THAT(check().bad_files,
              ElementsAre(AllOf(HasSubstr(file_.string() + ": "), HasSubstr("restore the last backup"))));
  std::ofstream(file_) << std::string(8192, 'x');
  EXPECT_THAT(check().bad_files, ElementsAre(HasSubstr("not a database")));
}

TEST_F(SelfCheckTest, TheDatabaseOfADaemonThatWasKilledIsLookedAtWithItsLog) {
  leave_as_killed();
  expect_in_order();
  SQLite::Database(file_.string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 999");
  EXPECT_THAT(check().troubles, ElementsAre(HasSubstr("a newer touchcald wrote it (schema 999")));
}

TEST_F(SelfCheckTest, ALogThatCannotBeReadWithoutATraceIsLeftAloneAndSaidSo) {
  leave_as_killed();
  fs::remove(file_.string() + "-shm");
  const SelfCheck found = check();
  EXPECT_THAT(found.remarks, ElementsAre(AllOf(HasSubstr(file_.string() + ": not looked at: its log (-wal)"),
                                               HasSubstr("touchcald --verify"))));
  EXPECT_THAT(found.bad_files, IsEmpty());
  EXPECT_THAT(found.troubles, IsEmpty()) << "it keeps no daemon from starting";
  EXPECT_THAT(found.not_looked_at, HasSubstr(file_.string()));
}

TEST_F(SelfCheckTest, ADamagedRowIsToldAndKeepsNoDaemonFromStarting) {
  {
    RunStore store(file_);
    const std::int64_t run = store.begin_run({.recipe = "edf-25", .started_at = "start"});
    for (int touch = 1; touch <= 30; ++touch) store.append_touch(run, {.number = touch, .plane = 1});
    store.database()->exec("UPDATE touches SET plane = 2 WHERE number >= 3");
  }
  const SelfCheck found = check();
  EXPECT_THAT(found.bad_files, IsEmpty());
  EXPECT_THAT(found.troubles, IsEmpty());
  ASSERT_EQ(found.remarks.size(), 11u) << "ten places, and one line with the remedy";
  EXPECT_THAT(found.remarks.front(), HasSubstr(file_.string() + ": table touches, run 1, number 3"));
  EXPECT_THAT(found.remarks.back(), AllOf(HasSubstr("18 more places"), HasSubstr("restore the last backup")));
}

TEST_F(SelfCheckTest, ADirectoryThatOthersMayWriteInIsRefusedWithTheRemedy) {
  fs::permissions(state_, fs::perms(0777));
  EXPECT_THAT(check().troubles, ElementsAre(HasSubstr("chmod 700 " + state_.string())));
}

TEST_F(SelfCheckTest, RootMayLookAtTheDirectoryOfAServiceAndIsToldWhoseItIs) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives directories away";
  ASSERT_EQ(::chown(state_.c_str(), 65534, 65534), 0);
  const SelfCheck found = check();
  EXPECT_THAT(found.troubles, IsEmpty());
  EXPECT_THAT(found.remarks, ElementsAre(HasSubstr("belongs to the user with the id 65534")));
}

TEST_F(SelfCheckTest, APlaceOfTheBlockThatIsNoneIsABadFile) {
  store_run();
  std::ofstream(state_ / kBlockPoseFile) << R"({"schema":"touchcal/place/1"})";
  EXPECT_THAT(check().bad_files, ElementsAre(HasSubstr((state_ / kBlockPoseFile).string() + ": ")));
}

TEST_F(SelfCheckTest, AFileOfUsersThatIsNoneIsABadFile) {
  std::ofstream(state_ / kUserFile) << R"({"schema":"touchcal/users-file/1","users":[{}],"sessions":[]})";
  fs::permissions(state_ / kUserFile, fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_THAT(check().bad_files, ElementsAre(AllOf(HasSubstr("users.json"), HasSubstr("/users/0"))));
}

}  // namespace
}  // namespace cell
