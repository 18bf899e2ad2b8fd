#include "service/store/outbox.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "service/base/digest.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/model_store.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/store/numbered_touch.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int kAll = 1000;

class OutboxTest : public ::testing::Test {
 protected:
  std::int64_t begin() {
    return store_.begin_run({.recipe = "edf-25",
                             .started_at = "2026-01-02T00:00:00.000Z",
                             .operator_name = "M. Curie",
                             .config_digest = "abc"});
  }
  void end(std::int64_t run) {
    store_.finish_run(run, {.outcome = RunOutcome::kComplete,
                            .verdict = Verdict::kAccepted,
                            .ended_at = "2026-01-02T00:01:00.000Z",
                            .result_json = R"({"a":1})",
                            .arm_json = R"({"b":2})"});
  }
  /// Run 1, ended with two touches: three facts.
  void run_that_ended() {
    begin();
    for (const int number : {1, 2}) store_.append_touch(1, touch_of_number(number));
    end(1);
  }
  [[nodiscard]] std::vector<Fact> facts(std::int64_t after = 0) const {
    return OutboxReader(file_).next(after, kAll);
  }
  [[nodiscard]] std::vector<std::string> kinds(std::int64_t after = 0) const {
    std::vector<std::string> kinds;
    for (const Fact& fact : facts(after)) kinds.push_back(fact.kind);
    return kinds;
  }
  static nlohmann::json body(const Fact& fact) { return nlohmann::json::parse(fact.body); }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  Outbox outbox_{store_.database()};
};

TEST_F(OutboxTest, ARunTellsOfItsStartItsTouchesAndItsEnd) {
  EXPECT_EQ(outbox_.begin_instance(), 1);
  EXPECT_EQ(outbox_.begin_instance(), 2);
  run_that_ended();
  const std::vector<Fact> told = facts();
  ASSERT_THAT(kinds(), ElementsAre("run_started", "touch_set_closed", "run_ended"));
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].seq, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(told[i].instance, 2);
    EXPECT_EQ(told[i].run_id, 1);
    EXPECT_EQ(told[i].previous, i == 0 ? std::string() : told[i - 1].sha256);
    EXPECT_EQ(told[i].sha256, fact_digest(told[i]));
  }
  EXPECT_EQ(told[0].at, "2026-01-02T00:00:00.000Z");
  EXPECT_EQ(body(told[0]), (nlohmann::json{{"recipe", "edf-25"},
                                           {"operator", "M. Curie"},
                                           {"config_digest", "abc"},
                                           {"kind", "calibration"},
                                           {"of_run", nullptr},
                                           {"touching", nullptr}}));
  const auto set = body(told[1]);
  EXPECT_EQ(set["touches"], 2);
  EXPECT_EQ(set["result_sha256"], sha256_hex(R"({"a":1})"));
  EXPECT_EQ(set["arm_sha256"], sha256_hex(R"({"b":2})"));
  EXPECT_EQ(told[2].at, "2026-01-02T00:01:00.000Z");
  EXPECT_EQ(body(told[2])["outcome"], "complete");
  EXPECT_EQ(body(told[2])["verdict"], "accepted");
  EXPECT_EQ(body(told[2])["touches_done"], 2);
  EXPECT_TRUE(body(told[2])["fault_code"].is_null());
}

