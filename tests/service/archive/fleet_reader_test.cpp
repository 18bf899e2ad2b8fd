#include "service/archive/fleet_reader.hpp"

#include <gmock/gmock.h>

#include "service/store/fault_log.hpp"
#include "service/store/model_store.hpp"
#include "tests/service/archive/archive_bench.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST_F(ArchiveTest, TheFleetIsTheLastThatEachCellTold) {
  EXPECT_THAT(fleet_of(owner_).cells, IsEmpty());
  run_of(store_);
  run_of(store_, "edf-37");
  ModelStore models(store_.database());
  for (const char* hash : {"one", "two"})
    models.approve(
        {.run_id = 1,
         .at = "2026-01-02",
         .hash = hash,
         .valid_until = "2020-01-01T00:00:00.000Z",
         .document = R"({"arm":"tx90","arm_serial":"N1","tip_uncertainty":{"expanded":{"box_max_mm":0.25}}})",
         .arm_json = "{}"});
  const std::int64_t check = store_.begin_run(
      {.kind = RunKind::kCheck, .of_run = 1, .recipe = "edf-25", .started_at = "2026-01-02"});
  store_.finish_run(check, {.outcome = RunOutcome::kComplete,
                            .verdict = Verdict::kRejected,
                            .ended_at = "2026-01-02T08:00:00.000Z",
                            .result_json = R"({"arm":"tx90l","cause":"joint","every_days":7})"});
  models.roll_back("2026-01-03", {});
  models.note_applied({.run_id = 1, .hash = "one", .to = "pick.dtx", .at = "2026-01-03T01:00:00.000Z"});
  FaultLog(store_.database()).append({}, "2026-01-04", "link_lost", "");
  const std::int64_t withdrawn = store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-05"});
  store_.withdraw_run(withdrawn);
  Outbox(store_.database()).tell_expiring({{"block", "2026-02-01"}}, "2026-01-05T00:00:00.000Z");
  store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-05"});
  connect()->deliver(facts(), {});
  sql("INSERT INTO event(cell, seq, instance, kind, at, previous, body, sha256) VALUES('another', 1, 1, "
      "'fault', "
      "'2026-01-01', '', '{\"code\":\"x\"}', '')");
  const auto fleet = fleet_of(owner_).cells;
  ASSERT_EQ(fleet.size(), 2u);
  EXPECT_EQ(fleet[0].cell, "another");
  EXPECT_EQ(fleet[0].last_run_id, std::nullopt);
  EXPECT_EQ(fleet[0].model, std::nullopt);
  const FleetCell& cell = fleet[1];
  EXPECT_EQ(cell.cell, "edf");
  EXPECT_EQ(cell.last_event_at, "2026-01-05");
  EXPECT_EQ(cell.state, "running");
  EXPECT_EQ(fleet[0].state, std::nullopt) << "it never began one";
  EXPECT_FALSE(cell.heard_at.empty());
  EXPECT_EQ(cell.arm, "tx90") << "of the rollback, behind a check that said another";
  EXPECT_EQ(cell.arm_serial, "N1");
  EXPECT_EQ(cell.applied_model, "one");
  EXPECT_EQ(cell.applied_at, "2026-01-03T01:00:00.000Z");
  EXPECT_EQ(cell.applied_to, "pick.dtx");
  EXPECT_EQ(cell.last_run_id, "2");
  EXPECT_EQ(cell.recipe, "edf-37");
  EXPECT_EQ(cell.verdict, "accepted");
  EXPECT_EQ(cell.model, "one");
  EXPECT_EQ(cell.valid_until, "2020-01-01T00:00:00.000Z");
  EXPECT_TRUE(cell.model_over);
  EXPECT_FALSE(fleet[0].model_over) << "it has none";
  EXPECT_EQ(cell.tip_box_max_mm, 0.25);
  EXPECT_EQ(cell.last_check_at, "2026-01-02T08:00:00.000Z");
  EXPECT_EQ(cell.check_due_at, "2026-01-09T08:00:00.000Z");
  EXPECT_TRUE(cell.check_overdue);
  EXPECT_EQ(cell.certificate_artefact, "block");
  EXPECT_EQ(cell.certificate_valid_until, "2026-02-01");
  EXPECT_EQ(cell.last_check_verdict, "rejected");
  EXPECT_EQ(cell.last_check_cause, "joint");
  EXPECT_EQ(cell.last_proof_at, std::nullopt);
  EXPECT_EQ(cell.last_fault_code, "link_lost");
}

