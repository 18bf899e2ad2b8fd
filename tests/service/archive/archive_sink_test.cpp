#include "service/archive/archive_sink.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <functional>
#include <future>
#include <stop_token>
#include <thread>

#include "service/plant/sink_thread.hpp"
#include "tests/service/archive/archive_bench.hpp"
#include "tests/service/archive/slow_line.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

TEST_F(ArchiveTest, KeepsEachFactOnceWithWhatGoesWithIt) {
  run_of(store_);
  const auto sink = connect();
  EXPECT_EQ(sink->deliver(facts(), {}), 3);
  EXPECT_EQ(sink->deliver(facts(), {}), 3) << "once more";
  EXPECT_EQ(value("SELECT count(*) FROM event"), "3");
  EXPECT_EQ(value("SELECT count(*) FROM touch"), "3");
  EXPECT_EQ(value("SELECT joints_microdeg[2] FROM touch WHERE number = 3"), "-2");
  EXPECT_EQ(value("SELECT count(*) FROM document"), "2") << "result and arm; there was no plan";
  EXPECT_EQ(
      value("SELECT document.body FROM document, event WHERE kind = 'touch_set_closed' AND document.sha256 = "
            "event.body::json ->> 'result_sha256'"),
      R"({"a":"ä"})");
  const ArchiveDocument look = look_at_archive(owner_);
  EXPECT_THAT(look.damage, IsEmpty());
  EXPECT_EQ(look.events, 3);
  EXPECT_EQ(look.cells, 1);
}