TEST_F(OutboxTest, AProofAndACheckThatCameToTheirEndTellWhatTheyFound) {
  const auto verified = [&](RunKind kind, RunOutcome outcome, const std::string& result) {
    const std::int64_t run =
        store_.begin_run({.kind = kind, .of_run = 7, .recipe = "edf-25", .started_at = "2026-01-02"});
    store_.finish_run(
        run,
        {.outcome = outcome, .verdict = Verdict::kRejected, .ended_at = "2026-01-03", .result_json = result});
  };
  verified(RunKind::kProof, RunOutcome::kComplete, R"({"arm":"tx90","rms_mm":0.041,"power":[]})");
  ASSERT_THAT(kinds(), ElementsAre("run_started", "run_ended", "proof"));
  EXPECT_EQ(body(facts()[1])["kind"], "proof");
  EXPECT_EQ(body(facts()[2]),
            (nlohmann::json{{"of_run", 7}, {"arm", "tx90"}, {"verdict", "rejected"}, {"rms_mm", 0.041}}));
  EXPECT_EQ(facts()[2].at, "2026-01-03");
  verified(RunKind::kCheck, RunOutcome::kComplete,
           R"({"rms_mm":null,"cause":"joint","joint":3,"growth_ppm":-4.5,"every_days":7})");
  EXPECT_EQ(facts().back().kind, "check");
  EXPECT_EQ(body(facts().back()), (nlohmann::json{{"of_run", 7},
                                                  {"arm", nullptr},
                                                  {"verdict", "rejected"},
                                                  {"rms_mm", nullptr},
                                                  {"cause", "joint"},
                                                  {"joint", 3},
                                                  {"growth_ppm", -4.5},
                                                  {"every_days", 7}}));
  verified(RunKind::kCheck, RunOutcome::kStopped, "{}");
  EXPECT_EQ(facts().back().kind, "run_ended") << "it found nothing";
}

TEST_F(OutboxTest, WhatChangesTheTouchesOfARunThatEndedClosesTheirSetAgain) {
  run_that_ended();
  std::string before = body(facts()[1])["touches_sha256"];
  const auto expect_another_set = [&](const char* what) {
    const Fact told = facts().back();
    EXPECT_EQ(told.kind, "touch_set_closed") << what;
    EXPECT_NE(body(told)["touches_sha256"], before) << what;
    before = body(told)["touches_sha256"];
  };
  store_.append_touch(1, touch_of_number(3));
  expect_another_set("a late touch");
  StoredTouch again = touch_of_number(2);
  again.sequence = 9;
  store_.replace_touch(1, again, "outlier");
  expect_another_set("a touch in place of another");
  store_.confirm_touch(1, 1, {7, 7, 7, 7, 7, 7});
  expect_another_set("a repetition");
  store_.withdraw_touch(1, 3, "by hand");
  expect_another_set("one that counts no longer");
  store_.set_result_json(1, R"({"a":2})");
  EXPECT_EQ(body(facts().back())["touches_sha256"], before);
  EXPECT_EQ(body(facts().back())["result_sha256"], sha256_hex(R"({"a":2})"));
  EXPECT_TRUE(body(facts().back())["arm_sha256"].is_null());
}

TEST_F(OutboxTest, ATouchOfARunUnderWayIsNoFact) {
  begin();
  store_.append_touch(1, touch_of_number(1));
  store_.set_result_json(1, "{}");
  EXPECT_THAT(kinds(), ElementsAre("run_started"));
}

TEST_F(OutboxTest, ARunThatIsWithdrawnOrInterruptedEndsForThoseWhoHeardOfItsStart) {
  begin();
  store_.withdraw_run(1);
  begin();
  store_.finish_interrupted("2026-01-03T00:00:00.000Z");
  const std::vector<Fact> told = facts();
  ASSERT_THAT(kinds(), ElementsAre("run_started", "run_ended", "run_started", "run_ended"));
  EXPECT_EQ(body(told[1])["outcome"], "withdrawn");
  EXPECT_EQ(told[1].run_id, 1);
  EXPECT_EQ(body(told[3])["outcome"], "interrupted");
  EXPECT_EQ(told[3].run_id, 2);
  EXPECT_EQ(told[3].at, "2026-01-03T00:00:00.000Z");
}

