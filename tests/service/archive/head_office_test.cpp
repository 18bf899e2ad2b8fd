// service/package/plant/head-office between two servers of PostgreSQL.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <pqxx/pqxx>
#include <string>
#include <vector>

#include "service/archive/archive_reader.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/archive_sink.hpp"
#include "service/archive/fleet_reader.hpp"
#include "service/store/run_store.hpp"
#include "tests/service/archive/postgres.hpp"

namespace cell {
namespace {

using ::testing::IsEmpty;

/// Two archives, prepared; the plant's gets the runs of a cell `edf`.
class HeadOffice : public ::testing::Test {
 protected:
  HeadOffice() {
    prepare_archive(plant_.url());
    prepare_archive(head_.url());
    plant_.sql("CREATE ROLE edf LOGIN IN ROLE touchcal_writer");
  }
  int set_up(const std::string& more = "") { return set_up(more, head_); }
  int set_up(const std::string& more, const Postgres& head) {
    const std::string call = std::string(TOUCHCAL_SOURCE_DIR) +
                             "/service/package/plant/head-office --archive '" + plant_.url() + "' --head '" +
                             head.url() + "' --name north " + more + " >/dev/null 2>&1";
    return WEXITSTATUS(std::system(call.c_str()));
  }
  void archive_a_run() {
    const std::int64_t run = store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:00:00.000Z"});
    store_.append_touch(
        run,
        {.number = 1, .plane = 1, .joints = {1, -2, 3, 4, 5, 6}, .captured_at = "2026-01-01T00:00:01.000Z"});
    store_.finish_run(run, {.outcome = RunOutcome::kComplete,
                            .verdict = Verdict::kAccepted,
                            .ended_at = "2026-01-01T00:01:00.000Z",
                            .result_json = R"({"run":)" + std::to_string(run) + "}",
                            .arm_json = "{}"});
    connect_archive(plant_.url("edf"), "edf", file_)->deliver(OutboxReader(file_).next(0, 1000), {});
  }
  static std::int64_t count(const Postgres& server, const std::string& table) {
    pqxx::connection connection(server.url());
    pqxx::read_transaction read(connection);
    return read.exec1("SELECT count(*) FROM " + table)[0].as<std::int64_t>();
  }
  /// Asks until the head office has as many; false where it has not within a minute.
  bool arrives(std::int64_t wanted, const std::string& table) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    pqxx::connection connection(head_.url());
    // Who asks without a pause takes the processor from what is waited for.
    for (;;) {
      pqxx::work read(connection);
      read.exec1("SELECT pg_sleep(0.05)");
      if (read.exec1("SELECT count(*) FROM " + table)[0].as<std::int64_t>() == wanted) return true;
      if (std::chrono::steady_clock::now() > until) return false;
    }
  }