TEST_F(ArchiveTest, ACellWritesRowsOfItsOwnAndChangesNone) {
  run_of(store_);
  EXPECT_THAT([&] { connect("other")->deliver(facts(), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("row-level security")));
  connect()->deliver(facts(), {});
  pqxx::connection connection(writer_);
  for (const char* change :
       {"UPDATE event SET at = ''", "DELETE FROM event", "DELETE FROM document", "SELECT * FROM touch"}) {
    pqxx::work work(connection);
    EXPECT_THROW(work.exec(change), pqxx::insufficient_privilege) << change;
  }
}

TEST_F(ArchiveTest, AnotherHistoryOfTheSameCellIsNotMixedIn) {
  run_of(store_);
  connect()->deliver(facts(), {});
  const Folder folder;
  const auto file = folder.path() / "touchcal.sqlite";
  RunStore restored(file);
  run_of(restored, "edf-37");
  const auto sink = connect_archive(writer_, "edf", file);
  EXPECT_THAT([&] { sink->deliver(OutboxReader(file).next(0, 10), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("has another event 1 of cell edf")));
  EXPECT_THAT(look_at_archive(owner_).damage, IsEmpty());
}

TEST_F(ArchiveTest, OneThatDoesNotAnswerIsGivenUpAndSaidToBe) {
  run_of(store_);
  const auto sink = connect_archive(writer_, "edf", file_, {}, std::chrono::milliseconds(100));
  pqxx::connection connection(owner_);
  pqxx::work lock(connection);
  lock.exec0("LOCK TABLE event");
  try {
    sink->deliver(facts(), {});
    ADD_FAILURE() << "it waited for the table";
  } catch (const SinkTrouble& trouble) {
    EXPECT_THAT(trouble.what(), HasSubstr("has not answered in 0.1 s"));
  }
  lock.abort();
  EXPECT_EQ(connect()->deliver(facts(), {}), facts().back().seq);
}

TEST_F(ArchiveTest, AClockThatStandsWrongIsSaidAndNothingElseChanges) {
  run_of(store_);
  auto apart = std::chrono::hours(0);
  const auto sink = connect_archive(writer_, "edf", file_, {}, std::chrono::seconds(30),
                                    [&] { return std::chrono::system_clock::now() + apart; });
  EXPECT_EQ(sink->remark(), std::nullopt);
  apart = std::chrono::years(5) / std::chrono::hours(1) * std::chrono::hours(1);
  EXPECT_EQ(sink->deliver(facts(), {}), 3);
  EXPECT_THAT(sink->remark().value_or(""), HasSubstr("h ahead of that of the archive"));
  apart = std::chrono::hours(-25);
  EXPECT_EQ(sink->deliver(facts(), {}), 3);
  EXPECT_THAT(sink->remark().value_or(""), HasSubstr("clock is 25.0 h behind that of the archive"));
  apart = std::chrono::hours(0);
  EXPECT_EQ(sink->deliver(facts(), {}), 3);
  EXPECT_EQ(sink->remark(), std::nullopt) << "it was set right";
}

TEST_F(ArchiveTest, TheEndOfADaemonWaitsForNoArchive) {
  run_of(store_);
  const auto sink = connect();
  pqxx::connection connection(owner_);
  pqxx::work lock(connection);
  lock.exec0("LOCK TABLE event");
  std::stop_source ending;
  const std::jthread end([&] {
    pqxx::connection watcher(owner_);
    // Its INSERT waits for the lock: then the end is asked for.
    for (bool waits = false; !waits;) {
      pqxx::work look(watcher);
      waits = look.exec1("SELECT count(*) FROM pg_locks WHERE NOT granted")[0].as<int>() > 0;
    }
    ending.request_stop();
  });
  EXPECT_THROW(sink->deliver(facts(), ending.get_token()), SinkTrouble);
}

TEST_F(ArchiveTest, ADatabaseThatIsAwayGetsAllThatItHasNot) {
  run_of(store_);
  std::promise<void> first, all;
  bool is_first = true, is_back = false;
  std::string trouble;
  const auto states = std::make_shared<SinkStates>();
  {
    const SinkThread thread({.name = "archive",
                             .store = file_,
                             .states = states,
                             .connect = [&](const std::stop_token&) { return connect(); },
                             .confirmed =
                                 [&](std::int64_t seq) {
                                   if (std::exchange(is_first, false)) first.set_value();
                                   if (seq == 6) all.set_value();
                                 },
                             .wait =
                                 [&](std::stop_token, std::chrono::milliseconds) {
                                   if (std::exchange(is_back, true)) return;
                                   trouble = states->of("archive")->trouble.value_or("");
                                   sql("ALTER ROLE edf LOGIN");
                                 }});
    first.get_future().wait();
    sql("ALTER ROLE edf NOLOGIN");
    sql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE usename = 'edf'");
    run_of(store_);
    all.get_future().wait();
  }
  EXPECT_THAT(trouble, HasSubstr("the archive: "));
  EXPECT_EQ(value("SELECT count(*) FROM event"), "6");
  EXPECT_THAT(look_at_archive(owner_).damage, IsEmpty());
}

/// What a thread delivers that begins where a sink has confirmed; done with the fact `last`.
struct Redelivery {
  std::vector<std::string> troubles;
  SinkState at_end;
};
Redelivery deliver_up_to(const std::filesystem::path& store, std::int64_t last,
                         const std::function<std::unique_ptr<Sink>()>& connect) {
  Redelivery redelivery;
  std::promise<void> all;
  const auto states = std::make_shared<SinkStates>();
  {
    const SinkThread thread({.name = "archive",
                             .store = store,
                             .states = states,
                             .connect = [&](const std::stop_token&) { return connect(); },
                             .confirmed =
                                 [&](std::int64_t seq) {
                                   if (seq == last) all.set_value();
                                 },
                             .wait =
                                 [&](std::stop_token, std::chrono::milliseconds) {
                                   redelivery.troubles.push_back(states->of("archive")->trouble.value_or(""));
                                 }});
    all.get_future().wait();
  }
  redelivery.at_end = states->of("archive").value();
  return redelivery;
}

TEST_F(ArchiveTest, OneThatWasEmptiedOrRestoredGetsAgainWhatItHasLost) {
  run_of(store_);
  run_of(store_);
  connect()->deliver(facts(), {});
  Outbox(store_.database()).confirm("archive", 6);
  for (const char* loss : {"TRUNCATE event, touch, document", "DELETE FROM event WHERE seq > 2"}) {
    sql(loss);
    store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:02:00.000Z"});
    const auto last = facts().back().seq;
    const Redelivery again = deliver_up_to(file_, last, [&] { return connect(); });
    EXPECT_THAT(again.troubles, IsEmpty()) << loss;
    EXPECT_EQ(value("SELECT count(*) FROM event"), std::to_string(last)) << loss;
    EXPECT_EQ(value("SELECT count(*) FROM touch"), "6") << loss;
    EXPECT_THAT(look_at_archive(owner_).damage, IsEmpty()) << loss;
    EXPECT_EQ(again.at_end.behind, 0);
    Outbox(store_.database()).confirm("archive", last);
  }
}

TEST_F(ArchiveTest, WhatIsLostThereAndDeletedHereIsToldOnceAndTheRestGoesOn) {
  for (int i = 0; i < 3; ++i) run_of(store_);
  connect()->deliver(facts(), {});
  Outbox(store_.database()).confirm("archive", 9);
  sql("DELETE FROM event WHERE seq > 2");
  store_.database()->exec("DELETE FROM outbox WHERE seq <= 6");
  store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:02:00.000Z"});
  const Redelivery again = deliver_up_to(file_, 10, [&] { return connect(); });
  EXPECT_THAT(again.troubles, ElementsAre(HasSubstr("has lost facts 3 to 6")));
  EXPECT_EQ(again.at_end.trouble, std::nullopt);
  EXPECT_THAT(look_at_archive(owner_).damage, ElementsAre("cell edf: events 3 to 6 are missing"));
}

TEST_F(ArchiveTest, OneThatIsEmptiedUnderAConnectionIsNotFilledWithAGap) {
  run_of(store_);
  const auto sink = connect();
  sink->deliver(facts(), {});
  sql("TRUNCATE event");
  run_of(store_);
  EXPECT_THAT([&] { sink->deliver(OutboxReader(file_).next(3, 100), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("has lost what it had kept behind event 0 of cell edf")));
  EXPECT_EQ(value("SELECT count(*) FROM event"), "0");
}

class ArchiveBehindALine : public ArchiveTest {
 protected:
  std::string server_socket() {
    return value("SELECT current_setting('unix_socket_directories')") + "/.s.PGSQL.5432";
  }
  std::unique_ptr<Sink> connect_over(const SlowLine& line,
                                     std::chrono::milliseconds patience = std::chrono::seconds(30)) {
    return connect_archive(
        "postgresql://edf@127.0.0.1:" + std::to_string(line.port()) + "/postgres?sslmode=disable", "edf",
        file_, {}, patience);
  }
};

TEST_F(ArchiveBehindALine, ManyTouchesTakeNoMoreRoundTripsThanFew) {
  const SlowLine line(server_socket(), std::chrono::milliseconds(0));
  const auto sink = connect_over(line);
  std::vector<int> taken;
  std::int64_t after = 0;
  for (const int touches : {3, 150}) {
    run_of(store_, "edf-25", touches);
    const int before = line.round_trips();
    after = sink->deliver(OutboxReader(file_).next(after, 100), {});
    taken.push_back(line.round_trips() - before);
  }
  EXPECT_EQ(value("SELECT count(*) FROM touch"), "153");
  EXPECT_LE(taken[1], taken[0]) << "the first time statements are prepared, too";
  EXPECT_THAT(look_at_archive(owner_).damage, IsEmpty());
}

TEST_F(ArchiveBehindALine, EachAnswerHasItsTimeAndNotTheWholeTransaction) {
  constexpr std::chrono::milliseconds kDelay(150), kPatience(1200);
  run_of(store_, "edf-25", 90);
  const SlowLine line(server_socket(), kDelay);
  const auto sink = connect_over(line, kPatience);
  const int before = line.round_trips();
  EXPECT_EQ(sink->deliver(facts(), {}), 3);
  EXPECT_GT((line.round_trips() - before) * kDelay, kPatience) << "or this shows nothing";
  EXPECT_EQ(value("SELECT count(*) FROM touch"), "90");
}

TEST_F(ArchiveBehindALine, OneThatBreaksOffAgainAndAgainLetsAllFactsPassAtLast) {
  for (int i = 0; i < 12; ++i) run_of(store_);
  const SlowLine line(server_socket(), std::chrono::milliseconds(0), 60);
  const std::int64_t last = facts().back().seq;
  const Redelivery delivered = deliver_up_to(file_, last, [&] { return connect_over(line); });
  EXPECT_FALSE(delivered.troubles.empty());
  EXPECT_EQ(value("SELECT count(*) FROM event"), std::to_string(last));
  EXPECT_THAT(look_at_archive(owner_).damage, IsEmpty());
}

TEST_F(ArchiveTest, OneThatIsAwayShowsThoughThereIsNoFact) {
  const auto sink = connect();
  std::stop_source at_once;
  at_once.request_stop();
  sql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE usename = 'edf'");
  sink->rest(std::chrono::seconds(29), at_once.get_token());
  EXPECT_NO_THROW(sink->rest(std::chrono::seconds(1), at_once.get_token())) << "it has not looked yet";
  EXPECT_THAT([&] { sink->rest(std::chrono::seconds(1), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("the archive: ")));
}

TEST_F(ArchiveTest, OneThatIsEmptiedShowsThoughThereIsNoFact) {
  run_of(store_);
  const auto sink = connect();
  sink->deliver(facts(), {});
  std::stop_source at_once;
  at_once.request_stop();
  sink->rest(std::chrono::seconds(30), at_once.get_token());
  EXPECT_NO_THROW(sink->rest(std::chrono::milliseconds(0), {})) << "all is there";
  sink->rest(std::chrono::seconds(30), at_once.get_token());
  sql("TRUNCATE event");
  EXPECT_THAT([&] { sink->rest(std::chrono::milliseconds(0), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("has lost what it had kept behind event 0")));
}

}  // namespace
}  // namespace cell
