#include "service/store/run_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <cstdint>
#include <limits>

#include "service/store/maintenance.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/same_touch.hpp"

namespace cell {

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kHighest = std::numeric_limits<std::int32_t>::max();

StoredTouch touch(int number) {
  return {.number = number,
          .plane = 1 + number % 4,
          .joints = {number, -2, 3, -4, 5, -6},
          .captured_at = "2026-01-31T08:15:30.250Z"};
}

class RunStoreTest : public ::testing::Test {
 protected:
  std::int64_t begin(std::optional<std::string> key = std::nullopt) {
    return store_->begin_run(
        {.recipe = "edf-25", .touches_total = 140, .started_at = "start", .idempotency_key = std::move(key)});
  }
  void finish(std::int64_t run, Verdict verdict) {
    store_->finish_run(run, {.outcome = RunOutcome::kComplete, .verdict = verdict, .ended_at = "end"});
  }
  void reopen() {
    store_.reset();
    store_.emplace(file_);
  }
  std::vector<std::int64_t> ids(int limit, std::optional<std::int64_t> before = {}) const {
    std::vector<std::int64_t> found;
    for (const StoredRun& run : store_->runs(limit, before)) found.push_back(run.id);
    return found;
  }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  std::optional<RunStore> store_{std::in_place, file_};
};

TEST_F(RunStoreTest, ChecksOfACalibrationAreFoundAndAreNoAcceptedCalibration) {
  const std::int64_t calibration = begin(), other = begin();
  finish(calibration, Verdict::kAccepted);
  const auto begin_of = [&](RunKind kind, std::int64_t of_run) {
    return store_->begin_run({.kind = kind, .of_run = of_run, .recipe = "best", .started_at = "start"});
  };
  const std::int64_t first = begin_of(RunKind::kCheck, calibration),
                     proof = begin_of(RunKind::kProof, calibration),
                     of_other = begin_of(RunKind::kCheck, other),
                     second = begin_of(RunKind::kCheck, calibration),
                     stopped = begin_of(RunKind::kCheck, calibration);
  for (const std::int64_t run : {first, proof, of_other, second}) finish(run, Verdict::kAccepted);
  store_->finish_run(stopped, {.outcome = RunOutcome::kStopped, .ended_at = "end"});
  EXPECT_EQ(store_->last_accepted()->id, calibration);
  std::vector<std::int64_t> found;
  for (const StoredRun& run : store_->complete_runs_of(calibration, RunKind::kCheck)) found.push_back(run.id);
  EXPECT_THAT(found, ElementsAre(first, second));
  EXPECT_EQ(store_->run(proof)->kind, RunKind::kProof);
  EXPECT_EQ(store_->run(proof)->of_run, calibration);
}

/// The older of two was imported behind the newer one.
TEST_F(RunStoreTest, RunsOfACalibrationAreInTheOrderOfTheirEnds) {
  const std::int64_t calibration = begin();
  finish(calibration, Verdict::kAccepted);
  const auto ended_at = [&](const std::string& time) {
    const std::int64_t run = store_->begin_run(
        {.kind = RunKind::kCheck, .of_run = calibration, .recipe = "best", .started_at = "start"});
    store_->finish_run(run, {.verdict = Verdict::kAccepted, .ended_at = time});
    return run;
  };
  const std::int64_t newest = ended_at("2026-05-03T00:00:00.000Z"),
                     oldest = ended_at("2026-05-01T00:00:00.000Z"),
                     between = ended_at("2026-05-02T00:00:00.000Z"),
                     at_once = ended_at("2026-05-02T00:00:00.000Z");
  std::vector<std::int64_t> found;
  for (const StoredRun& run : store_->complete_runs_of(calibration, RunKind::kCheck)) found.push_back(run.id);
  EXPECT_THAT(found, ElementsAre(oldest, between, at_once, newest));
}

TEST_F(RunStoreTest, TouchesComeBackExactlyAndInTheirOrder) {
  const std::int64_t run = begin();
  const StoredTouch extreme{.number = 2,
                            .plane = 5,
                            .role = calib::TouchRole::kProof,
                            .joints = {kLowest, kHighest, 0, -1, 1, 123456789},
                            .source = cs8::CaptureSource::kPolled,
                            .overtravel_dmm = -7,
                            .captured_at = "2026-01-31T08:15:30.250Z",
                            .noise_um = 61.1};
  store_->append_touch(run, extreme);
  store_->append_touch(run, touch(1));
  EXPECT_THAT(store_->touches(run), ElementsAre(touch(1), extreme));
  EXPECT_THAT(store_->touches(run + 1), IsEmpty());
}

/// Who had no memory left between the disk and the acknowledgement could never store the answer that the
/// controller still had, and no reset led out of that.
TEST_F(RunStoreTest, AnAnswerThatIsStoredAlreadyIsThereOnce) {
  for (const bool has_ended : {false, true}) {
    const std::int64_t run = begin();
    StoredTouch answer = touch(1);
    answer.session = 7;
    answer.sequence = 3;
    store_->append_touch(run, answer);
    if (has_ended) store_->finish_run(run, {.outcome = RunOutcome::kAborted, .ended_at = "t"});
    StoredTouch late = answer;
    late.captured_at = "2026-01-31T08:15:31.250Z";
    EXPECT_NO_THROW(store_->append_touch(run, late));
    EXPECT_THAT(store_->touches(run), ElementsAre(answer)) << "as it was first";
    late.sequence = 4;
    EXPECT_THROW(store_->append_touch(run, late), std::exception) << "the answer to another command";
  }
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

TEST_F(RunStoreTest, ATouchKeepsItsNoiseWhenAnotherTakesItsPlace) {
  const std::int64_t run = begin();
  StoredTouch first = touch(1), again = touch(1);
  first.noise_um = 28.4;
  again.noise_um = 20.1;
  store_->append_touch(run, first);
  store_->replace_touch(run, again, "it contradicted the others");
  EXPECT_THAT(store_->touches(run), ElementsAre(again));
  EXPECT_EQ(store_->superseded_touches(run).at(0).touch, first);
}

TEST_F(RunStoreTest, ATouchKeepsItsFirstContactAndARepetitionThatAgreedWithIt) {
  const std::int64_t run = begin();
  StoredTouch made = touch(1);
  made.first = FirstContact{.source = cs8::CaptureSource::kPolled, .joints = {kLowest, 2, 3, 4, 5, kHighest}};
  store_->append_touch(run, made);
  store_->append_touch(run, touch(2));
  reopen();
  EXPECT_THAT(store_->touches(run), ElementsAre(made, touch(2)));
  made.again = cs8::JointsMicrodeg{0, 0, 0, 0, 0, -1};
  store_->confirm_touch(run, 1, *made.again);
  reopen();
  EXPECT_THAT(store_->touches(run), ElementsAre(made, touch(2)));
  EXPECT_THROW(store_->confirm_touch(run, 3, *made.again), std::exception);
}

TEST_F(RunStoreTest, ARepetitionGoesWithTheTouchThatItAgreedWith) {
  const std::int64_t run = begin();
  StoredTouch confirmed = touch(1);
  confirmed.again = cs8::JointsMicrodeg{1, 2, 3, 4, 5, 6};
  store_->append_touch(run, touch(1));
  store_->confirm_touch(run, 1, *confirmed.again);
  store_->replace_touch(run, touch(1), "it contradicts the others after all");
  EXPECT_THAT(store_->touches(run), ElementsAre(touch(1)));
  EXPECT_EQ(store_->superseded_touches(run).at(0).touch, confirmed);
}

TEST_F(RunStoreTest, AStoredTouchIsThereForAnotherConnectionAtOnce) {
  const std::int64_t run = begin();
  const RunStore other(file_);
  store_->append_touch(run, touch(1));
  EXPECT_EQ(other.touches(run).size(), 1u);
}

TEST_F(RunStoreTest, ATouchNumberIsTakenOnceAndOnlyForARunThatExists) {
  const std::int64_t run = begin();
  store_->append_touch(run, touch(1));
  StoredTouch second = touch(1);
  second.plane = 3;
  EXPECT_THROW(store_->append_touch(run, second), std::exception);
  EXPECT_THROW(store_->append_touch(run + 1, touch(1)), std::exception);
  EXPECT_THAT(store_->touches(run), ElementsAre(touch(1)));
  EXPECT_NO_THROW(store_->append_touch(begin(), touch(1)));
}

TEST_F(RunStoreTest, ARunIsRunningUntilItsEndIsStored) {
  const std::int64_t id = begin();
  store_->append_touch(id, touch(1));
  store_->set_plan(id, 139, "plan", "{}");
  const StoredRun running = store_->run(id).value();
  EXPECT_EQ(running.recipe, "edf-25");
  EXPECT_EQ(running.touches_total, 139);
  EXPECT_EQ(running.touches_done, 1);
  EXPECT_EQ(running.started_at, "start");
  EXPECT_EQ(running.outcome, RunOutcome::kRunning);
  EXPECT_EQ(running.verdict, Verdict::kNone);
  EXPECT_FALSE(running.ended_at || running.fault_code || running.fault_message);
  EXPECT_FALSE(store_->result_json(id));

  store_->finish_run(id, {.outcome = RunOutcome::kAborted,
                          .verdict = Verdict::kIncomplete,
                          .ended_at = "end",
                          .fault_code = "link_lost",
                          .fault_message = "reset by peer",
                          .result_json = "{\"a\":1}"});
  const StoredRun ended = store_->run(id).value();
  EXPECT_EQ(ended.outcome, RunOutcome::kAborted);
  EXPECT_EQ(ended.verdict, Verdict::kIncomplete);
  EXPECT_EQ(ended.ended_at, "end");
  EXPECT_EQ(ended.fault_code, "link_lost");
  EXPECT_EQ(ended.fault_message, "reset by peer");
  EXPECT_EQ(store_->result_json(id), "{\"a\":1}");
}

TEST_F(RunStoreTest, PagesGoFromTheNewestRunBack) {
  std::vector<std::int64_t> all;
  for (int i = 0; i < 5; ++i) all.insert(all.begin(), begin());
  EXPECT_EQ(ids(10), all);
  EXPECT_THAT(ids(2), ElementsAre(all[0], all[1]));
  EXPECT_THAT(ids(2, all[1]), ElementsAre(all[2], all[3]));
  EXPECT_THAT(ids(2, all[3]), ElementsAre(all[4]));
  EXPECT_THAT(ids(2, all[4]), IsEmpty());
}

TEST_F(RunStoreTest, AnIdempotencyKeyBelongsToOneRun) {
  const std::int64_t first = begin("key");
  EXPECT_THROW(begin("key"), std::exception);
  EXPECT_THAT(ids(10), ElementsAre(first));
  EXPECT_EQ(store_->run_with_key("key")->id, first);
  EXPECT_FALSE(store_->run_with_key("other"));
  begin();
  EXPECT_NO_THROW(begin()) << "runs without a key do not share one";
}

TEST_F(RunStoreTest, RunsLeftOpenAreEndedAsInterruptedAndNoOthers) {
  const std::int64_t ended = begin();
  finish(ended, Verdict::kAccepted);
  const std::int64_t open = begin();
  store_->append_touch(open, touch(1));
  reopen();
  EXPECT_EQ(store_->finish_interrupted("now"), 1);
  EXPECT_EQ(store_->run(open)->outcome, RunOutcome::kInterrupted);
  EXPECT_EQ(store_->run(open)->verdict, Verdict::kIncomplete);
  EXPECT_EQ(store_->run(open)->ended_at, "now");
  EXPECT_EQ(store_->run(open)->touches_done, 1);
  EXPECT_EQ(store_->run(ended)->outcome, RunOutcome::kComplete);
  EXPECT_EQ(store_->run(ended)->ended_at, "end");
  EXPECT_EQ(store_->finish_interrupted("later"), 0);
}

TEST_F(RunStoreTest, TheLastAcceptedRunIsNotTheLastRun) {
  EXPECT_FALSE(store_->last_accepted());
  finish(begin(), Verdict::kAccepted);
  const std::int64_t newer = begin();
  finish(newer, Verdict::kAccepted);
  finish(begin(), Verdict::kRejected);
  begin();
  EXPECT_EQ(store_->last_accepted()->id, newer);
}

TEST_F(RunStoreTest, ReopeningKeepsAllAndNumbersGoOn) {
  const std::int64_t run = begin("key");
  store_->append_touch(run, touch(1));
  store_->append_touch(run, touch(2));
  finish(run, Verdict::kRejected);
  reopen();
  EXPECT_THAT(store_->touches(run), ElementsAre(touch(1), touch(2)));
  EXPECT_EQ(store_->run_with_key("key")->verdict, Verdict::kRejected);
  EXPECT_GT(begin(), run);
}

TEST_F(RunStoreTest, RunsThatFollowOnePlanKeepItOnce) {
  const std::string kPlan = R"({"touches":[]})";
  const std::int64_t first = begin(), second = begin(), unplanned = begin();
  store_->set_plan(first, 3, "id", kPlan);
  store_->set_plan(second, 3, "id", kPlan);
  EXPECT_EQ(store_->plan_json(first), kPlan);
  EXPECT_EQ(store_->plan_json(second), kPlan);
  EXPECT_EQ(store_->plan_json(unplanned), std::nullopt);
  store_->set_plan(unplanned, 3, "id", kPlan, {{PlanChange::Kind::kBlockToMove, 0}});
  EXPECT_THAT(store_->plan_changes(unplanned), ElementsAre(PlanChange{PlanChange::Kind::kBlockToMove, 0}));
  EXPECT_TRUE(store_->plan_changes(first).empty());
  EXPECT_EQ(SQLite::Database(file_.string()).execAndGet("SELECT count(*) FROM plans").getInt(), 1);
}

TEST_F(RunStoreTest, ARunTellsWhoStartedItAndWithWhat) {
  const StoredTemperature measured{.celsius = 21.5, .std_k = 0.5, .measured_at = "then", .source = "run"};
  const std::int64_t id = store_->begin_run({.recipe = "edf-25",
                                             .started_at = "start",
                                             .operator_name = "Ada",
                                             .block_temperature = measured,
                                             .stiffness = "off",
                                             .config_digest = "abc",
                                             .conditions_json = "{}"});
  const StoredRun run = store_->run(id).value();
  EXPECT_EQ(run.operator_name, "Ada");
  EXPECT_EQ(run.block_temperature, measured);
  EXPECT_EQ(run.stiffness, "off");
  EXPECT_EQ(run.config_digest, "abc");
  EXPECT_EQ(run.conditions_json, "{}");
  const StoredRun other = store_->run(begin()).value();
  EXPECT_FALSE(run.plan_id || other.operator_name || other.block_temperature || other.stiffness);
}

TEST_F(RunStoreTest, ATouchMadeAgainTakesThePlaceOfTheFirstWhichIsKept) {
  const std::int64_t run = begin();
  store_->append_touch(run, touch(1));
  store_->append_touch(run, touch(2));
  StoredTouch again = touch(1);
  again.joints[0] = 99;
  store_->replace_touch(run, again, "does not fit");
  EXPECT_THAT(store_->touches(run), ElementsAre(again, touch(2)));
  const auto superseded = store_->superseded_touches(run);
  ASSERT_EQ(superseded.size(), 1u);
  EXPECT_EQ(superseded[0].touch, touch(1));
  EXPECT_EQ(superseded[0].reason, "does not fit");
  EXPECT_THROW(store_->replace_touch(run, touch(3), "never made"), std::exception);
  EXPECT_THAT(store_->touches(run), ElementsAre(again, touch(2)));
}

TEST_F(RunStoreTest, ATouchIsReplacedOnceByTheSameRepetition) {
  const std::int64_t run = begin();
  store_->append_touch(run, touch(1));
  StoredTouch again = touch(1);
  again.joints[0] = 99;
  again.sequence = 0;  // a repetition answers no command of the plan
  store_->replace_touch(run, again, "does not fit");
  store_->replace_touch(run, again, "does not fit");
  EXPECT_THAT(store_->touches(run), ElementsAre(again));
  EXPECT_EQ(store_->superseded_touches(run).size(), 1u);
  again.captured_at = "2026-01-31T09:00:00.000Z";
  store_->replace_touch(run, again, "another repetition");
  EXPECT_EQ(store_->superseded_touches(run).size(), 2u);
}

TEST_F(RunStoreTest, ReferencesAndPlanChangesComeBackInTheirOrder) {
  const std::int64_t run = begin();
  store_->append_reference(run, {.number = 1, .joints = {1, 2, 3, 4, 5, 6}, .captured_at = "t"});
  store_->append_reference(run, {.number = 2, .touches_done = 10, .drift_mm = 0.012, .captured_at = "u"});
  const auto references = store_->references(run);
  ASSERT_EQ(references.size(), 2u);
  EXPECT_EQ(references[0].joints[5], 6);
  EXPECT_FALSE(references[0].drift_mm);
  EXPECT_EQ(references[1].touches_done, 10);
  EXPECT_EQ(references[1].drift_mm, 0.012);
  using Kind = PlanChange::Kind;
  for (const PlanChange change : {PlanChange{Kind::kDefer, 3}, {Kind::kDropFitTouches, 1}, {Kind::kSkip, 2}})
    store_->append_plan_change(run, change);
  const auto changes = store_->plan_changes(run);
  ASSERT_EQ(changes.size(), 3u);
  EXPECT_TRUE(changes[0].kind == Kind::kDefer && changes[0].place == 3);
  EXPECT_TRUE(changes[1].kind == Kind::kDropFitTouches && changes[2].kind == Kind::kSkip);
}

TEST_F(RunStoreTest, AReferenceThatIsStoredAlreadyIsThereOnce) {
  const std::int64_t run = begin();
  ReferenceTouch made{.number = 1, .joints = {1, 2, 3, 4, 5, 6}, .captured_at = "t"};
  store_->append_reference(run, made);
  EXPECT_NO_THROW(store_->append_reference(run, made));
  EXPECT_EQ(store_->references(run).size(), 1u);
  made.joints[5] = 7;
  EXPECT_THROW(store_->append_reference(run, made), std::exception) << "another contact";
  made = {.number = 1, .joints = {1, 2, 3, 4, 5, 6}, .captured_at = "u"};
  EXPECT_THROW(store_->append_reference(run, made), std::exception) << "the same joints at another time";
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

TEST_F(RunStoreTest, TheRunningOneIsTheNewestThatHasNotEndedAndMayBeKept) {
  EXPECT_FALSE(store_->running());
  const std::int64_t older = begin(), newer = begin();
  finish(begin(), Verdict::kRejected);
  EXPECT_EQ(store_->running()->id, newer);
  EXPECT_EQ(store_->finish_interrupted("now", newer), 1);
  EXPECT_EQ(store_->run(older)->outcome, RunOutcome::kInterrupted);
  EXPECT_EQ(store_->running()->id, newer);
}

}  // namespace
}  // namespace cell