TEST_F(OutboxTest, ApprovalsAndRollbacksTellWhichModelIsTheCellsNow) {
  run_that_ended();
  begin();
  ModelStore models(store_.database());
  const auto approve = [&](std::int64_t run, const char* hash) {
    models.approve(
        {.run_id = run,
         .at = "then",
         .operator_name = "M. Curie",
         .hash = hash,
         .document =
             run == 2
                 ? R"({"arm":"tx90","arm_serial":"N1","tip_uncertainty":{"expanded":{"box_max_mm":0.25}}})"
                 : "{}",
         .arm_json = "{}",
         .check_every = std::chrono::days(7)});
  };
  approve(1, "one");
  approve(2, "two");
  approve(2, "two");  // it is the cell's already
  models.roll_back("later", std::nullopt);
  const std::vector<Fact> told = facts(4);
  ASSERT_THAT(kinds(4), ElementsAre("approved", "approved", "rolled_back"));
  EXPECT_EQ(body(told[1]), (nlohmann::json{{"hash", "two"},
                                           {"operator", "M. Curie"},
                                           {"valid_until", nullptr},
                                           {"tip_box_max_mm", 0.25},
                                           {"arm", "tx90"},
                                           {"arm_serial", "N1"},
                                           {"every_days", 7},
                                           {"current", "two"}}));
  EXPECT_EQ(told[2].at, "later");
  EXPECT_EQ(told[2].run_id, 2);
  EXPECT_EQ(body(told[2])["hash"], "two");
  EXPECT_FALSE(body(told[2]).contains("every_days")) << "nobody asked the cell's file";
  EXPECT_EQ(body(told[2])["current"], "one");
  EXPECT_TRUE(body(told[2])["tip_box_max_mm"].is_null()) << "the one before never told it";
}

TEST_F(OutboxTest, WhatUsesAModelIsTold) {
  run_that_ended();
  ModelStore models(store_.database());
  models.approve({.run_id = 1, .at = "then", .hash = "one", .document = "{}", .arm_json = "{}"});
  models.note_applied(
      {.run_id = 1, .hash = "one", .to = "pick.dtx", .at = "later", .operator_name = "M. Curie"});
  const Fact told = facts().back();
  EXPECT_EQ(told.kind, "applied");
  EXPECT_EQ(told.at, "later");
  EXPECT_EQ(told.run_id, 1);
  EXPECT_EQ(body(told), (nlohmann::json{{"hash", "one"}, {"operator", "M. Curie"}, {"to", "pick.dtx"}}));
}

TEST_F(OutboxTest, ARunTellsTheTypeOfItsArmWhereItHasAResult) {
  begin();
  store_.finish_run(
      1, {.outcome = RunOutcome::kComplete, .ended_at = "end", .result_json = R"({"arm":"tx90"})"});
  EXPECT_EQ(body(facts().back())["arm"], "tx90");
  begin();
  store_.finish_run(2, {.outcome = RunOutcome::kStopped, .ended_at = "end"});
  EXPECT_TRUE(body(facts().back())["arm"].is_null());
}

TEST_F(OutboxTest, FaultsAreToldAlsoOfNoRun) {
  FaultLog faults(store_.database());
  faults.append(std::nullopt, "then", "link_lost", "the link is lost");
  begin();
  faults.append(1, "later", "no_contact", "\xff");
  const std::vector<Fact> told = facts();
  ASSERT_THAT(kinds(), ElementsAre("fault", "run_started", "fault"));
  EXPECT_EQ(told[0].run_id, std::nullopt);
  EXPECT_EQ(body(told[0]), (nlohmann::json{{"code", "link_lost"}, {"message", "the link is lost"}}));
  EXPECT_EQ(told[2].run_id, 1);
  EXPECT_EQ(body(told[2])["message"], "\xef\xbf\xbd") << "bytes that are no text";
}

TEST_F(OutboxTest, ACertificateIsToldOfOnceUntilAnotherTakesItsPlace) {
  for (const char* until : {"2026-02-01", "2026-02-01", "2027-02-01"})
    outbox_.tell_expiring({{"probe", "2026-02-01"}, {"block", until}}, "now");
  ASSERT_THAT(facts(), SizeIs(3));
  EXPECT_EQ(body(facts()[0]), (nlohmann::json{{"artefact", "probe"}, {"valid_until", "2026-02-01"}}));
  EXPECT_EQ(body(facts()[1]), (nlohmann::json{{"artefact", "block"}, {"valid_until", "2026-02-01"}}));
  EXPECT_EQ(body(facts()[2]), (nlohmann::json{{"artefact", "block"}, {"valid_until", "2027-02-01"}}));
}

