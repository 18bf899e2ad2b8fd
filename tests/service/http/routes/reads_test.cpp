#include "service/http/routes/reads.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "tests/service/quiet_cell.hpp"

namespace cell {
namespace {

TEST(Reads, OfAnotherThreadSeeWhatIsCommittedAndWriteNothing) {
  QuietCell quiet;
  const Reads reads(quiet.operation(), quiet.store().file());
  EXPECT_NE(reads.store().database(), quiet.store().database()) << "a connection of its own";
  const std::int64_t run = quiet.store().begin_run({.recipe = "edf-25", .started_at = "start"});
  quiet.store().append_touch(run, {.number = 1, .plane = 2, .joints = {1, 2, 3, 4, 5, 6}});
  ASSERT_TRUE(reads.store().run(run));
  EXPECT_EQ(reads.store().touches(run).size(), 1u);
  EXPECT_THROW(reads.store().database()->exec("DELETE FROM runs"), SQLite::Exception);
  EXPECT_EQ(reads.live_result(run), std::nullopt) << "no copy of it was given";
}

TEST(Reads, DoNotWaitForACommitUnderWay) {
  QuietCell quiet;
  const Reads reads(quiet.operation(), quiet.store().file());
  quiet.store().begin_run({.recipe = "edf-25", .started_at = "start"});
  SQLite::Transaction open(*quiet.store().database());
  quiet.store().database()->exec("DELETE FROM runs");
  EXPECT_EQ(reads.store().runs(10).size(), 1u);
}

TEST(Reads, OfTheOperationsThreadAreItsOwn) {
  QuietCell quiet;
  const Reads reads(quiet.operation());
  EXPECT_EQ(&reads.store(), &quiet.operation().store());
  EXPECT_EQ(reads.cell().name, quiet.operation().cell().name);
  EXPECT_FALSE(reads.place());
}

}  // namespace
}  // namespace cell
