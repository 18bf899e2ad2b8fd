#include "service/store/fault_log.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

class FaultLogTest : public ::testing::Test {
 protected:
  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
};

TEST_F(FaultLogTest, FaultsComeBackNewestFirstAndByRun) {
  const std::int64_t run = store_.begin_run({.recipe = "edf-25", .started_at = "start"});
  FaultLog faults(store_.database());
  faults.append(std::nullopt, "t1", "controller_unreachable", "refused");
  faults.append(run, "t2", "no_contact", "the search ended");
  const auto all = faults.page(10);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].code, "no_contact");
  EXPECT_EQ(all[0].run_id, run);
  EXPECT_EQ(all[1].message, "refused");
  EXPECT_FALSE(all[1].run_id);
  EXPECT_EQ(faults.page(10, all[0].id).size(), 1u);
  EXPECT_EQ(faults.page(10, {}, run).size(), 1u);
  EXPECT_EQ(FaultLog(open_database(file_)).page(10).size(), 2u);
}

/// A disk on which nothing more can be stored, until it goes out of scope.
class FullDisk {
 public:
  explicit FullDisk(const SharedDatabase& database) : database_(database) {
    database_->exec(
        "CREATE TEMP TRIGGER full BEFORE INSERT ON faults BEGIN SELECT RAISE(ABORT, 'full'); END");
  }
  ~FullDisk() { database_->exec("DROP TRIGGER full"); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  SharedDatabase database_;
};

TEST_F(FaultLogTest, AFaultThatCannotBeStoredIsStoredWithTheNextOne) {
  FaultLog faults(store_.database());
  {
    const FullDisk full(store_.database());
    EXPECT_ANY_THROW(faults.append({}, "t1", "no_contact", "first"));
  }
  EXPECT_TRUE(faults.page(10).empty());
  faults.append({}, "t2", "no_contact", "second");
  const auto all = faults.page(10);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].message, "first");
  EXPECT_EQ(all[1].at, "t1");
}

TEST_F(FaultLogTest, AFaultThatCannotBeStoredIsStoredOnceAnotherWriteWorks) {
  FaultLog faults(store_.database());
  {
    const FullDisk full(store_.database());
    EXPECT_ANY_THROW(faults.append({}, "t1", "no_contact", "first"));
  }
  EXPECT_FALSE(faults.store_waiting()) << "nothing was written since";
  store_.begin_run({.recipe = "edf-25", .started_at = "start"});
  EXPECT_TRUE(faults.store_waiting());
  EXPECT_TRUE(faults.store_waiting()) << "and once only";
  EXPECT_EQ(faults.page(10).size(), 1u);
}

TEST_F(FaultLogTest, OfFaultsThatFindNoRoomToWaitTheNumberIsTold) {
  FaultLog faults(store_.database());
  {
    const FullDisk full(store_.database());
    for (std::size_t i = 0; i < FaultLog::kWaitingMax + 7; ++i)
      EXPECT_ANY_THROW(faults.append({}, "t1", "no_contact", "first"));
  }
  faults.append({}, "t2", "no_contact", "the last");
  const auto all = faults.page(1000);
  ASSERT_EQ(all.size(), FaultLog::kWaitingMax + 2);
  EXPECT_EQ(all[0].code, "store_failed");
  EXPECT_THAT(all[0].message, ::testing::StartsWith("7 more"));
  EXPECT_EQ(all[1].message, "the last");
}

}  // namespace
}  // namespace cell
