#include "service/store/fault_log.hpp"

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

}  // namespace
}  // namespace cell