/// A fact of any cell, of so many months ago at noon of the month's first day.
std::string told(const std::string& cell, int seq, const std::string& kind, int months_ago,
                 const std::string& body) {
  return "INSERT INTO event(cell, seq, instance, kind, at, previous, body, sha256) SELECT '" + cell + "', " +
         std::to_string(seq) + ", 1, '" + kind + "', to_char((now() AT TIME ZONE 'UTC') - interval '" +
         std::to_string(months_ago) + " months', 'YYYY-MM-01') || 'T12:00:00.000Z', '', '" + body + "', ''";
}

TEST_F(ArchiveTest, TrendsAreByTypeOfArmAndMonth) {
  EXPECT_THAT(trends_of(owner_, 12).trends, IsEmpty());
  int seq = 0;
  const auto tell = [&](const std::string& cell, const std::string& kind, int months_ago,
                        const std::string& body) { sql(told(cell, ++seq, kind, months_ago, body)); };
  for (const char* cell : {"a", "b", "c"})
    tell(cell, "run_ended", 0,
         R"({"arm":"tx90","kind":"calibration","outcome":"complete","verdict":"accepted"})");
  tell("a", "run_ended", 0,
       R"({"arm":"tx90","kind":"calibration","outcome":"complete","verdict":"rejected"})");
  tell("a", "run_ended", 0, R"({"arm":null,"kind":"calibration","outcome":"stopped","verdict":"none"})");
  tell("a", "run_ended", 0, R"({"arm":"tx90","kind":"check","outcome":"complete","verdict":"rejected"})");
  for (const char* mm : {"0.1", "0.4", "0.2", "null"})
    tell("a", "approved", 0, std::string(R"({"arm":"tx90","tip_box_max_mm":)") + mm + "}");
  tell("b", "check", 0, R"({"arm":"tx90","verdict":"rejected","growth_ppm":-10})");
  tell("b", "check", 0, R"({"arm":"tx90","verdict":"accepted","growth_ppm":20})");
  tell("c", "proof", 0, R"({"arm":"tx90","verdict":"rejected"})");
  tell("c", "proof", 0, R"({"arm":"tx90","verdict":"accepted"})");
  tell("c", "fault", 0, R"({"code":"link_lost"})");
  tell("c", "check", 1, R"({"arm":"tx90","verdict":"accepted","growth_ppm":5})");
  tell("old", "fault", 1, R"({"code":"link_lost"})");
  tell("a", "check", 2, R"({"arm":"tx60","verdict":"accepted","growth_ppm":5})");
  const auto all = trends_of(owner_, 12).trends;
  ASSERT_THAT(all, SizeIs(4));
  const FleetTrend& now = all[0];
  EXPECT_EQ(now.arm, "tx90");
  EXPECT_EQ(now.cells, 3);
  EXPECT_EQ(now.calibrations, 4) << "of those that came to their end";
  EXPECT_EQ(now.rejected, 1);
  EXPECT_EQ(now.approved, 4);
  EXPECT_EQ(now.tip_box_max_mm, 0.2) << "the median of what is known";
  EXPECT_EQ(now.checks, 2);
  EXPECT_EQ(now.alarms, 1);
  EXPECT_EQ(now.growth_ppm, 5.0);
  EXPECT_EQ(now.proofs, 2);
  EXPECT_EQ(now.failed_proofs, 1);
  EXPECT_EQ(now.faults, 1) << "which names no arm: it is the cell's";
  EXPECT_LT(all[1].month, now.month);
  EXPECT_EQ(all[1].arm, "tx90");
  EXPECT_EQ(all[1].cells, 1);
  EXPECT_EQ(all[1].tip_box_max_mm, std::nullopt);
  EXPECT_EQ(all[2].arm, std::nullopt) << "a cell that never said its own";
  EXPECT_EQ(all[2].faults, 1);
  EXPECT_EQ(all[3].arm, "tx60") << "what a cell had then";
  EXPECT_THAT(trends_of(owner_, 1).trends, SizeIs(1));
  EXPECT_THAT(trends_of(owner_, 2).trends, SizeIs(3));
}