TEST_F(OutboxTest, ACertificateThatAClockFarAheadToldOfIsToldOfInItsTimeToo) {
  outbox_.tell_expiring({{"block", "2027-02-01"}}, "2031-05-01T00:00:00.000Z");
  outbox_.tell_expiring({}, "2026-05-01T00:00:00.000Z");  // the clock was set right
  outbox_.tell_expiring({{"block", "2027-02-01"}}, "2027-01-05T00:00:00.000Z");
  ASSERT_THAT(kinds(), ElementsAre("certificate_expiring", "certificate_renewed", "certificate_expiring"));
  EXPECT_EQ(body(facts()[1]), (nlohmann::json{{"artefact", "block"}, {"valid_until", "2027-02-01"}}));
  EXPECT_EQ(facts()[2].at, "2027-01-05T00:00:00.000Z");
}

TEST_F(OutboxTest, TheCursorOfASinkOnlyRises) {
  const OutboxReader reader(file_);
  EXPECT_EQ(reader.cursor("mqtt"), 0);
  run_that_ended();
  outbox_.confirm("mqtt", 2);
  outbox_.confirm("mqtt", 1);
  outbox_.confirm("archive", 1);
  EXPECT_EQ(reader.cursor("mqtt"), 2);
  EXPECT_EQ(reader.cursor("archive"), 1);
  EXPECT_EQ(reader.backlog(1), (Backlog{.count = 2, .oldest_at = "2026-01-02T00:01:00.000Z"}));
  EXPECT_EQ(reader.backlog(3), Backlog{});
  EXPECT_THAT(reader.next(1, 1), SizeIs(1));
}

