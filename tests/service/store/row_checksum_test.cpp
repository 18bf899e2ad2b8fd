// Damage of the file, in its rows and in its pages: what is told is what was written, or a refusal.
#include "service/store/internal/row_checksum.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <map>
#include <random>

#include "service/store/answer_store.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kConditions = R"({"touching":"automatic"})";

/// A run that has rows in every table; it ended, unless it is the last one.
void add_run(RunStore& store, const std::string& name, bool ended) {
  const std::int64_t run = store.begin_run({.recipe = "edf-25",
                                            .started_at = name,
                                            .idempotency_key = name,
                                            .operator_name = "A. Turing",
                                            .block_temperature = StoredTemperature{.celsius = 21.0},
                                            .config_digest = "digest",
                                            .conditions_json = kConditions});
  store.set_plan(run, 4, "plan", R"({"touches":[1,2,3,4]})");
  store.append_reference(
      run,
      {.number = 1, .touches_done = 0, .joints = {6, 5, 4, 3, 2, 1}, .drift_mm = 1.0, .captured_at = "t"});
  for (int number = 1; number <= 4; ++number) {
    const auto sequence = static_cast<std::uint32_t>(number);
    if (number == 3) store.append_plan_change(run, {PlanChange::Kind::kDefer, 2});
    store.set_open_command(run, {.session = 1, .sequence = sequence, .touch_json = R"({"face":2})"});
    if (number == 4 && !ended) return;
    store.append_touch(run, {.number = number,
                             .plane = 1 + number,
                             .joints = {number, -2'000'000, 3, -4, 50'000'000, -6},
                             .captured_at = "2026-01-31T08:15:30.250Z",
                             .session = 1,
                             .sequence = sequence});
  }
  store.replace_touch(run, {.number = 4, .plane = 5, .captured_at = "t", .sequence = 9}, "outlier");
  store.finish_run(run, {.outcome = RunOutcome::kComplete,
                         .verdict = Verdict::kAccepted,
                         .ended_at = "end",
                         .result_json = R"({"parameters":[1.25,2.5]})",
                         .arm_json = R"({"schema":"touchcal/arm/2"})"});
}

class DamagedRows : public ::testing::Test {
 protected:
  DamagedRows() {
    add_run(store_, "first", true);
    add_run(store_, "second", true);
    add_run(store_, "third", false);
  }
  /// What `read` is refused with; empty where it is not.
  static std::string refusal(const std::function<void()>& read) {
    try {
      read();
    } catch (const DamagedStore& damage) {
      return damage.what();
    }
    return {};
  }
  void change(const std::string& sql) { EXPECT_GT(store_.database()->exec(sql), 0) << sql; }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
};

TEST_F(DamagedRows, AnyChangedFieldIsRefusedByFileTableRunAndNumberAndWithARemedy) {
  change("UPDATE touches SET plane = 99 WHERE run_id = 2 AND number = 3");
  EXPECT_THAT(refusal([&] { (void)store_.touches(2); }),
              AllOf(HasSubstr(file_.string()), HasSubstr("table touches, run 2, number 3"),
                    HasSubstr("restore the last backup"), HasSubstr("--verify")));
  EXPECT_EQ(store_.touches(1).size(), 4u) << "other runs are whole";
  EXPECT_THAT(find_damage(file_), ::testing::ElementsAre(HasSubstr("table touches, run 2, number 3")));
}