TEST_F(ArchiveTest, ALaterCalibrationThatIsAcceptedHasChecksOfItsOwn) {
  sql(told("a", 1, "check", 0, R"({"arm":"tx90","verdict":"accepted","every_days":7})"));
  EXPECT_NE(fleet_of(owner_).cells.at(0).check_due_at, std::nullopt);
  sql(told("a", 2, "run_ended", 0, R"({"kind":"calibration","outcome":"complete","verdict":"rejected"})"));
  EXPECT_NE(fleet_of(owner_).cells.at(0).check_due_at, std::nullopt);
  sql(told("a", 3, "run_ended", 0, R"({"kind":"calibration","outcome":"complete","verdict":"accepted"})"));
  EXPECT_EQ(fleet_of(owner_).cells.at(0).check_due_at, std::nullopt);
}

/// The facts of cell "a" in turn, each of a run of its own number.
class ChecksDue : public ArchiveTest {
 protected:
  void tell(const std::string& kind, const std::string& at, const std::string& run, const std::string& body) {
    sql("INSERT INTO event(cell, seq, instance, kind, at, run, previous, body, sha256) VALUES('a', " +
        std::to_string(++seq_) + ", 1, '" + kind + "', '" + at + "', " + run + ", '', '" + body + "', '')");
  }
  void calibrate(const std::string& run, const std::string& at, const std::string& verdict = "accepted") {
    tell("run_ended", at, run,
         R"({"kind":"calibration","outcome":"complete","verdict":")" + verdict + R"("})");
  }
  void check(const std::string& run, const std::string& at, const std::string& of_run) {
    tell("check", at, run, R"({"arm":"tx90","verdict":"accepted","every_days":7,"of_run":)" + of_run + "}");
  }
  void approve(const std::string& run, const std::string& at, const std::string& more = "") {
    tell("approved", at, run, R"({"hash":"h)" + run + R"(","current":"h)" + run + R"(")" + more + "}");
  }
  std::optional<std::string> due() { return fleet_of(owner_).cells.at(0).check_due_at; }

  int seq_ = 0;
};

TEST_F(ChecksDue, TheFirstIsDueFromTheCalibrationThatIsApproved) {
  calibrate("1", "2026-01-01T00:00:00.000Z");
  approve("1", "2026-01-05T00:00:00.000Z", R"(,"every_days":7)");
  EXPECT_EQ(due(), "2026-01-08T00:00:00.000Z") << "as the cell itself says";
  EXPECT_TRUE(fleet_of(owner_).cells.at(0).check_overdue);
  calibrate("2", "2026-01-06T00:00:00.000Z");
  EXPECT_EQ(due(), "2026-01-12T00:00:00.000Z") << "of the approval, where another calibration was the last";
  check("3", "2026-01-09T00:00:00.000Z", "1");
  EXPECT_EQ(due(), "2026-01-16T00:00:00.000Z") << "of the model that is approved, not of the last run";
  approve("2", "2026-01-10T00:00:00.000Z", R"(,"every_days":3)");
  EXPECT_EQ(due(), "2026-01-09T00:00:00.000Z") << "the checks were of the model before";
  check("4", "2026-01-11T00:00:00.000Z", "2");
  EXPECT_EQ(due(), "2026-01-18T00:00:00.000Z");
  tell("rolled_back", "2026-01-12T00:00:00.000Z", "2", R"({"hash":"h2","current":"h1"})");
  EXPECT_EQ(due(), std::nullopt) << "the newest check was of the model that was taken back";
}

