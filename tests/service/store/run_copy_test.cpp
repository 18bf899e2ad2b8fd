#include "service/store/run_copy.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "service/store/maintenance.hpp"
#include "service/store/outbox.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/copied_run.hpp"

namespace cell {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// With the documents that only a store does not read.
RunCopy copied_with_documents() {
  RunCopy copy = copied_run();
  copy.run.plan_id = "plan";
  copy.plan_json = R"({"plan":1})";
  copy.result_json = R"({"result":1})";
  copy.arm_json = R"({"name":"tx90"})";
  return copy;
}

class RunCopyTest : public ::testing::Test {
 protected:
  static RunOrigin origin() {
    return {.cell = "hall 3",
            .run_id = 7,
            .exported_at = "2026-02-01T00:00:00.000Z",
            .imported_at = "2026-02-02T00:00:00.000Z",
            .sha256 = "digest"};
  }
  std::int64_t import(const RunCopy& copy) { return imports_.add(copy, origin(), copy.run.of_run); }
  [[nodiscard]] std::int64_t count(const std::string& of) const {
    return store_.database()->execAndGet("SELECT count(*) FROM " + of).getInt64();
  }
  std::int64_t own_run(const std::string& started_at) {
    const std::int64_t run = store_.begin_run({.recipe = "own", .started_at = started_at});
    store_.finish_run(run,
                      {.outcome = RunOutcome::kComplete, .verdict = Verdict::kAccepted, .ended_at = "end"});
    return run;
  }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  RunImports imports_{store_.database()};
};

TEST_F(RunCopyTest, AnImportedRunIsTheCopyInAllThatIsStoredOfIt) {
  const RunCopy given = copied_with_documents();
  own_run("before");
  const std::int64_t id = import(given);
  EXPECT_EQ(id, 2);
  RunCopy found = copy_of_run(store_, store_.run(id).value());
  EXPECT_EQ(found.touches, given.touches);
  ASSERT_THAT(found.superseded, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found.superseded[i].touch, given.superseded[i].touch);
    EXPECT_EQ(found.superseded[i].reason, given.superseded[i].reason);
  }
  ASSERT_THAT(found.references, SizeIs(2));
  EXPECT_EQ(found.references[1].joints, given.references[1].joints);
  EXPECT_EQ(found.references[1].drift_mm, given.references[1].drift_mm);
  EXPECT_FALSE(found.references[0].drift_mm);
  ASSERT_THAT(found.plan_changes, SizeIs(2));
  EXPECT_EQ(found.plan_changes[1].kind, PlanChange::Kind::kSkip);
  EXPECT_EQ(found.plan_changes[1].place, 2);
  EXPECT_EQ(found.refused, given.refused);
  EXPECT_EQ(found.plan_json, given.plan_json);
  EXPECT_EQ(found.result_json, given.result_json);
  EXPECT_EQ(found.arm_json, given.arm_json);
  const StoredRun& run = found.run;
  EXPECT_EQ(run.origin, origin());
  EXPECT_EQ(run.recipe, "edf-25");
  EXPECT_EQ(run.touches_total, 3);
  EXPECT_EQ(run.touches_done, 2);
  EXPECT_EQ(run.started_at, given.run.started_at);
  EXPECT_EQ(run.ended_at, given.run.ended_at);
  EXPECT_EQ(run.outcome, RunOutcome::kComplete);
  EXPECT_EQ(run.verdict, Verdict::kAccepted);
  EXPECT_EQ(run.fault_code, given.run.fault_code);
  EXPECT_EQ(run.fault_message, given.run.fault_message);
  EXPECT_EQ(run.operator_name, given.run.operator_name);
  EXPECT_EQ(run.block_temperature, given.run.block_temperature);
  EXPECT_EQ(run.stiffness, given.run.stiffness);
  EXPECT_EQ(run.config_digest, given.run.config_digest);
  EXPECT_EQ(run.conditions_json, given.run.conditions_json);
  EXPECT_FALSE(store_.run(1)->origin) << "the other run is of this daemon";
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

TEST_F(RunCopyTest, AnImportedRunIsNoneOfThisCell) {
  const std::int64_t own = own_run("before");
  const std::int64_t facts = count("outbox");
  const std::int64_t imported = import(copied_with_documents());
  EXPECT_EQ(store_.last_accepted()->id, own);
  EXPECT_EQ(count("outbox"), facts) << "nobody hears of it as of a run of this cell";
  EXPECT_EQ(run_of_answer(store_, 1, 1), own) << "an answer that nobody asked for is kept with the own one";
  EXPECT_EQ(store_.runs(1).front().id, imported) << "it is in the history";
}

TEST_F(RunCopyTest, ItsPlanDoesNotStandForOneOfThisCell) {
  const std::int64_t imported = import(copied_with_documents());
  const std::int64_t own = store_.begin_run({.recipe = "edf-25", .started_at = "later"});
  store_.set_plan(own, 1, "plan", R"({"plan":"of this cell"})");
  EXPECT_EQ(store_.plan_json(own), R"({"plan":"of this cell"})");
  EXPECT_EQ(store_.plan_json(imported), R"({"plan":1})");
}

TEST_F(RunCopyTest, ARunThatIsHereIsFound) {
  EXPECT_EQ(imports_.find(origin(), copied_run().run.started_at, "own cell"), std::nullopt);
  const std::int64_t imported = import(copied_run());
  EXPECT_EQ(imports_.find(origin(), copied_run().run.started_at, "own cell"), imported);
  EXPECT_EQ(imports_.imported_run("hall 3", 7), imported);
  EXPECT_EQ(imports_.find(origin(), "another time", "own cell"), std::nullopt)
      << "of a store that began anew";
  RunOrigin other = origin();
  other.cell = "hall 4";
  EXPECT_EQ(imports_.find(other, copied_run().run.started_at, "own cell"), std::nullopt);
  EXPECT_EQ(imports_.imported_run("hall 4", 7), std::nullopt);
}

TEST_F(RunCopyTest, ARunOfThisDaemonIsFoundByItsCellAndItsNumber) {
  const std::int64_t own = own_run("then");
  RunOrigin mine = origin();
  mine.run_id = own;
  EXPECT_EQ(imports_.find(mine, "then", "hall 3"), own);
  EXPECT_EQ(imports_.find(mine, "then", "hall 4"), std::nullopt);
}

TEST_F(RunCopyTest, WhereARowCannotBeWrittenNothingOfTheRunIs) {
  RunCopy doubled = copied_with_documents();
  doubled.touches[1].number = doubled.touches[0].number;
  EXPECT_THROW(import(doubled), SQLite::Exception);
  for (const char* table : {"runs", "touches", "superseded_touches", "plans", "arms", "imported_runs"})
    EXPECT_EQ(count(table), 0) << table;
}

TEST_F(RunCopyTest, ItIsKeptFromItsImportOnAsLongAsARunThatBeganThen) {
  import(copied_with_documents());
  for (int i = 0; i < kLastRunsKept; ++i) own_run("2126-01-0" + std::to_string(1 + i % 3) + "T08:00:00.000Z");
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-01T12:00:00.000Z"), 0);
  EXPECT_EQ(delete_runs_before(store_.database(), "2026-02-03T00:00:00.000Z"), 1);
  EXPECT_EQ(count("imported_runs"), 0);
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

TEST_F(RunCopyTest, AChangedOriginIsFound) {
  import(copied_with_documents());
  EXPECT_EQ(store_.database()->exec("UPDATE imported_runs SET cell = 'this one'"), 1);
  EXPECT_THAT(find_damage(file_), SizeIs(1));
  EXPECT_ANY_THROW(store_.run(1));
}

}  // namespace
}  // namespace cell
