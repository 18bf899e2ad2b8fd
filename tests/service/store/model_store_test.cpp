#include "service/store/model_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <stdexcept>

#include "service/base/digest.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ModelStoreTest : public ::testing::Test {
 protected:
  ModelStoreTest() {
    for (int i = 0; i < 3; ++i) store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-01"});
  }
  static NewApproval model_of_run(std::int64_t run) {
    return {.run_id = run,
            .at = "at " + std::to_string(run),
            .operator_name = "M. Curie",
            .hash = "hash " + std::to_string(run),
            .valid_until = run == 2 ? std::optional<std::string>("then") : std::nullopt,
            .document = R"({"of":)" + std::to_string(run) + "}",
            .arm_json = R"({"arm":)" + std::to_string(run) + "}"};
  }
  void approve(std::int64_t run) { models_.approve(model_of_run(run)); }
  /// The run of the current model; 0 for none.
  [[nodiscard]] std::int64_t current() const {
    const auto standing = standing_approvals(models_.history());
    return standing.empty() ? 0 : standing.back().run_id;
  }
  void edit(const std::string& sql) { EXPECT_EQ(store_.database()->exec(sql), 1) << sql; }
  std::vector<std::string> damage() { return find_damage(file_); }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  ModelStore models_{store_.database()};
};

TEST_F(ModelStoreTest, TheLastApprovalIsTheCellsAndARollbackTakesTheOneBefore) {
  EXPECT_EQ(current(), 0);
  approve(1);
  EXPECT_EQ(current(), 1);
  approve(2);
  approve(3);
  EXPECT_EQ(current(), 3);
  EXPECT_EQ(models_.roll_back("later", "P. Langevin").run_id, 2);
  EXPECT_EQ(current(), 2);
  EXPECT_EQ(models_.roll_back("later", {}).run_id, 1);
  EXPECT_EQ(current(), 1);
  EXPECT_THROW(models_.roll_back("later", {}), std::logic_error) << "there is none before it";
  EXPECT_EQ(current(), 1);
  const auto rows = models_.history();
  ASSERT_THAT(rows, SizeIs(5));
  EXPECT_EQ(rows[3], (Approval{.id = 4,
                               .kind = ApprovalKind::kRolledBack,
                               .run_id = 3,
                               .at = "later",
                               .operator_name = "P. Langevin",
                               .hash = "hash 3"}));
  EXPECT_THAT(damage(), IsEmpty());
}

TEST_F(ModelStoreTest, AnApprovalTellsWhatItWasGivenAlsoToAnotherConnection) {
  approve(2);
  const ModelStore read(open_database_to_read(file_));
  EXPECT_THAT(read.history(), ElementsAre(Approval{.id = 1,
                                                   .kind = ApprovalKind::kApproved,
                                                   .run_id = 2,
                                                   .at = "at 2",
                                                   .operator_name = "M. Curie",
                                                   .hash = "hash 2",
                                                   .valid_until = "then"}));
  EXPECT_EQ(read.document(1), R"({"of":2})");
  EXPECT_EQ(read.arm_json(1), R"({"arm":2})");
  EXPECT_FALSE(read.document(2));
}

TEST_F(ModelStoreTest, WhatUsesAModelIsKeptAndChangesNoModel) {
  approve(1);
  approve(2);
  const Approval noted = models_.note_applied(
      {.run_id = 1, .hash = "hash 1", .to = "pick.dtx", .at = "later", .operator_name = "M. Curie"});
  EXPECT_EQ(noted, (Approval{.id = 3,
                             .kind = ApprovalKind::kApplied,
                             .run_id = 1,
                             .at = "later",
                             .operator_name = "M. Curie",
                             .hash = "hash 1",
                             .applied_to = "pick.dtx"}));
  EXPECT_EQ(models_.history().back(), noted);
  EXPECT_EQ(current(), 2);
  EXPECT_FALSE(models_.document(3)) << "it is no approval";
  models_.roll_back("later", {});
  EXPECT_EQ(current(), 1) << "what is taken back is the approval";
  EXPECT_THAT(damage(), IsEmpty());
  edit("UPDATE models SET document = 'place.dtx' WHERE id = 3");
  EXPECT_THAT(damage(), Contains(HasSubstr("models, row 3: it was changed")));
}

