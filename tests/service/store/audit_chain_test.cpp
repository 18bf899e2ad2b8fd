#include "service/store/audit_chain.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <string_view>

#include "service/base/digest.hpp"
#include "service/store/audit_log.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/schema.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class AuditChainTest : public ::testing::Test {
 protected:
  /// Six rows: commands in those of odd ids, strangers in the others.
  AuditChainTest() {
    AuditLog audit(database_);
    for (int i = 1; i <= 3; ++i) {
      audit.append_command({.at = "t" + std::to_string(i),
                            .who = "operate",
                            .operator_name = "M. Curie",
                            .remote = "127.0.0.1",
                            .action = "POST /api/v1/runs",
                            .outcome = "201"});
      audit.append_of_stranger({.at = "t", .who = "none", .outcome = "401"});
    }
  }
  void edit(const std::string& sql) { database_->exec(sql); }
  std::vector<std::string> damage() { return find_damage(file_); }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  SharedDatabase database_ = open_database(file_);
};

TEST_F(AuditChainTest, AnUntouchedAuditIsWhole) { EXPECT_THAT(damage(), IsEmpty()); }

TEST_F(AuditChainTest, AChangeOfAnyFieldNamesItsRow) {
  for (const char* field : {"at", "operator_name", "remote", "action", "outcome", "detail", "hash"}) {
    const std::string name = field;
    const std::string was = database_->execAndGet("SELECT " + name + " FROM audit WHERE id = 3").getString();
    edit("UPDATE audit SET " + name + " = 'other' WHERE id = 3");
    EXPECT_THAT(damage(), ElementsAre(HasSubstr("row 3"))) << name;
    edit("UPDATE audit SET " + name + " = '" + was + "' WHERE id = 3");
    EXPECT_THAT(damage(), IsEmpty()) << name;
  }
}

TEST_F(AuditChainTest, ARowTakenOutShowsAtTheNextOne) {
  edit("DELETE FROM audit WHERE id = 3");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("row 5")));
}

TEST_F(AuditChainTest, TheOldestAndTheNewestRowCannotBeTakenOutUnseen) {
  edit("DELETE FROM audit WHERE id = 5");
  EXPECT_THAT(damage(), ElementsAre(AllOf(HasSubstr("row 3"), HasSubstr("behind"))));
  edit("DELETE FROM audit WHERE id = 1");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("row 3")));
  edit("DELETE FROM audit WHERE id = 3");
  EXPECT_THAT(damage(), SizeIs(1)) << "no command is left";
}

TEST_F(AuditChainTest, ARowPutInOrMadeOneOfAStrangerShows) {
  edit("UPDATE audit SET who = 'none' WHERE id = 1");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("row 3"), HasSubstr("row 1"))) << "both chains break";
  edit("UPDATE audit SET who = 'operate' WHERE id = 1");
  edit("INSERT INTO audit(at, who, remote, action, outcome, detail) VALUES('t', 'operate', '', '', '', '')");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("row 7")));
}

TEST_F(AuditChainTest, StrangersHaveAChainOfTheirOwn) {
  edit("DELETE FROM audit WHERE id = 4");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("row 6")));
  edit("DELETE FROM audit WHERE who = 'none'; UPDATE audit_chains SET anchor = newest WHERE chain = 1");
  EXPECT_THAT(damage(), IsEmpty()) << "the commands do not depend on them";
}

TEST_F(AuditChainTest, AHashIsOfTheOneBeforeAndOfEachFieldWithItsLength) {
  const AuditEntry entry{.at = "t",
                         .who = "view",
                         .operator_name = "",
                         .remote = "::1",
                         .action = "POST /",
                         .outcome = "403",
                         .detail = "d"};
  EXPECT_EQ(audit_hash("before", entry), sha256_hex("before1:t4:view0:3:::16:POST /3:4031:d"));
}

TEST(AuditChainOfAnOldFile, RowsThatAreThereAreChained) {
  const Folder folder;
  const auto file = folder.path() / "old.sqlite";
  {
    SQLite::Database old(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    int version = 0;
    for (const char* migration : migrations()) {
      if (std::string_view(migration).find("audit_chains") != std::string_view::npos) break;
      old.exec(migration);
      ++version;
    }
    for (const std::string who : {"operate", "none", "view", "wrong token"})
      old.exec("INSERT INTO audit(at, who, remote, action, outcome, detail) VALUES('t', '" + who +
               "', '', '', '401', '')");
    old.exec("PRAGMA user_version = " + std::to_string(version));
  }
  EXPECT_THAT(find_damage(file), IsEmpty()) << "nothing is chained yet";
  const SharedDatabase database = open_database(file);
  EXPECT_THAT(find_damage(file), IsEmpty());
  for (const AuditEntry& entry : AuditLog(database).page(10)) EXPECT_THAT(entry.hash, SizeIs(64));
  AuditLog(database).append_command({.at = "t", .who = "operate", .outcome = "202"});
  EXPECT_THAT(find_damage(file), IsEmpty());
  database->exec("DELETE FROM audit WHERE who = 'view'");
  EXPECT_THAT(find_damage(file), ElementsAre(HasSubstr("row 5")));
}

}  // namespace
}  // namespace cell
