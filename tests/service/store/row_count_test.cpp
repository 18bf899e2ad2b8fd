#include "service/store/internal/row_count.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "service/store/answer_store.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RowCountTest : public ::testing::Test {
 protected:
  void answer(const std::string& key, const std::string& at) {
    const KeyedRequest request{key, "POST /api/v1/runs", ""};
    answers_.take(request, "t0");
    answers_.keep(request, {.status = 201, .body = "{}"}, at);
  }
  [[nodiscard]] std::vector<std::string> damage() { return find_damage(file_); }
  void change(const std::string& sql) { EXPECT_GT(store_.database()->exec(sql), 0) << sql; }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  FaultLog faults_{store_.database()};
  AnswerStore answers_{store_.database()};
};

TEST_F(RowCountTest, RowsThatTheDaemonDeletesItselfAreNotMissed) {
  const std::int64_t run = store_.begin_run({.recipe = "edf-25", .started_at = "2020"});
  faults_.append(run, "t1", "no_contact", "of a run that goes");
  for (int i = 0; i < kLastRunsKept; ++i) store_.begin_run({.recipe = "edf-25", .started_at = "2026"});
  store_.finish_interrupted("2026");
  EXPECT_EQ(delete_runs_before(store_.database(), "2021", 1), 1);
  faults_.append({}, "t2", "no_contact", "another");
  answer("old", "t1");
  EXPECT_TRUE(std::holds_alternative<KeyIsNew>(answers_.take({"new", "POST /api/v1/runs", ""}, "t2")));
  EXPECT_EQ(store_.database()->execAndGet("SELECT count(*) FROM answers").getInt(), 0) << "its day is over";
  answer("same", "t3");
  answers_.keep({"same", "POST /api/v1/runs", ""}, {.status = 202}, "t4");
  EXPECT_THAT(damage(), IsEmpty());
}

TEST_F(RowCountTest, TheOldestFaultsGoByTheirNumberAndAreNotMissed) {
  for (int i = 0; i < 3; ++i) faults_.append({}, "t", "no_contact", "early");
  faults_.append({}, "t", "no_contact", "late");
  // As if so many had come between.
  change("UPDATE faults SET id = id + " + std::to_string(FaultLog::kKept) + " WHERE message = 'late'");
  change("UPDATE faults SET checksum = row_checksum('faults', id, run_id, at, code, message)");
  faults_.append({}, "t", "no_contact", "latest");
  EXPECT_EQ(faults_.page(10).size(), 2u);
  EXPECT_THAT(damage(), IsEmpty());
}

TEST_F(RowCountTest, RowsThatWereTakenOutOrPutInAreTold) {
  faults_.append({}, "t1", "no_contact", "the search ended");
  faults_.append({}, "t2", "collision", "it hit something");
  answer("key", "t1");
  change("DELETE FROM faults");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("table faults: 2 rows that it had are not there")));
  change("DELETE FROM answers");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("table faults"), HasSubstr("table answers: 1 rows")));
  faults_.append({}, "t3", "no_contact", "later");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("table faults: 2 rows"), HasSubstr("table answers")))
      << "for ever";
  change(
      "INSERT INTO faults(at, code, message) VALUES('t', 'a', 'b'), ('t', 'a', 'b'), ('t', 'a', 'b'); UPDATE "
      "faults SET checksum = row_checksum('faults', id, run_id, at, code, message)");
  EXPECT_THAT(damage(),
              ElementsAre(HasSubstr("table faults: 1 rows were put in"), HasSubstr("table answers")));
}

TEST_F(RowCountTest, ACountThatWasChangedOrTakenOutIsToldAndNotMadeWhole) {
  faults_.append({}, "t1", "no_contact", "the search ended");
  change("DELETE FROM faults; UPDATE row_counts SET row_count = 0 WHERE name = 'faults'");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("table row_counts, number faults")));
  faults_.append({}, "t2", "no_contact", "later");
  EXPECT_THAT(damage(), ElementsAre(HasSubstr("table row_counts, number faults"), HasSubstr("table faults")));
  change("DELETE FROM row_counts WHERE name = 'answers'");
  EXPECT_THAT(damage(), ::testing::Contains(HasSubstr("table row_counts: that of answers")));
}

}  // namespace
}  // namespace cell
