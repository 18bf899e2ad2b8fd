#include "service/archive/archive_reader.hpp"

#include <gmock/gmock.h>

#include "service/store/fault_log.hpp"
#include "service/store/model_store.hpp"
#include "tests/service/archive/archive_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST_F(ArchiveTest, VerifyTellsWhatWasChangedOrIsMissing) {
  run_of(store_);
  run_of(store_);
  connect()->deliver(facts(), {});
  const auto damage_after = [&](const std::string& tampering) {
    EXPECT_EQ(sql(tampering), 1u) << tampering;
    return look_at_archive(owner_).damage;
  };
  EXPECT_THAT(damage_after("UPDATE event SET at = '2025' WHERE seq = 2"),
              ElementsAre("cell edf, event 2: it was changed"));
  EXPECT_THAT(damage_after("DELETE FROM event WHERE seq = 2"),
              ElementsAre("cell edf: events 2 to 2 are missing"));
  EXPECT_THAT(damage_after("UPDATE event SET seq = 2 WHERE seq = 3"),
              ::testing::Contains("cell edf, event 2: the event before is another one"));
  sql("DELETE FROM event");
  connect()->deliver(facts(), {});
  EXPECT_THAT(damage_after("DELETE FROM document WHERE body LIKE '%b%'"),
              ElementsAre("cell edf, event 2: the document of its arm_sha256 is not there",
                          "cell edf, event 5: the document of its arm_sha256 is not there"));
}

TEST_F(ArchiveTest, TheHistoryOfACellIsWhatItToldNewestFirst) {
  run_of(store_);
  connect()->deliver(facts(), {});
  const std::vector<Fact> told = facts();
  const HistoryDocument all = history_of(owner_, "edf", 10);
  ASSERT_EQ(all.facts.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i) {
    const ArchivedFact& archived = all.facts[told.size() - 1 - i];
    EXPECT_EQ(archived.seq, told[i].seq);
    EXPECT_EQ(archived.kind, told[i].kind);
    EXPECT_EQ(archived.at, told[i].at);
    EXPECT_EQ(archived.body.text, told[i].body);
  }
  EXPECT_EQ(all.next_before, std::nullopt);
  const HistoryDocument newest = history_of(owner_, "edf", 2);
  EXPECT_EQ(newest.next_before, newest.facts.back().seq);
  const HistoryDocument older = history_of(owner_, "edf", 2, newest.next_before);
  EXPECT_EQ(older.facts.size(), told.size() - 2);
  EXPECT_EQ(older.next_before, std::nullopt);
  EXPECT_THAT(history_of(owner_, "another", 2).facts, IsEmpty());
}

TEST_F(ArchiveTest, TheFleetIsTheLastThatEachCellTold) {
  EXPECT_THAT(fleet_of(owner_).cells, IsEmpty());
  run_of(store_);
  run_of(store_, "edf-37");
  ModelStore models(store_.database());
  for (const char* hash : {"one", "two"})
    models.approve({.run_id = 1,
                    .at = "2026-01-02",
                    .hash = hash,
                    .valid_until = "2027",
                    .document = R"({"tip_uncertainty":{"expanded":{"box_max_mm":0.25}}})",
                    .arm_json = "{}"});
  const std::int64_t check = store_.begin_run(
      {.kind = RunKind::kCheck, .of_run = 1, .recipe = "edf-25", .started_at = "2026-01-02"});
  store_.finish_run(check, {.outcome = RunOutcome::kComplete,
                            .verdict = Verdict::kRejected,
                            .ended_at = "2026-01-02T08",
                            .result_json = R"({"cause":"joint"})"});
  models.roll_back("2026-01-03", {});
  FaultLog(store_.database()).append({}, "2026-01-04", "link_lost", "");
  store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-05"});
  connect()->deliver(facts(), {});
  sql("INSERT INTO event(cell, seq, instance, kind, at, previous, body, sha256) VALUES('another', 1, 1, "
      "'fault', "
      "'2026', '', '{\"code\":\"x\"}', '')");
  const auto fleet = fleet_of(owner_).cells;
  ASSERT_EQ(fleet.size(), 2u);
  EXPECT_EQ(fleet[0].cell, "another");
  EXPECT_EQ(fleet[0].last_run_id, std::nullopt);
  EXPECT_EQ(fleet[0].model, std::nullopt);
  const FleetCell& cell = fleet[1];
  EXPECT_EQ(cell.cell, "edf");
  EXPECT_EQ(cell.last_event_at, "2026-01-05");
  EXPECT_EQ(cell.last_run_id, "2");
  EXPECT_EQ(cell.recipe, "edf-37");
  EXPECT_EQ(cell.verdict, "accepted");
  EXPECT_EQ(cell.model, "one");
  EXPECT_EQ(cell.valid_until, "2027");
  EXPECT_EQ(cell.tip_box_max_mm, 0.25);
  EXPECT_EQ(cell.last_check_at, "2026-01-02T08");
  EXPECT_EQ(cell.last_check_verdict, "rejected");
  EXPECT_EQ(cell.last_check_cause, "joint");
  EXPECT_EQ(cell.last_proof_at, std::nullopt);
  EXPECT_EQ(cell.last_fault_code, "link_lost");
}

}  // namespace
}  // namespace cell
