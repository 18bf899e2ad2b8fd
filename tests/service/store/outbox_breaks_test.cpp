// A fact and what it tells of are there together or not at all, whatever fails in between.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <functional>
#include <string>
#include <vector>

#include "service/store/fault_log.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/model_store.hpp"
#include "service/store/outbox.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/store/numbered_touch.hpp"

namespace cell {
namespace {

using ::testing::IsEmpty;

/// More than find room on the pages that there are.
constexpr int kFaultsMax = 1000;

/// Each call that writes a fact, and whether what it tells of is there.
struct ToldCall {
  const char* name;
  std::function<void(RunStore&)> call;
  const char* fact_of_it;  // SQL: how often it has happened
};
const std::vector<ToldCall>& told_calls() {
  static const std::vector<ToldCall> calls{
      {"begin_run", [](RunStore& store) { store.begin_run({.recipe = "edf-25", .started_at = "later"}); },
       "SELECT count(*) FROM runs WHERE started_at = 'later'"},
      {"withdraw_run", [](RunStore& store) { store.withdraw_run(2); },
       "SELECT count(*) = 0 FROM runs WHERE id = 2"},
      {"finish_run",
       [](RunStore& store) { store.finish_run(2, {.outcome = RunOutcome::kComplete, .ended_at = "later"}); },
       "SELECT count(*) FROM runs WHERE id = 2 AND ended_at = 'later'"},
      {"finish_interrupted", [](RunStore& store) { store.finish_interrupted("later"); },
       "SELECT count(*) FROM runs WHERE id = 2 AND ended_at = 'later'"},
      {"append_touch", [](RunStore& store) { store.append_touch(1, touch_of_number(3)); },
       "SELECT count(*) FROM touches WHERE number = 3"},
      {"set_result_json", [](RunStore& store) { store.set_result_json(1, "{}"); },
       "SELECT count(*) FROM runs WHERE id = 1 AND result_json = '{}'"},
      {"approve",
       [](RunStore& store) {
         ModelStore(store.database())
             .approve({.run_id = 1, .hash = "new", .document = "{}", .arm_json = "{}"});
       },
       "SELECT count(*) FROM models WHERE hash = 'new'"},
      {"roll_back", [](RunStore& store) { ModelStore(store.database()).roll_back("later", {}); },
       "SELECT count(*) FROM models WHERE kind = 'rolled_back'"},
      {"note_applied",
       [](RunStore& store) {
         ModelStore(store.database()).note_applied({.run_id = 1, .hash = "two", .to = "it", .at = "later"});
       },
       "SELECT count(*) FROM models WHERE kind = 'applied'"},
      {"fault", [](RunStore& store) { FaultLog(store.database()).append({}, "later", "link_lost", ""); },
       "SELECT count(*) FROM faults"},
      {"certificate",
       [](RunStore& store) {
         Outbox(store.database()).tell_expiring({{"block", "2026"}}, "later");
       },
       "SELECT count(*) FROM told_certificates"}};
  return calls;
}

class OutboxBreaks : public ::testing::TestWithParam<std::size_t> {
 protected:
  OutboxBreaks() {
    store_.begin_run({.recipe = "edf-25", .started_at = "start"});
    for (const int number : {1, 2}) store_.append_touch(1, touch_of_number(number));
    store_.finish_run(1, {.outcome = RunOutcome::kComplete, .ended_at = "end"});
    store_.begin_run({.recipe = "edf-25", .started_at = "start"});
    ModelStore models(store_.database());
    for (const char* hash : {"one", "two"})
      models.approve({.run_id = 1, .hash = hash, .document = "{}", .arm_json = "{}"});
  }
  int count(const std::string& sql) { return store_.database()->execAndGet(sql).getInt(); }
  const ToldCall& told() const { return told_calls()[GetParam()]; }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
};

/// Lets `left` changes of rows of the outbox's tables and of others through and refuses the next.
struct Refusal {
  int left = 0;
  bool refused = false;
};

TEST_P(OutboxBreaks, WhicheverWriteFailsAFactAndWhatItTellsOfAreBothThereOrNeither) {
  const int facts_before = count("SELECT count(*) FROM outbox");
  ASSERT_EQ(count(told().fact_of_it), 0);
  Refusal refusal;
  bool done = false;
  for (int at = 0; !done; ++at) {
    ASSERT_LT(at, 100) << "it is never done";
    refusal = {.left = at};
    // Each write of a statement begins with a step of the virtual machine's program for it: it is refused
    // there.
    sqlite3_set_authorizer(
        store_.database()->getHandle(),
        [](void* self, int action, const char*, const char*, const char*, const char*) {
          auto& refusal = *static_cast<Refusal*>(self);
          if (action != SQLITE_INSERT && action != SQLITE_UPDATE && action != SQLITE_DELETE) return SQLITE_OK;
          if (--refusal.left >= 0) return SQLITE_OK;
          refusal.refused = true;
          return SQLITE_DENY;
        },
        &refusal);
    try {
      told().call(store_);
      done = true;
    } catch (const std::exception&) {
    }
    sqlite3_set_authorizer(store_.database()->getHandle(), nullptr, nullptr);
    EXPECT_NE(done, refusal.refused) << at;
    EXPECT_EQ(count(told().fact_of_it), done ? 1 : 0) << "write " << at;
    EXPECT_EQ(count("SELECT count(*) FROM outbox") > facts_before, done) << "write " << at;
    EXPECT_THAT(find_damage(file_), IsEmpty()) << "write " << at;
  }
}

TEST_P(OutboxBreaks, OnAFullDiskAFactAndWhatItTellsOfAreBothThereOrNeither) {
  const int facts_before = count("SELECT count(*) FROM outbox");
  store_.database()->exec("VACUUM");
  // A fact finds room on the last page of its table for a while.
  const std::string pages = store_.database()->execAndGet("PRAGMA page_count").getString();
  store_.database()->exec("PRAGMA max_page_count = " + pages);
  bool done = true;
  try {
    for (int i = 0; i < kFaultsMax; ++i)
      FaultLog(store_.database()).append({}, "then", "link_lost", std::string(500, 'x'));
    ADD_FAILURE() << "the disk is never full";
  } catch (const std::exception&) {
  }
  const int faults = count("SELECT count(*) FROM faults");
  EXPECT_EQ(count("SELECT count(*) FROM outbox"), facts_before + faults);
  const int happened = count(told().fact_of_it), told_before = count("SELECT count(*) FROM outbox");
  try {
    told().call(store_);
  } catch (const std::exception&) {
    done = false;
  }
  EXPECT_EQ(count(told().fact_of_it) > happened, done);
  EXPECT_EQ(count("SELECT count(*) FROM outbox") > told_before, done);
  EXPECT_THAT(find_damage(file_), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Calls, OutboxBreaks, ::testing::Range<std::size_t>(0, told_calls().size()),
                         [](const auto& call) { return told_calls()[call.param].name; });

}  // namespace
}  // namespace cell