TEST_F(DamagedRows, EachTableIsChecked) {
  const std::vector<std::pair<std::string, std::function<void()>>> cases{
      {"UPDATE touches SET sequence = 7 WHERE run_id = 2 AND number = 2",
       [&] { (void)store_.open_command(2); }},
      {"UPDATE superseded_touches SET reason = 'no outlier' WHERE run_id = 1",
       [&] { (void)store_.superseded_touches(1); }},
      {"UPDATE reference_touches SET drift_mm = 0.5 WHERE run_id = 1", [&] { (void)store_.references(1); }},
      {"UPDATE plan_changes SET place = 1 WHERE run_id = 1", [&] { (void)store_.plan_changes(1); }},
      {"UPDATE open_commands SET sequence = 7 WHERE run_id = 3", [&] { (void)store_.open_command(3); }},
      {"UPDATE plans SET document = '{}'", [&] { (void)store_.plan_json(1); }},
      {"UPDATE runs SET result_json = '{}' WHERE id = 1", [&] { (void)store_.result_json(1); }},
      {"UPDATE arms SET document = '{}' WHERE run_id = 1", [&] { (void)store_.arm_json(1); }},
      {"UPDATE runs SET recipe = 'quick' WHERE id = 1", [&] { (void)store_.run(1); }},
      {"UPDATE runs SET started_at = '' WHERE id = 3", [&] { (void)store_.running(); }},
      {"UPDATE runs SET trace_json = NULL WHERE id = 2", [&] { (void)store_.run(2); }}};
  for (const auto& [sql, read] : cases) {
    EXPECT_EQ(refusal(read), "") << sql;
    const std::size_t before = find_damage(file_).size();
    change(sql);
    EXPECT_NE(refusal(read), "") << sql;
    EXPECT_EQ(find_damage(file_).size(), before + 1) << sql;
  }
}

TEST_F(DamagedRows, WhatIsKeptOfFaultsResumptionsAndAnswersIsChecked) {
  FaultLog faults(store_.database());
  faults.append(2, "t1", "no_contact", "the search ended");
  faults.append({}, "t2", "link_lost", "nothing was heard");
  store_.append_resumption(3, "t", 4);
  AnswerStore answers(store_.database());
  const KeyedRequest request{"key", "POST /api/v1/runs", ""};
  answers.take(request, "t0");
  answers.keep(request, {.status = 201, .body = "told"}, "t1");
  EXPECT_EQ(faults.page(10).size(), 2u);
  EXPECT_THAT(find_damage(file_), IsEmpty());

  change("UPDATE faults SET message = 'nothing' WHERE id = 1");
  EXPECT_THAT(refusal([&] { (void)faults.page(10); }), HasSubstr("table faults, number 1"));
  EXPECT_EQ(faults.page(10, {}, 3).size(), 0u) << "of other runs it says nothing";
  change("UPDATE resumptions SET touches_done = 77");
  change("UPDATE answers SET body = x'7b7d'");
  EXPECT_THAT(refusal([&] { answers.take(request, "t0"); }), HasSubstr("table answers, number key"));
  EXPECT_THAT(find_damage(file_),
              ::testing::UnorderedElementsAre(HasSubstr("table faults, run 2, number 1"),
                                              HasSubstr("table resumptions, run 3, number 1"),
                                              HasSubstr("table answers, number key")));
}

TEST_F(DamagedRows, AResumptionThatIsGoneFromARunThatEndedIsMissed) {
  store_.append_resumption(3, "t", 4);
  store_.finish_interrupted("now");
  EXPECT_THAT(find_damage(file_), IsEmpty());
  change("DELETE FROM resumptions");
  EXPECT_THAT(find_damage(file_), ::testing::ElementsAre(HasSubstr("run 3")));
}

TEST_F(DamagedRows, RowsThatAreGoneFromARunThatEndedAreMissed) {
  for (const std::string table :
       {"touches", "superseded_touches", "reference_touches", "plan_changes", "arms"})
    change("DELETE FROM " + table + " WHERE run_id = 1");
  EXPECT_NE(refusal([&] { (void)store_.touches(1); }), "");
  EXPECT_NE(refusal([&] { (void)store_.references(1); }), "");
  EXPECT_NE(refusal([&] { (void)store_.arm_json(1); }), "");
  EXPECT_NE(refusal([&] { (void)store_.run(1); }), "");
  EXPECT_THAT(find_damage(file_), ::testing::SizeIs(1));
}

TEST_F(DamagedRows, ARunWhoseNumberChangedIsNotSaidToBeUnknown) {
  EXPECT_EQ(refusal([&] { (void)store_.run(99); }), "") << "that one never was";
  change("PRAGMA foreign_keys = OFF; UPDATE runs SET id = 8 WHERE id = 2");
  EXPECT_NE(refusal([&] { (void)store_.run(2); }), "");
}