TEST_F(ChecksDue, HowOftenIsWhatTheCellSaidLast) {
  calibrate("1", "2026-01-01T00:00:00.000Z");
  approve("1", "2026-01-01T00:00:00.000Z");
  EXPECT_EQ(due(), std::nullopt) << "an older daemon, and no check yet";
  check("2", "2026-01-02T00:00:00.000Z", "1");
  calibrate("3", "2026-02-01T00:00:00.000Z");
  approve("3", "2026-02-02T00:00:00.000Z");
  EXPECT_EQ(due(), "2026-02-08T00:00:00.000Z") << "a check of the model before has said it";
  calibrate("4", "2026-03-01T00:00:00.000Z");
  approve("4", "2026-03-02T00:00:00.000Z", R"(,"every_days":null)");
  EXPECT_EQ(due(), std::nullopt) << "its file does not say it any more";
}

TEST_F(ChecksDue, ACheckThatWasMadeBeforeTheApprovalIsOfThatModelToo) {
  calibrate("1", "2026-01-01T00:00:00.000Z");
  check("2", "2026-01-02T00:00:00.000Z", "1");
  approve("1", "2026-01-03T00:00:00.000Z", R"(,"every_days":7)");
  EXPECT_EQ(due(), "2026-01-09T00:00:00.000Z");
}

TEST_F(ArchiveTest, WhatACellMakesUpIsRefusedOrNothingAndHidesNoOther) {
  run_of(store_);
  connect()->deliver(facts(), {});
  int seq = 0;
  for (const char* body :
       {"no JSON", "[1]", R"({"a":"\u0000"})", R"({"tip_box_max_mm":"much"})", R"({"tip_box_max_mm":1e999})",
        R"({"growth_ppm":1e999})", R"({"valid_until":"never"})"})
    EXPECT_THROW(sql(told("liar", 1, "check", 0, body)), pqxx::sql_error) << body;
  EXPECT_THROW(sql(told("liar", 1, "check", 0, R"({"arm":")" + std::string(1'100'000, 'a') + R"("})")),
               pqxx::sql_error);
  for (const char* kind : {"approved", "check", "applied", "proof", "run_ended", "fault"})
    sql(told("liar", ++seq, kind, 0, R"({"every_days":"1e99","arm":[1],"verdict":{},"kind":7,"hash":[]})"));
  for (const char* change :
       {"at = 'never'", "at = 'now'", "at = '13/02/2026 12:00'", "archived_at = 'infinity'",
        R"(body = '{"valid_until":"13/02/2026"}')", R"(body = '{"rms_mm":"little"}')"})
    EXPECT_THROW(
        sql(std::string("SET datestyle = 'SQL, DMY'; UPDATE event SET ") + change + " WHERE cell = 'liar'"),
        pqxx::sql_error)
        << change;
  const auto fleet = fleet_of(owner_).cells;
  ASSERT_THAT(fleet, SizeIs(2));
  EXPECT_EQ(fleet[1].cell, "liar");
  EXPECT_EQ(fleet[1].check_due_at, std::nullopt);
  EXPECT_FALSE(trends_of(owner_, 240).trends.empty());
}

TEST_F(ArchiveTest, TheCertificateOfACellIsTheFirstThatEndsAndWasNotRenewed) {
  const auto certificate = [&] { return fleet_of(owner_).cells.at(0); };
  const auto tell = [&](const std::vector<ExpiringCertificate>& expiring) {
    Outbox(store_.database()).tell_expiring(expiring, "2026-01-05T00:00:00.000Z");
    connect()->deliver(facts(), {});
  };
  tell({{"block", "2026-02-01"}, {"probe", "2999-01-20"}});
  EXPECT_EQ(certificate().certificate_artefact, "block");
  EXPECT_TRUE(certificate().certificate_over);
  tell({{"probe", "2999-01-20"}});
  EXPECT_EQ(certificate().certificate_artefact, "probe") << "the block's was renewed";
  EXPECT_EQ(certificate().certificate_valid_until, "2999-01-20");
  EXPECT_FALSE(certificate().certificate_over);
  tell({});
  EXPECT_EQ(certificate().certificate_artefact, std::nullopt);
}

