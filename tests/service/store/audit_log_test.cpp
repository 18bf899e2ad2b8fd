#include "service/store/audit_log.hpp"

#include <gmock/gmock.h>

#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

class AuditLogTest : public ::testing::Test {
 protected:
  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
};

TEST_F(AuditLogTest, TheAuditIsReadInPages) {
  AuditLog audit(store_.database());
  for (const std::string at : {"t1", "t2", "t3"}) {
    audit.append_command({.at = at,
                          .who = "operate",
                          .remote = "127.0.0.1",
                          .action = "POST /api/v1/runs",
                          .outcome = "201",
                          .detail = "run 1"});
  }
  audit.append_refusal({.at = "t4", .who = "none", .outcome = "401 token"});
  const auto first = audit.page(2);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].outcome, "401 token");
  EXPECT_EQ(first[1].at, "t3");
  const auto second = audit.page(10, first[1].id);
  ASSERT_EQ(second.size(), 2u);
  EXPECT_EQ(second[1].at, "t1");
  EXPECT_EQ(second[1].who, "operate");
  EXPECT_EQ(second[1].action, "POST /api/v1/runs");
  EXPECT_EQ(second[1].detail, "run 1");
}

}  // namespace
}  // namespace cell