  Postgres plant_{{"wal_level=logical"}};
  // Of what it has not promised to its disk a head office that dies keeps nothing.
  Postgres head_{{"wal_writer_delay=10s"}};
  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
};

TEST_F(HeadOffice, HasWhatThePlantHadAndWhatItGets) {
  archive_a_run();
  ASSERT_EQ(set_up(), 0);
  EXPECT_TRUE(arrives(count(plant_, "event"), "event"));
  EXPECT_TRUE(arrives(count(plant_, "document"), "document"));
  archive_a_run();
  EXPECT_TRUE(arrives(6, "event"));
  EXPECT_TRUE(arrives(3, "document"));  // two results, one arm
  const ArchiveDocument look = look_at_archive(head_.url(), {.touches = false});
  EXPECT_EQ(look.cells, 1);
  EXPECT_EQ(look.events, 6);
  EXPECT_THAT(look.damage, IsEmpty());
  EXPECT_EQ(fleet_of(head_.url()).cells.at(0).last_run_id, "2");
  EXPECT_EQ(count(head_, "touch"), 0) << "they were not asked for";
}

TEST_F(HeadOffice, PassesOverADocumentThatAnotherPlantHasSent) {
  head_.sql("INSERT INTO document VALUES(encode(sha256('{}'), 'hex'), '{}')");
  ASSERT_EQ(set_up(), 0);
  archive_a_run();
  EXPECT_TRUE(arrives(3, "event"));
  archive_a_run();
  EXPECT_TRUE(arrives(6, "event")) << "nothing behind it is stopped";
  EXPECT_TRUE(arrives(3, "document"));
}

TEST_F(HeadOffice, CatchesUpAfterItWasDown) {
  ASSERT_EQ(set_up(), 0);
  archive_a_run();
  EXPECT_TRUE(arrives(3, "event"));
  head_.kill();
  archive_a_run();
  head_.start();
  EXPECT_TRUE(arrives(6, "event"));
  EXPECT_TRUE(arrives(3, "document"));
  EXPECT_THAT(look_at_archive(head_.url(), {.touches = false}).damage, IsEmpty());
}

TEST_F(HeadOffice, GetsTouchesAndCertainCellsWhereAsked) {
  ASSERT_EQ(set_up("--touches --cells another"), 0);
  archive_a_run();
  ASSERT_EQ(set_up("--touches --cells another,edf"), 0) << "asked for anew";
  archive_a_run();
  EXPECT_TRUE(arrives(1, "touch")) << "of the run since";
  EXPECT_EQ(count(head_, "event"), 3);
}

TEST_F(HeadOffice, GetsNothingOnceItIsRemoved) {
  ASSERT_EQ(set_up(), 0);
  archive_a_run();
  EXPECT_TRUE(arrives(3, "event"));
  ASSERT_EQ(set_up("--remove"), 0);
  EXPECT_EQ(plant_.sql("SELECT 1 FROM pg_replication_slots"), 0U)
      << "a slot would keep the plant's log for ever";
  EXPECT_EQ(count(head_, "event"), 3);
}

TEST_F(HeadOffice, GoesOnWhereItWasWhenItIsSetUpAgain) {
  ASSERT_EQ(set_up("--touches"), 0);
  archive_a_run();
  EXPECT_TRUE(arrives(1, "touch"));
  EXPECT_TRUE(arrives(3, "event"));
  ASSERT_EQ(set_up("--remove"), 0);
  archive_a_run();
  ASSERT_EQ(set_up("--touches"), 0);
  archive_a_run();
  EXPECT_TRUE(arrives(9, "event")) << "what is there already is passed over";
  EXPECT_TRUE(arrives(3, "touch"));
  EXPECT_TRUE(arrives(4, "document"));
  EXPECT_THAT(look_at_archive(head_.url()).damage, IsEmpty());
}

TEST_F(HeadOffice, MayBeThePlantOfCellsItself) {
  ASSERT_EQ(set_up(), 0);
  head_.sql("CREATE ROLE edf LOGIN IN ROLE touchcal_writer");
  store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:00:00.000Z"});
  const auto told = OutboxReader(file_).next(0, 1000);
  EXPECT_NO_THROW(connect_archive(head_.url("edf"), "edf", file_)->deliver(told, {}));
  EXPECT_NO_THROW(connect_archive(head_.url("edf"), "edf", file_)->deliver(told, {})) << "once more";
}

TEST_F(HeadOffice, HasAWorkerForEachPlant) {
  const Postgres small{{"max_logical_replication_workers=2"}};
  prepare_archive(small.url());
  EXPECT_EQ(set_up("", small), 4);
}

TEST_F(HeadOffice, RefusesWhatCannotWork) {
  EXPECT_EQ(set_up("--name 'a b'"), 2);
  EXPECT_EQ(set_up("--cells \"x'y\""), 2);
  EXPECT_EQ(set_up("--unknown"), 2);
  head_.sql("DROP TABLE touchcal_schema");
  EXPECT_EQ(set_up(), 4);
}

}  // namespace
}  // namespace cell