TEST_F(ModelStoreTest, TheCurrentModelIsNotApprovedTwiceAndOneThatWasTakenBackOrReplacedAnew) {
  approve(1);
  NewApproval again = model_of_run(1);
  again.operator_name = "another";
  EXPECT_EQ(models_.approve(again).operator_name, "M. Curie") << "the first word holds";
  EXPECT_THAT(models_.history(), SizeIs(1));
  approve(2);
  models_.roll_back("later", {});
  EXPECT_EQ(models_.approve(model_of_run(2)).id, 4);
  EXPECT_EQ(models_.approve(again).operator_name, "another") << "another model stood before it";
  EXPECT_EQ(current(), 1);
  EXPECT_EQ(models_.roll_back("later", {}).run_id, 2);
}

TEST_F(ModelStoreTest, AChangeOfAnyFieldIsRefusedAndVerifyNamesItsRow) {
  approve(1);
  approve(2);
  approve(3);
  for (const std::string field : {"kind", "at", "operator_name", "hash", "valid_until", "document", "arm"}) {
    const std::string was =
        store_.database()->execAndGet("SELECT quote(" + field + ") FROM models WHERE id = 2").getString();
    edit("UPDATE models SET " + field + " = 'other' WHERE id = 2");
    EXPECT_THROW((void)models_.history(), DamagedStore) << field;
    EXPECT_THROW((void)models_.document(2), DamagedStore) << field;
    EXPECT_THROW(approve(1), DamagedStore) << field;
    EXPECT_THAT(damage(), AllOf(Contains(HasSubstr("table models, run 2, number 2")),
                                Contains(HasSubstr("models, row 2: it was changed"))))
        << field;
    edit("UPDATE models SET " + field + " = " + was + " WHERE id = 2");
    EXPECT_THAT(damage(), IsEmpty()) << field;
  }
  EXPECT_THAT(models_.history(), SizeIs(3));
}

TEST_F(ModelStoreTest, ARowWithANewChecksumIsFoundByItsChain) {
  approve(1);
  approve(2);
  edit("UPDATE models SET operator_name = 'another' WHERE id = 1");
  edit(
      "UPDATE models SET checksum = row_checksum('models', id, kind, run_id, at, operator_name, hash, "
      "valid_until, document, arm, chained) WHERE id = 1");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("models, row 1")));
}

TEST_F(ModelStoreTest, RowsThatWereTakenOutAreMissed) {
  for (const char* id : {"1", "2", "3"}) {
    const Folder other;
    const auto file = other.path() / "copy.sqlite";
    if (models_.history().empty()) {
      approve(1);
      approve(2);
      approve(3);
    }
    back_up(file_, file);
    const SharedDatabase database = open_database(file);
    EXPECT_THAT(ModelStore(database).history(), SizeIs(3)) << "a backup has them";
    database->exec(std::string("DELETE FROM models WHERE id = ") + id);
    EXPECT_THROW((void)ModelStore(database).history(), DamagedStore) << id;
    EXPECT_THAT(find_damage(file), ElementsAre(HasSubstr("taken out"))) << id;
  }
}

TEST_F(ModelStoreTest, EachRowHasTheHashOfTheOneBeforeWithItsOwnContent) {
  approve(1);
  approve(2);
  const auto chained = [&](const std::string& id) {
    return store_.database()->execAndGet("SELECT chained FROM models WHERE id = " + id).getString();
  };
  const std::string first = sha256_hex(R"(1:18:approved1:14:at 18:M. Curie6:hash 10:8:{"of":1}9:{"arm":1})");
  EXPECT_EQ(chained("1"), first);
  EXPECT_EQ(chained("2"), sha256_hex(first + R"(1:28:approved1:24:at 28:M. Curie6:hash 24:then)"
                                             R"(8:{"of":2}9:{"arm":2})"));
}

TEST_F(ModelStoreTest, ARunWithAModelStaysHoweverOldItIsAlsoWhereThatWasTakenBack) {
  approve(1);
  approve(2);
  models_.roll_back("later", {});
  store_.finish_interrupted("later");
  for (int i = 0; i < kLastRunsKept; ++i)
    store_.begin_run({.recipe = "edf-25", .started_at = "2026-03-0" + std::to_string(1 + i % 3)});
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-01"), 1);
  EXPECT_TRUE(store_.run(1) && store_.run(2));
  EXPECT_FALSE(store_.run(3));
  EXPECT_EQ(current(), 1);
  EXPECT_THAT(damage(), IsEmpty());
}

}  // namespace
}  // namespace cell
