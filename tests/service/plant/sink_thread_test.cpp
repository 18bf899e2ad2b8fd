#include "service/plant/sink_thread.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <vector>

#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The other system as a test scripts it; of the sink's thread until `done` is ready.
struct OtherSide {
  std::vector<std::int64_t> kept;     // the numbers it has got, in order
  std::vector<int> broken_pauses_ms;  // between tries
  std::vector<SinkState> states;      // at each pause
  int refused_connects = 0;
  int broken_deliveries = 0;
  int refused_after_break = 0;           // connects
  bool is_emptied = false;               // before the first connect, and says what it has
  std::int64_t confirms_at_once = 1000;  // of one batch
  std::size_t ends_with = 0;             // done when it has so many
  std::optional<std::string> remark;
  std::size_t dies_with = 0;                  // once, when it has so many
  std::chrono::steady_clock::time_point now;  // a second later with each that it gets
  std::promise<void> done;
  bool is_done = false;

  void look() {
    if (kept.size() >= ends_with && !std::exchange(is_done, true)) done.set_value();
  }
};

class ScriptedSink final : public Sink {
 public:
  explicit ScriptedSink(OtherSide& other) : other_(other) {
    if (other_.refused_connects-- > 0) throw SinkTrouble("nobody is there");
  }
  std::int64_t deliver(std::span<const Fact> facts, std::stop_token) override {
    if (other_.broken_deliveries-- > 0) {
      other_.refused_connects = other_.refused_after_break;
      throw SinkTrouble("it broke off");
    }
    std::int64_t confirmed = 0;
    for (const Fact& fact :
         facts.first(std::min<std::size_t>(facts.size(), static_cast<std::size_t>(other_.confirms_at_once))))
      other_.kept.push_back(confirmed = fact.seq);
    other_.now += std::chrono::seconds(1);
    return confirmed;
  }
  void rest(std::chrono::milliseconds, std::stop_token) override {
    if (other_.dies_with > 0 && other_.kept.size() == other_.dies_with) {
      other_.dies_with = 0;
      throw SinkTrouble("it has died");
    }
    other_.look();
  }
  [[nodiscard]] std::optional<std::int64_t> last_kept() const override {
    if (!other_.is_emptied) return std::nullopt;
    return other_.kept.empty() ? 0 : other_.kept.back();
  }
  [[nodiscard]] std::optional<std::string> remark() const override { return other_.remark; }

 private:
  OtherSide& other_;
};

class SinkThreadTest : public ::testing::Test {
 protected:
  void begin_runs(int count) {
    for (int i = 0; i < count; ++i) store_.begin_run({.recipe = "edf-25", .started_at = "then"});
  }
  /// Until the other side has all that it ends with.
  void deliver() {
    auto done = other_.done.get_future();
    const SinkThread thread(
        {.name = "other",
         .store = file_,
         .states = states_,
         .connect = [this](const std::stop_token&) { return std::make_unique<ScriptedSink>(other_); },
         .may_lose = may_lose_,
         .clock = [this] { return other_.now; },
         .confirmed = [this](std::int64_t seq) { confirmed_.push_back(seq); },
         .wait =
             [this](std::stop_token, std::chrono::milliseconds time) {
               other_.broken_pauses_ms.push_back(static_cast<int>(time.count()));
               other_.states.push_back(states_->of("other").value());
             }});
    done.wait();
  }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  OtherSide other_;
  std::shared_ptr<SinkStates> states_ = std::make_shared<SinkStates>();
  std::vector<std::int64_t> confirmed_;
  std::chrono::seconds may_lose_{0};
};

TEST_F(SinkThreadTest, DeliversEachFactOnceInOrderFromWhereTheSinkHasConfirmed) {
  begin_runs(5);
  Outbox(store_.database()).confirm("other", 2);
  Outbox(store_.database()).confirm("another", 4);
  other_.confirms_at_once = 2;
  other_.ends_with = 3;
  deliver();
  EXPECT_THAT(other_.kept, ElementsAre(3, 4, 5));
  EXPECT_THAT(confirmed_, ElementsAre(4, 5));
  EXPECT_THAT(other_.broken_pauses_ms, IsEmpty());
  EXPECT_EQ(states_->of("other"), (SinkState{.sink = "other", .connected = true}));
}