TEST_F(OutboxTest, FactsGoWhenAllSinksHaveThemAndTheirTimeIsOver) {
  run_that_ended();  // two facts of the first minute, one of the second
  const FactsKept later{.oldest = "2026-01-03T00:00:00.000Z", .now = "2026-01-04T00:00:00.000Z"};
  const FactsKept between{.oldest = "2026-01-02T00:00:30.000Z", .now = later.now};
  EXPECT_EQ(delete_facts(store_.database(), {"mqtt"}, later), 0) << "the sink has none of them";
  outbox_.confirm("mqtt", 3);
  EXPECT_EQ(delete_facts(store_.database(), {"mqtt", "archive"}, later), 0) << "the other sink has none";
  outbox_.confirm("archive", 1);
  EXPECT_EQ(delete_facts(store_.database(), {"mqtt", "archive"}, {}), 0) << "facts are kept for ever";
  EXPECT_EQ(delete_facts(store_.database(), {"mqtt", "archive"}, later), 1);
  EXPECT_EQ(delete_facts(store_.database(), {"mqtt"}, between), 0)
      << "the touches closed in the second minute";
  EXPECT_THAT(find_damage(file_), IsEmpty());
  EXPECT_EQ(delete_facts(store_.database(), {"mqtt"}, later, kFactsKeptWithoutSink, 1), 1) << "one at once";
  EXPECT_EQ(delete_facts(store_.database(), {"mqtt"}, later), 1);
  EXPECT_THAT(find_damage(file_), IsEmpty());
  begin();
  ASSERT_THAT(facts(), SizeIs(1));
  EXPECT_EQ(facts()[0].seq, 4) << "a number comes once, whatever was deleted";
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

/// What a year's keeping deletes by this clock, of runs that began on these days, a fact each.
TEST_F(OutboxTest, AClockThatStandsWrongDeletesNoFactThatIsYoung) {
  const auto begin_on = [&](const char* day) {
    store_.begin_run({.recipe = "edf-25", .started_at = std::string(day) + "T00:00:00.000Z"});
  };
  const auto deleted_by = [&](int year, int days_that_agree = kDaysThatAgree) {
    const std::string behind = "-06-01T00:00:00.000Z";
    return delete_facts(store_.database(), {"mqtt"},
                        FactsKept{.oldest = std::to_string(year - 1) + behind,
                                  .now = std::to_string(year) + behind,
                                  .days_that_agree = days_that_agree});
  };
  outbox_.confirm("mqtt", 1000);
  for (const char* day : {"2026-03-01", "2026-03-02", "2026-03-03"}) begin_on(day);
  EXPECT_EQ(deleted_by(2031), 0) << "five years ahead";
  for (const char* day : {"2031-05-30", "2031-05-31", "2031-05-31"}) begin_on(day);
  EXPECT_EQ(deleted_by(2031), 0) << "on the second day that it stands ahead";
  begin_on("1970-01-01");
  for (const char* day : {"2026-03-04", "2026-03-05"}) begin_on(day);
  EXPECT_EQ(deleted_by(1970), 0) << "set back";
  EXPECT_EQ(deleted_by(2026), 0) << "set right: the oldest is of this year";
  EXPECT_EQ(deleted_by(2027), 0) << "no fact was written since: it may be a clock";
  for (const char* day : {"2027-04-01", "2027-04-02", "2027-04-03"}) begin_on(day);
  EXPECT_EQ(deleted_by(2027), 9) << "a year later: what the wrong clock wrote does not stay until 2031";
  EXPECT_EQ(facts().front().at, "2027-04-01T00:00:00.000Z");
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

TEST_F(OutboxTest, WithoutASinkTheLastFactsStay) {
  run_that_ended();
  EXPECT_EQ(delete_facts(store_.database(), {}, {}), 0);
  EXPECT_EQ(delete_facts(store_.database(), {}, {}, 2), 1);
  EXPECT_THAT(kinds(), ElementsAre("touch_set_closed", "run_ended"));
  EXPECT_EQ(OutboxReader(file_).backlog(0).count, 2) << "what is gone waits for nobody";
  EXPECT_EQ(delete_facts(store_.database(), {"mqtt"}, {}, 1), 0) << "there is a sink";
}

TEST_F(OutboxTest, ARunStaysUntilAllSinksHaveHeardOfIt) {
  for (int run = 1; run <= kLastRunsKept + 2; ++run) {
    begin();
    store_.finish_run(
        run, {.outcome = RunOutcome::kComplete, .verdict = Verdict::kRejected, .ended_at = "2026-01-02"});
  }
  const auto old_runs_deleted = [&] {
    return delete_runs_before(store_.database(), "2026-02", 0, {"archive"});
  };
  outbox_.confirm("archive", 2);  // start and end of the first
  EXPECT_EQ(old_runs_deleted(), 1);
  outbox_.confirm("archive", 1000);
  EXPECT_EQ(old_runs_deleted(), 1);
}

TEST_F(OutboxTest, WhatWasChangedOrTakenOutIsSeenAndNotTold) {
  for (const char* tampering :
       {"UPDATE outbox SET body = '{}' WHERE seq = 2", "DELETE FROM outbox WHERE seq = 2",
        "UPDATE outbox SET run_id = NULL WHERE seq = 2", "UPDATE outbox SET seq = 7 WHERE seq = 3"}) {
    const Folder folder;
    const auto file = folder.path() / "touchcal.sqlite";
    RunStore store(file);
    for (int run = 0; run < 3; ++run) store.begin_run({.recipe = "edf-25", .started_at = "start"});
    EXPECT_EQ(store.database()->exec(tampering), 1);
    EXPECT_THROW(static_cast<void>(OutboxReader(file).next(0, kAll)), DamagedStore) << tampering;
    EXPECT_THAT(find_damage(file), ElementsAre(HasSubstr("outbox, row"))) << tampering;
  }
}

TEST_F(OutboxTest, FactsThatWereTakenOutAtTheEndAreMissed) {
  run_that_ended();
  EXPECT_EQ(store_.database()->exec("DELETE FROM outbox WHERE seq = 3"), 1);
  EXPECT_THAT(find_damage(file_), ElementsAre(HasSubstr("outbox, row 2: rows behind it were taken out")));
}

}  // namespace
}  // namespace cell
