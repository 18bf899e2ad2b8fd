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
                            .token_name = i == 1 ? "anna" : "",
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
  for (const char* field :
       {"at", "token_name", "operator_name", "remote", "action", "outcome", "detail", "hash"}) {
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
  AuditEntry named = entry;
  named.token_name = "anna";
  EXPECT_EQ(audit_hash("before", named), sha256_hex("before1:t4:view0:3:::16:POST /3:4031:d4:anna"));
}

/// A file of the schema before the migration that adds `column`.
void make_file_before(const std::filesystem::path& file, std::string_view column) {
  SQLite::Database old(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  int version = 0;
  for (const char* migration : migrations()) {
    if (std::string_view(migration).find(column) != std::string_view::npos) break;
    old.exec(migration);
    ++version;
  }
  old.exec("PRAGMA user_version = " + std::to_string(version));
}

TEST(AuditChainOfAnOldFile, RowsThatAreThereAreChained) {
  const Folder folder;
  const auto file = folder.path() / "old.sqlite";
  make_file_before(file, "audit_chains");
  for (const std::string who : {"operate", "none", "view", "wrong token"})
    SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
        .exec("INSERT INTO audit(at, who, remote, action, outcome, detail) VALUES('t', '" + who +
              "', '', '', '401', '')");
  EXPECT_THAT(find_damage(file), IsEmpty()) << "nothing is chained yet";
  const SharedDatabase database = open_database(file);
  EXPECT_THAT(find_damage(file), IsEmpty());
  for (const AuditEntry& entry : AuditLog(database).page(10)) EXPECT_THAT(entry.hash, SizeIs(64));
  AuditLog(database).append_command({.at = "t", .who = "operate", .outcome = "202"});
  EXPECT_THAT(find_damage(file), IsEmpty());
  database->exec("DELETE FROM audit WHERE who = 'view'");
  EXPECT_THAT(find_damage(file), ElementsAre(HasSubstr("row 5")));
}

TEST(AuditChainOfAnOldFile, RowsWithoutANameOfTheTokenKeepTheirHashes) {
  const Folder folder;
  const auto file = folder.path() / "old.sqlite";
  make_file_before(file, "token_name");
  const std::string hash = sha256_hex("1:t7:operate8:M. Curie0:0:3:2020:");
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
      .exec(
          "INSERT INTO audit(at, who, operator_name, remote, action, outcome, detail, hash) VALUES('t', "
          "'operate', 'M. Curie', '', '', '202', '', '" +
          hash + "'); INSERT INTO audit_chains VALUES(0, '', '" + hash + "')");
  EXPECT_THAT(find_damage(file), IsEmpty()) << "as the older daemon left it";
  const SharedDatabase database = open_database(file);
  EXPECT_THAT(find_damage(file), IsEmpty());
  AuditLog(database).append_command({.at = "t", .who = "operate", .token_name = "anna", .outcome = "202"});
  EXPECT_THAT(find_damage(file), IsEmpty());
  EXPECT_EQ(AuditLog(database).page(2).at(1).hash, hash);
  database->exec("UPDATE audit SET token_name = 'bert' WHERE id = 1");
  EXPECT_THAT(find_damage(file), ElementsAre(HasSubstr("row 1"))) << "a name put in later";
}

}  // namespace
}  // namespace cell
