#include "service/archive/archive_reader.hpp"

#include <gmock/gmock.h>

#include "service/base/digest.hpp"
#include "service/documents/json_view.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/model_store.hpp"
#include "service/store/run_page.hpp"
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
  EXPECT_THAT(damage_after("UPDATE event SET at = '2025-01-01' WHERE seq = 2"),
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

/// A run of a block with three roles, a result, an arm and a plan.
void planned_run_of(RunStore& store) {
  const std::int64_t run =
      store.begin_run({.recipe = "edf-25", .touches_total = 3, .started_at = "2026-01-01T00:00:00.000Z"});
  store.set_plan(run, 3, "plan", R"({"plan":1})");
  int number = 0;
  for (const auto role : {calib::TouchRole::kFit, calib::TouchRole::kHeldOut, calib::TouchRole::kProof})
    store.append_touch(run, {.number = ++number,
                             .plane = number,
                             .role = role,
                             .joints = {number, -2, 3, 4, 5, 2'000'000'000},
                             .captured_at = "2026-01-01T00:00:01.000Z"});
  store.finish_run(run, {.outcome = RunOutcome::kComplete,
                         .verdict = Verdict::kAccepted,
                         .ended_at = "2026-01-01T00:01:00.000Z",
                         .result_json = R"({"a":"ä"})",
                         .arm_json = R"({"b":2})"});
}

TEST_F(ArchiveTest, VerifySeesWhatGoesWithTheEvents) {
  planned_run_of(store_);
  const auto damage_after = [&](const std::string& tampering) {
    sql("TRUNCATE event, touch, document");
    connect()->deliver(facts(), {});
    EXPECT_THAT(look_at_archive(owner_).damage, IsEmpty());
    EXPECT_GE(sql(tampering), 1u) << tampering;
    return look_at_archive(owner_).damage;
  };
  const std::string changed = "cell edf, event 2: its touches were changed";
  for (const char* change :
       {"UPDATE touch SET joints_microdeg[6] = 7 WHERE number = 2", "UPDATE touch SET role = 'fit'",
        "UPDATE touch SET plane = 2 WHERE number = 1", "UPDATE touch SET captured_at = '' WHERE number = 3",
        "UPDATE touch SET number = 4 WHERE number = 3"}) {
    EXPECT_THAT(damage_after(change), ElementsAre(changed)) << change;
  }
  EXPECT_THAT(damage_after("DELETE FROM touch WHERE number = 3"),
              ElementsAre("cell edf, event 2: 2 touches are there, of 3"));
  EXPECT_THAT(damage_after("DELETE FROM touch"), ElementsAre("cell edf, event 2: 0 touches are there, of 3"));
  EXPECT_THAT(look_at_archive(owner_, {.touches = false}).damage, IsEmpty()) << "a head office without them";
  EXPECT_THAT(damage_after("DELETE FROM document WHERE body LIKE '%plan%'"),
              ElementsAre("cell edf, event 2: the document of its plan_sha256 is not there"));
  sql("ALTER TABLE document DROP CONSTRAINT document_check");
  EXPECT_THAT(damage_after("UPDATE document SET body = replace(body, '2', '3')"),
              ElementsAre("document " + sha256_hex(R"({"b":2})") + ": it was changed"));
}

TEST_F(ArchiveTest, VerifyTellsOfEachCellWhereItBeginsAndEndsAndWhatHasGoneSince) {
  run_of(store_);
  run_of(store_);
  connect()->deliver(facts(), {});
  const ArchiveDocument whole = look_at_archive(owner_);
  ASSERT_EQ(whole.chains.size(), 1u);
  EXPECT_EQ(whole.chains[0].cell, "edf");
  EXPECT_EQ(whole.chains[0].first, 1);
  EXPECT_EQ(whole.chains[0].last, 6);
  EXPECT_EQ(whole.chains[0].last_sha256, facts().back().sha256);
  const ArchiveLook since{.earlier = archive_document_from(document_text(whole))};
  store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:02:00.000Z"});
  connect()->deliver(facts(), {});
  EXPECT_THAT(look_at_archive(owner_, since).damage, IsEmpty()) << "more has come";
  sql("DELETE FROM event WHERE seq < 3 OR seq > 5");
  const ArchiveDocument middle = look_at_archive(owner_);
  EXPECT_THAT(middle.damage, IsEmpty()) << "it may have begun there, and ended";
  EXPECT_EQ(middle.chains.at(0).first, 3);
  EXPECT_EQ(middle.chains.at(0).last, 5);
  EXPECT_THAT(look_at_archive(owner_, since).damage,
              ElementsAre("cell edf: events 1 to 2 are missing", "cell edf: events 6 to 6 are missing"));
  sql("DELETE FROM event");
  EXPECT_THAT(look_at_archive(owner_, since).damage,
              ElementsAre("cell edf: all its events are missing, 1 to 6"));
  const Folder folder;
  RunStore another(folder.path() / "touchcal.sqlite");
  for (int i = 0; i < 2; ++i) run_of(another, "edf-37");
  connect_archive(writer_, "edf", another.file())->deliver(OutboxReader(another.file()).next(0, 100), {});
  EXPECT_THAT(look_at_archive(owner_, since).damage,
              ElementsAre("cell edf, event 6: it is another one than earlier"));
}

TEST_F(ArchiveTest, VerifySeesAFirstEventThatFollowsNoneOrOneThatIsNotThere) {
  const auto damage_of_first = [&](std::int64_t seq, const std::string& previous) {
    sql("TRUNCATE event");
    sql("INSERT INTO event(cell, seq, instance, kind, at, previous, body, sha256) VALUES('edf', " +
        std::to_string(seq) + ", 1, 'fault', '2026-01-01T00:00:00Z', '" + previous + "', '{}', '" +
        fact_digest({.seq = seq,
                     .instance = 1,
                     .kind = "fault",
                     .at = "2026-01-01T00:00:00Z",
                     .run_id = {},
                     .previous = previous,
                     .body = "{}",
                     .sha256 = {}}) +
        "')");
    return look_at_archive(owner_).damage;
  };
  EXPECT_THAT(damage_of_first(1, ""), IsEmpty());
  EXPECT_THAT(damage_of_first(5, "ab"), IsEmpty()) << "it got its archive late";
  EXPECT_THAT(damage_of_first(1, "ab"), ElementsAre("cell edf, event 1: the event before is another one"));
  EXPECT_THAT(damage_of_first(5, ""), ElementsAre("cell edf, event 5: the event before is another one"));
}

TEST_F(ArchiveTest, VerifyComparesWhatAnOlderDaemonToldByItsCountOnly) {
  const std::string body =
      R"json({"touches":3,"touches_sha256":"x","result_sha256":null,"arm_sha256":null})json";
  Fact old{.seq = 1,
           .instance = 1,
           .kind = "touch_set_closed",
           .at = "2026-01-01T00:00:00Z",
           .run_id = 1,
           .previous = "",
           .body = body,
           .sha256 = {}};
  planned_run_of(store_);
  old.sha256 = fact_digest(old);
  connect()->deliver(std::vector{old}, {});
  EXPECT_THAT(look_at_archive(owner_).damage, IsEmpty());
  sql("UPDATE touch SET joints_microdeg[6] = 7 WHERE number = 2");
  EXPECT_THAT(look_at_archive(owner_).damage, IsEmpty());
  sql("DELETE FROM touch WHERE number = 2");
  EXPECT_THAT(look_at_archive(owner_).damage, ElementsAre("cell edf, event 1: 2 touches are there, of 3"));
}

TEST_F(ArchiveTest, VerifyGoesOnBehindABodyThatCannotBeRead) {
  run_of(store_);
  connect()->deliver(facts(), {});
  sql("ALTER TABLE event DROP CONSTRAINT can_be_read");
  sql("UPDATE event SET body = '[1]' WHERE seq = 2");
  sql("DELETE FROM event WHERE seq = 3");
  EXPECT_THAT(look_at_archive(owner_).damage, ElementsAre("cell edf, event 2: it was changed"));
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

/// What the cell itself answers to GET /api/v1/runs, and what the archive says of it.
TEST_F(ArchiveTest, TheRunsOfACellAreThoseThatItListsItself) {
  const auto conditions = [](const char* touching) {
    return std::string(R"({"touching":")") + touching + R"("})";
  };
  const std::int64_t calibration = store_.begin_run({.recipe = "edf-25",
                                                     .started_at = "2026-01-01T00:00:00.000Z",
                                                     .conditions_json = conditions("automatic")});
  store_.set_plan(calibration, 3, "plan", "{}");
  touch(store_, calibration, 3);
  store_.finish_run(calibration, {.outcome = RunOutcome::kComplete,
                                  .verdict = Verdict::kAccepted,
                                  .ended_at = "2026-01-01T00:01:00.000Z",
                                  .result_json = R"({"arm":"tx90"})",
                                  .arm_json = "{}"});
  store_.withdraw_run(store_.begin_run({.recipe = "edf-37", .started_at = "2026-01-02T00:00:00.000Z"}));
  for (const RunKind kind : {RunKind::kCheck, RunKind::kProof, RunKind::kQualification, RunKind::kTool}) {
    const std::int64_t run = store_.begin_run({.kind = kind,
                                               .of_run = calibration,
                                               .recipe = "edf-25",
                                               .started_at = "2026-01-03T00:00:00.000Z",
                                               .conditions_json = conditions("guided")});
    store_.finish_run(run, {.outcome = RunOutcome::kAborted,
                            .ended_at = "2026-01-03T00:01:00.000Z",
                            .fault_code = "collision",
                            .fault_message = "the arm hit"});
  }
  store_.begin_run({.recipe = "edf-37",
                    .started_at = "2026-01-04T00:00:00.000Z",
                    .conditions_json = conditions("automatic")});
  connect()->deliver(facts(), {});
  EXPECT_EQ(document_text(runs_of_cell(owner_, "edf", 50)), runs_document(run_page(store_, 50, {})));
  const RunsDocument newest = runs_of_cell(owner_, "edf", 2);
  ASSERT_EQ(newest.runs.size(), 2U);
  EXPECT_EQ(newest.next_before, newest.runs.back().id);
  const RunsDocument older = runs_of_cell(owner_, "edf", 50, std::stoll(*newest.next_before));
  EXPECT_EQ(older.runs.size(), 4U);
  EXPECT_EQ(older.next_before, std::nullopt);
  EXPECT_THAT(runs_of_cell(owner_, "another", 50).runs, IsEmpty());
}

TEST_F(ArchiveTest, ARunWhoseFactsAreMadeUpIsNamed) {
  int seq = 0;
  const auto tell = [&](const char* kind, const char* run, const std::string& body) {
    sql("INSERT INTO event(cell, seq, instance, kind, at, run, previous, body, sha256) VALUES('liar', " +
        std::to_string(++seq) + ", 1, '" + kind + "', '2026-01-01', " + run + ", '', '" + body + "', '')");
  };
  tell("run_started", "1", R"({"recipe":"edf-25"})");
  tell("run_ended", "1", R"({"outcome":"won"})");
  tell("run_started", "2", R"({"recipe":7})");
  tell("run_started", "3", R"({"recipe":"edf-25"})");
  tell("fault", "3", R"({"code":7})");
  const RunsDocument page = runs_of_cell(owner_, "liar", 50);
  ASSERT_EQ(page.runs.size(), 1U);
  EXPECT_EQ(page.runs.front().id, "3");
  ASSERT_EQ(page.damaged.size(), 2U);
  EXPECT_EQ(page.damaged.front().id, "2");
  EXPECT_THAT(page.damaged.back().detail, ::testing::HasSubstr("event 2 of the archive: /outcome: 'won'"));
}

}  // namespace
}  // namespace cell