TEST_F(DamagedRows, WhichRunIsOpenOrWasAcceptedIsNotSaidPastADamagedOne) {
  EXPECT_EQ(store_.last_accepted()->id, 2);
  change("UPDATE runs SET verdict = 'rejected' WHERE id = 2");
  EXPECT_FALSE(store_.last_accepted()) << "the first was not the last one";
  change("UPDATE runs SET outcome = 'runninf' WHERE id = 3");
  EXPECT_NE(refusal([&] { (void)store_.running(); }), "");
}

TEST_F(DamagedRows, WritingToADamagedRunDoesNotMakeItWhole) {
  change("UPDATE runs SET recipe = 'quick' WHERE id = 3");
  store_.set_touches_total(3, 5);
  store_.finish_interrupted("now");
  EXPECT_NE(refusal([&] { (void)store_.run(3); }), "");
  EXPECT_NE(refusal([&] { (void)store_.running(); }), "") << "it may be another one that is";
  EXPECT_EQ(store_.database()->execAndGet("SELECT outcome FROM runs WHERE id = 3").getString(),
            "interrupted");
  change("UPDATE touches SET plane = 3 WHERE run_id = 1 AND number = 1");
  EXPECT_NE(refusal([&] { store_.withdraw_touch(1, 1, "a person took it back"); }), "");
}