TEST_F(SinkThreadTest, TriesAgainLaterAndLaterAndTellsWhyAndHowFarItIsBehind) {
  begin_runs(3);
  other_.refused_connects = 2;
  other_.broken_deliveries = 1;
  other_.ends_with = 3;
  deliver();
  EXPECT_THAT(other_.kept, ElementsAre(1, 2, 3));
  // Of one second, of two and of four, in pieces of a second.
  EXPECT_THAT(other_.broken_pauses_ms, ::testing::AllOf(::testing::SizeIs(7), ::testing::Each(1000)));
  EXPECT_EQ(other_.states.front(),
            (SinkState{.sink = "other", .behind = 3, .oldest_at = "then", .trouble = "nobody is there"}));
  EXPECT_EQ(other_.states.back().trouble, "it broke off");
  EXPECT_EQ(states_->of("other")->trouble, std::nullopt);
}

TEST_F(SinkThreadTest, SendsAgainWhatOneThatDiedMayHaveLostHoweverOldTheFactsAre) {
  begin_runs(5);
  other_.confirms_at_once = 1;
  other_.dies_with = 5;
  other_.ends_with = 8;
  may_lose_ = std::chrono::seconds(3);
  deliver();
  EXPECT_THAT(other_.kept, ElementsAre(1, 2, 3, 4, 5, 3, 4, 5))
      << "those of the last three seconds once more";
  EXPECT_THAT(confirmed_, ElementsAre(1, 2)) << "another start of the daemon sends the rest once more too";
}

TEST_F(SinkThreadTest, OneThatWasEmptiedIsBehindUntilItHasAllAgain) {
  begin_runs(5);
  Outbox(store_.database()).confirm("other", 5);
  other_.is_emptied = true;
  other_.broken_deliveries = 1;
  other_.refused_after_break = 1;
  other_.ends_with = 5;
  deliver();
  EXPECT_THAT(other_.kept, ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(other_.broken_pauses_ms, ElementsAre(1000, 1000, 1000));
  EXPECT_THAT(other_.states, Each(Field(&SinkState::behind, 5)));
  EXPECT_EQ(states_->of("other"), (SinkState{.sink = "other", .connected = true}));
}

TEST_F(SinkThreadTest, AClockThatJumpsChangesNothingOfWhatIsSent) {
  for (const char* year : {"2026", "2031", "1970", "2026"})
    store_.begin_run({.recipe = "edf-25", .started_at = std::string(year) + "-01-01T00:00:00.000Z"});
  Outbox(store_.database()).confirm("other", 1);
  other_.dies_with = 3;
  other_.ends_with = 3;
  deliver();
  EXPECT_THAT(other_.kept, ElementsAre(2, 3, 4)) << "each once, over a new connection too";
}

TEST_F(SinkThreadTest, WhatIsToBeLookedAtIsToldThoughFactsAreTaken) {
  begin_runs(1);
  other_.remark = "the clock stands wrong";
  other_.ends_with = 1;
  deliver();
  EXPECT_EQ(states_->of("other"),
            (SinkState{.sink = "other", .connected = true, .trouble = "the clock stands wrong"}));
}

TEST_F(SinkThreadTest, DoesNotTellFactsThatWereChanged) {
  begin_runs(3);
  store_.database()->exec("UPDATE outbox SET at = 'other' WHERE seq = 2");
  other_.ends_with = 1000;
  std::promise<void> waited;
  std::atomic<bool> is_told = false;
  {
    const SinkThread thread(
        {.name = "other",
         .store = file_,
         .states = states_,
         .connect = [this](const std::stop_token&) { return std::make_unique<ScriptedSink>(other_); },
         .confirmed = [](std::int64_t) {},
         .wait =
             [&](std::stop_token, std::chrono::milliseconds) {
               if (!is_told.exchange(true)) waited.set_value();
             }});
    waited.get_future().wait();
  }
  EXPECT_THAT(other_.kept, IsEmpty());
  EXPECT_THAT(states_->of("other")->trouble.value(), HasSubstr("table outbox"));
}

TEST_F(SinkThreadTest, AFactThatComesWhileItRestsIsDelivered) {
  other_.ends_with = 0;
  auto done = other_.done.get_future();
  std::promise<std::int64_t> confirmed;
  const SinkThread thread(
      {.name = "other",
       .store = file_,
       .states = states_,
       .connect = [this](const std::stop_token&) { return std::make_unique<ScriptedSink>(other_); },
       .confirmed = [&](std::int64_t seq) { confirmed.set_value(seq); }});
  done.wait();
  begin_runs(1);
  EXPECT_EQ(confirmed.get_future().get(), 1);
}

}  // namespace
}  // namespace cell
