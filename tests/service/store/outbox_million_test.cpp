// A plant that was away for a very long time: what a million facts cost that wait for it.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <string>

#include "service/store/maintenance.hpp"
#include "service/store/outbox.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/store/many_facts.hpp"

namespace cell {
namespace {

constexpr std::int64_t kMillion = 1'000'000;
constexpr int kBatch = 100;
/// Of the database's virtual machine; a look at each of the facts takes some millions.
constexpr int kFewSteps = 20'000;

/// The steps that a connection takes, in hundreds.
class StepCount {
 public:
  explicit StepCount(const SharedDatabase& database) : database_(database) {
    sqlite3_progress_handler(
        database_->getHandle(), 100,
        [](void* self) {
          ++static_cast<StepCount*>(self)->hundreds_;
          return 0;
        },
        this);
  }
  ~StepCount() { sqlite3_progress_handler(database_->getHandle(), 0, nullptr, nullptr); }
  StepCount(const StepCount&) = delete;
  StepCount& operator=(const StepCount&) = delete;
  [[nodiscard]] int steps() const { return 100 * hundreds_; }

 private:
  SharedDatabase database_;
  int hundreds_ = 0;
};

TEST(AMillionFactsBehind, AreCountedReadWrittenAndConfirmedByFewSteps) {
  const Folder folder;
  const auto file = folder.path() / "touchcal.sqlite";
  RunStore store(file);
  const std::string then = "2026-01-01T00:00:00.000Z";
  for (int run = 0; run < kBatch / 2; ++run)
    store.finish_run(store.begin_run({.recipe = "edf-25", .started_at = then}),
                     {.outcome = RunOutcome::kStopped, .ended_at = then});
  add_facts(store, kMillion - kBatch, "2026-01-02T00:00:00.000Z");

  const OutboxReader reader(file);
  {
    const StepCount reading(reader.database());
    EXPECT_EQ(reader.backlog(0), (Backlog{.count = kMillion, .oldest_at = then}));
    EXPECT_EQ(reader.next(0, kBatch).size(), static_cast<std::size_t>(kBatch));
    EXPECT_EQ(reader.backlog(kBatch).count, kMillion - kBatch);
    EXPECT_LT(reading.steps(), kFewSteps);
  }
  const StepCount writing(store.database());
  store.begin_run({.recipe = "edf-25", .started_at = "2026-05-01T00:00:00.000Z"});
  Outbox(store.database()).confirm("mqtt", kBatch);
  const FactsKept since{.oldest = "2026-04-01T00:00:00.000Z", .now = "2026-05-01T00:00:00.000Z"};
  EXPECT_EQ(delete_facts(store.database(), {"mqtt", "archive"}, since), 0) << "the archive has none of them";
  EXPECT_EQ(delete_runs_before(store.database(), since.oldest, 0, {"mqtt", "archive"}), 0);
  EXPECT_LT(writing.steps(), kFewSteps) << "a touch waits for what the store's thread does";
}

}  // namespace
}  // namespace cell