TEST_F(DamagedRows, ATouchThatComesAfterTheEndBelongsToTheRun) {
  store_.append_touch(1, {.number = 5, .plane = 1, .captured_at = "late"});
  store_.set_result_json(1, "{}");
  EXPECT_EQ(store_.touches(1).size(), 5u);
  EXPECT_EQ(store_.run(1)->touches_done, 5);
  EXPECT_FALSE(store_.arm_json(1)) << "it belonged to the result before";
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

TEST_F(DamagedRows, TextThatIsNoJsonIsRefusedAlsoWhereItWasWrittenSo) {
  const std::int64_t run = store_.begin_run({.recipe = "edf-25", .started_at = "t", .conditions_json = "{"});
  EXPECT_THAT(refusal([&] { (void)store_.run(run); }), HasSubstr("conditions is no JSON"));
  store_.set_result_json(1, "{\"a\":");
  EXPECT_THAT(refusal([&] { (void)store_.result_json(1); }), HasSubstr("no JSON"));
  store_.set_open_command(3, {.session = 2, .sequence = 1, .touch_json = ""});
  EXPECT_THAT(refusal([&] { (void)store_.open_command(3); }), HasSubstr("no JSON"));
  store_.set_plan(2, 4, "other", "]");
  EXPECT_THAT(refusal([&] { (void)store_.plan_json(2); }), HasSubstr("no JSON"));
}

/// What the store tells, part by part.
std::map<std::string, std::function<std::string()>> questions(const RunStore& store) {
  const auto told = [](const StoredRun& run) {
    return run.recipe + run.started_at + run.ended_at.value_or("-") + std::string(verdict_name(run.verdict)) +
           std::string(run_outcome_name(run.outcome)) + run.operator_name.value_or("-") +
           run.config_digest.value_or("-") + run.conditions_json.value_or("-") + run.plan_id.value_or("-") +
           std::to_string(run.id) + "/" + std::to_string(run.touches_done) + "/" +
           std::to_string(run.touches_total) + "/" + std::to_string(run.block_temperature->celsius);
  };
  const auto told_touch = [](const StoredTouch& touch) {
    std::string text = touch.captured_at;
    for (const int number : {touch.number, touch.plane, static_cast<int>(touch.role),
                             static_cast<int>(touch.source), touch.overtravel_dmm, touch.aimed_with})
      text += "/" + std::to_string(number);
    for (const std::int32_t joint : touch.joints) text += "/" + std::to_string(joint);
    return text + "/" + std::to_string(touch.session) + "/" + std::to_string(touch.sequence) + "\n";
  };
  std::map<std::string, std::function<std::string()>> asked;
  asked["runs"] = [=, &store] {
    std::string text;
    for (const StoredRun& run : store.runs(10)) text += told(run);
    return text;
  };
  asked["running"] = [=, &store] { return told(store.running().value()); };
  for (std::int64_t run = 1; run <= 3; ++run) {
    const std::string id = std::to_string(run) + " ";
    asked[id + "run"] = [=, &store] { return told(store.run(run).value()); };
    asked[id + "touches"] = [=, &store] {
      std::string text;
      for (const StoredTouch& touch : store.touches(run)) text += told_touch(touch);
      for (const SupersededTouch& touch : store.superseded_touches(run))
        text += told_touch(touch.touch) + touch.reason;
      return text;
    };
    asked[id + "references"] = [=, &store] {
      std::string text;
      for (const ReferenceTouch& touch : store.references(run))
        text += std::to_string(touch.number) + "/" + std::to_string(touch.joints[0]) + "/" +
                std::to_string(touch.drift_mm.value());
      for (const PlanChange& change : store.plan_changes(run)) text += "/" + std::to_string(change.place);
      return text;
    };
    asked[id + "open"] = [=, &store] {
      const auto open = store.open_command(run);
      return open ? open->touch_json + std::to_string(open->sequence) : "none";
    };
    asked[id + "documents"] = [=, &store] {
      return store.result_json(run).value_or("-") + store.arm_json(run).value_or("-") +
             store.plan_json(run).value_or("-");
    };
  }
  return asked;
}

std::map<std::string, std::string> answers(const RunStore& store) {
  std::map<std::string, std::string> all;
  for (const auto& [name, ask] : questions(store)) all[name] = ask();
  return all;
}

void flip_bit(const std::filesystem::path& file, std::uintmax_t bit) {
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekg(static_cast<std::streamoff>(bit / 8));
  const int byte = bytes.get();
  bytes.seekp(static_cast<std::streamoff>(bit / 8));
  bytes.put(static_cast<char>(byte ^ (1 << (bit % 8))));
}

/// All but those of the empty middles of pages.
std::vector<std::uintmax_t> bits_in_use(const std::filesystem::path& file) {
  const std::string bytes = bytes_of(file);
  std::vector<std::uintmax_t> bits;
  for (std::size_t at = 1; at + 1 < bytes.size(); ++at) {
    if (bytes[at - 1] == 0 && bytes[at] == 0 && bytes[at + 1] == 0) continue;
    for (std::size_t bit = 0; bit < 8; ++bit) bits.push_back(8 * at + bit);
  }
  return bits;
}

TEST(FlippedBits, AnAnswerIsTheSameAsBeforeOrItIsRefusedAndVerifySaysSo) {
  constexpr int kFlips = 200;
  constexpr unsigned kSeed = 20260131;
  const Folder folder;
  const auto file = folder.path() / "touchcal.sqlite", flipped = folder.path() / "flipped.sqlite";
  {
    RunStore store(file);
    add_run(store, "first", true);
    add_run(store, "second", true);
    add_run(store, "third", false);
    // Small pages, all of them in use.
    store.database()->exec("PRAGMA journal_mode = DELETE; PRAGMA page_size = 512; VACUUM");
  }
  const auto before = answers(RunStore(file));
  const std::vector<std::uintmax_t> used_bits = bits_in_use(file);
  std::mt19937_64 chance(kSeed);
  int refused = 0, told_by_verify = 0;
  for (int i = 0; i < kFlips; ++i) {
    for (const char* ending : {"", "-wal", "-shm"}) std::filesystem::remove(flipped.string() + ending);
    std::filesystem::copy_file(file, flipped);
    const std::uintmax_t bit = used_bits[chance() % used_bits.size()];
    flip_bit(flipped, bit);
    const bool damaged = !find_damage(flipped).empty();
    told_by_verify += damaged ? 1 : 0;
    bool is_refused = false;
    try {
      const RunStore store(flipped);
      for (const auto& [name, ask] : questions(store)) {
        try {
          EXPECT_EQ(ask(), before.at(name)) << "seed " << kSeed << ", bit " << bit << ": " << name;
        } catch (const std::runtime_error&) {
          is_refused = true;
        }
      }
    } catch (const std::runtime_error&) {
      is_refused = true;
    }
    refused += is_refused ? 1 : 0;
    EXPECT_TRUE(damaged || !is_refused) << "seed " << kSeed << ", bit " << bit << ": --verify says nothing";
  }
  RecordProperty("refused", refused);
  RecordProperty("told_by_verify", told_by_verify);
  EXPECT_GT(refused, kFlips / 4) << "the flips hit nothing";
}

}  // namespace
}  // namespace cell