TEST_F(ArchiveTest, ACellMayWriteItsOwnFactsAndNothingElse) {
  pqxx::connection connection(writer_);
  const auto may = [&](const std::string& statement) {
    pqxx::work work(connection);
    try {
      work.exec(statement);
      return true;
    } catch (const pqxx::sql_error&) {
      return false;
    }
  };
  const std::string into = "INSERT INTO event(cell, seq, instance, kind, at, previous, body, sha256";
  const std::string values = ", 1, 1, 'fault', '2026-01-01T00:00:00.000Z', '', '{}', ''";
  EXPECT_TRUE(may(into + ") VALUES('edf'" + values + ")"));
  EXPECT_FALSE(may(into + ") VALUES('another'" + values + ")"));
  EXPECT_FALSE(may(into + ", archived_at) VALUES('edf'" + values + ", 'infinity')"))
      << "the archive's own clock";
  EXPECT_FALSE(may("SET LOCAL ROLE touchcal_writer; " + into + ") VALUES('touchcal_writer'" + values + ")"));
  EXPECT_FALSE(may("CREATE TEMP TABLE mine(a integer)"));
  EXPECT_FALSE(
      may("INSERT INTO document SELECT encode(sha256(convert_to(body, 'UTF8')), 'hex'), body FROM (SELECT "
          "repeat('a', 20000000) AS body) AS much"));
  EXPECT_FALSE(may("INSERT INTO touch VALUES('edf', 1, 1, 1, 1, 'fit', '{1,2,3,4,5,6}', 'yesterday')"));
}

TEST_F(ArchiveTest, AMonthThatHasNotComeIsNoTrend) {
  sql(told("ahead", 1, "fault", 0, "{}"));
  sql(told("ahead", 2, "fault", -60, "{}"));
  ASSERT_THAT(trends_of(owner_, 240).trends, SizeIs(1));
  EXPECT_EQ(trends_of(owner_, 240).trends.at(0).faults, 1);
}

TEST_F(ArchiveTest, WhoMayReadOneCellSeesThatOne) {
  run_of(store_);
  connect()->deliver(facts(), {});
  sql(told("another", 1, "fault", 0, "{}"));
  EXPECT_THAT(fleet_of(owner_).cells, SizeIs(2));
  EXPECT_THAT(fleet_of(writer_).cells, SizeIs(1));
  EXPECT_THAT(trends_of(writer_, 240).trends, SizeIs(1));
}

TEST_F(ArchiveTest, AnArchiveThatAnotherVersionPreparedIsSaidToBe) {
  run_of(store_);
  connect()->deliver(facts(), {});
  sql("DROP VIEW fleet, fleet_cell");
  for (const auto& ask : {+[](const std::string& url) { (void)fleet_of(url); },
                          +[](const std::string& url) { (void)trends_of(url, 1); }}) {
    EXPECT_THAT([&] { ask(owner_); },
                ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("touchcal archive prepare")));
  }
  sql("CREATE VIEW fleet AS SELECT cell FROM event");
  EXPECT_THAT([&] { (void)fleet_of(owner_); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("another version of touchcal")));
  EXPECT_NO_THROW(connect()->deliver(facts(), {})) << "a daemon reads none of them";
  prepare_archive(owner_);
  EXPECT_THAT(fleet_of(owner_).cells, SizeIs(1));
}

TEST_F(ArchiveTest, AQueryThatTakesTooLongIsBrokenOff) {
  run_of(store_);
  connect()->deliver(facts(), {});
  pqxx::connection connection(owner_);
  pqxx::work lock(connection);
  lock.exec0("LOCK TABLE event, touchcal_schema IN ACCESS EXCLUSIVE MODE");
  for (const auto& ask :
       {+[](const std::string& url) { (void)fleet_of(url, std::chrono::milliseconds(1)); },
        +[](const std::string& url) { (void)trends_of(url, 1, std::chrono::milliseconds(1)); }}) {
    try {
      ask(owner_);
      ADD_FAILURE() << "it waited for the table";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("statement timeout"));
    }
  }
}

}  // namespace
}  // namespace cell
