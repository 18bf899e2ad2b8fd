#include "service/daemon/daily_care.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "config/utc_text.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/outbox.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/store/many_facts.hpp"

namespace cell {
namespace {

class DailyCareTest : public ::testing::Test {
 protected:
  void run_of(const std::string& at) {
    const std::int64_t run = store_.begin_run({.recipe = "edf-25", .started_at = at});
    store_.finish_run(run, {.outcome = RunOutcome::kComplete, .verdict = Verdict::kRejected, .ended_at = at});
  }
  void care(const DailyCare& care) { care_for(store_, cell_, care, now_); }
  [[nodiscard]] std::size_t facts() const { return OutboxReader(file_).next(0, 1000).size(); }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  Cell cell_;
  std::chrono::system_clock::time_point now_ = time_from_utc("2026-05-01T00:00:00Z").value();
};

TEST_F(DailyCareTest, RunsAndFactsStayWhileASinkHasNotHeardOfThem) {
  for (int run = 0; run <= kLastRunsKept; ++run) run_of("2026-01-01T00:00:00.000Z");
  for (const char* day : {"2026-04-28", "2026-04-29", "2026-04-30"})
    run_of(std::string(day) + "T00:00:00.000Z");
  const std::size_t all = facts();
  const auto runs = [&] { return store_.runs(100).size(); };
  care({});
  EXPECT_EQ(facts(), all) << "they are kept for ever";
  const DailyCare month{.retain_days = 30, .sinks = {"mqtt"}};
  care(month);
  EXPECT_EQ(facts(), all);
  EXPECT_EQ(runs(), static_cast<std::size_t>(kLastRunsKept) + 4);
  Outbox(store_.database()).confirm("mqtt", 1000);
  care(month);
  EXPECT_EQ(facts(), 6u) << "those of three runs are not a month old";
  EXPECT_EQ(runs(), static_cast<std::size_t>(kLastRunsKept));
}

TEST_F(DailyCareTest, ACertificateThatEndsIsToldOfOnce) {
  cell_.block.certificate["valid_until"] = "2026-05-09";
  care({});
  care({});
  const auto told = OutboxReader(file_).next(0, 10);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, "certificate_expiring");
  EXPECT_EQ(told[0].at, "2026-05-01T00:00:00.000Z");
}

TEST_F(DailyCareTest, AClockFiveYearsAheadTakesNothingAndTellsOnceMoreWhenItIsRight) {
  cell_.block.certificate["valid_until"] = "2027-01-31";
  for (int run = 0; run <= kLastRunsKept; ++run) run_of("2026-04-01T00:00:00.000Z");
  Outbox(store_.database()).confirm("mqtt", 1000);
  const std::size_t all = facts();
  const DailyCare year{.retain_days = 365, .sinks = {"mqtt"}};
  now_ += std::chrono::years(5);
  care(year);
  EXPECT_EQ(store_.runs(100).size(), static_cast<std::size_t>(kLastRunsKept) + 1);
  EXPECT_EQ(facts(), all + 1) << "and that the certificate is over";
  now_ -= std::chrono::years(5);
  care(year);
  EXPECT_EQ(facts(), all + 2) << "and that it is not";
  now_ = time_from_utc("2027-01-05T00:00:00Z").value();
  care(year);
  EXPECT_EQ(OutboxReader(file_).next(0, 1000).back().at, "2027-01-05T00:00:00.000Z");
}

TEST_F(DailyCareTest, ManyOldFactsGoInPiecesBetweenWhichOthersWrite) {
  run_of("2026-01-01T00:00:00.000Z");
  add_facts(store_, kFactsDeletedAtOnce, "2026-01-02T00:00:00.000Z");
  for (const char* day : {"2026-04-28", "2026-04-29", "2026-04-30"})
    run_of(std::string(day) + "T00:00:00.000Z");
  Outbox(store_.database()).confirm("mqtt", 1'000'000);
  const DailyCare month{.retain_days = 30, .sinks = {"mqtt"}};
  EXPECT_TRUE(care_for(store_, cell_, month, now_));
  EXPECT_FALSE(delete_old_facts(store_, month, now_));
  EXPECT_EQ(facts(), 6u) << "those of three runs";
}

TEST_F(DailyCareTest, WhatFailsKeepsNothingElseFromBeingDone) {
  cell_.block.certificate["valid_until"] = "2026-05-09";
  store_.database()->exec("DROP TABLE delivered");
  care({.retain_days = 1, .sinks = {"mqtt"}});
  EXPECT_EQ(facts(), 1u);
}

}  // namespace
}  // namespace cell
