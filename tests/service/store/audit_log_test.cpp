#include "service/store/audit_log.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "service/store/maintenance.hpp"
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

TEST_F(AuditLogTest, AFloodOfStrangersDisplacesNoCommandAlsoOverARestart) {
  constexpr int kKept = AuditLog::kOfStrangersKept;
  {
    AuditLog audit(store_.database());
    audit.append_command({.at = "t", .who = "operate", .outcome = "202"});
    for (int i = 0; i < kKept + 10; ++i) audit.append_of_stranger({.who = "none", .outcome = "401"});
    EXPECT_EQ(audit.page(2 * kKept).size(), static_cast<std::size_t>(kKept) + 1);
  }
  AuditLog audit(store_.database());
  for (int i = 0; i < 10; ++i) audit.append_of_stranger({.who = "wrong token", .outcome = "401"});
  const auto all = audit.page(2 * kKept);
  EXPECT_EQ(all.size(), static_cast<std::size_t>(kKept) + 1);
  EXPECT_EQ(all.front().who, "wrong token");
  EXPECT_EQ(all.back().who, "operate");
  EXPECT_THAT(find_damage(file_), ::testing::IsEmpty()) << "the chain begins at the last deleted row";
}

TEST_F(AuditLogTest, TheOldestCommandsGoAndNoStrangerWithThem) {
  store_.database()->exec("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < " +
                          std::to_string(AuditLog::kKept) +
                          ") INSERT INTO audit(at, who, remote, action, outcome, detail) SELECT 't', "
                          "'operate', '', '', i, '' FROM n");
  {
    SQLite::Transaction transaction(*store_.database());
    chain_audit_rows(*store_.database());
    transaction.commit();
  }
  AuditLog audit(store_.database());
  audit.append_of_stranger({.who = "none", .outcome = "401"});
  audit.append_command({.at = "t", .who = "operate", .outcome = "new"});
  EXPECT_THAT(find_damage(file_), ::testing::IsEmpty());
  const auto all = audit.page(AuditLog::kKept + 10);
  EXPECT_EQ(all.size(), static_cast<std::size_t>(AuditLog::kKept) + 1);
  EXPECT_EQ(all.back().outcome, "2");
  EXPECT_EQ(all[1].who, "none");
}

}  // namespace
}  // namespace cell
