#pragma once

#include <gmock/gmock.h>

#include <pqxx/pqxx>

#include "service/archive/archive_schema.hpp"
#include "service/archive/archive_sink.hpp"
#include "service/store/run_store.hpp"
#include "tests/service/archive/postgres.hpp"

namespace cell {

/// So many touches of a run that has begun.
inline void touch(RunStore& store, std::int64_t run, int touches) {
  for (int number = 1; number <= touches; ++number)
    store.append_touch(run, {.number = number,
                             .plane = 1,
                             .joints = {number, -2, 3, 4, 5, 6},
                             .captured_at = "2026-01-01T00:00:01.000Z"});
}

/// One database for all tests, each with tables of its own.
class ArchiveTest : public ::testing::Test {
 protected:
  static Postgres& server() {
    static Postgres postgres;
    return postgres;
  }
  ArchiveTest() {
    sql("DROP TABLE IF EXISTS touchcal_schema, event, document, touch CASCADE");
    sql("DO $$ BEGIN IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'touchcal_writer') THEN CREATE ROLE "
        "touchcal_writer NOLOGIN; END IF; IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'edf') THEN "
        "CREATE "
        "ROLE edf LOGIN IN ROLE touchcal_writer; END IF; END $$");
    prepare_archive(owner_);
  }
  static std::size_t sql(const std::string& text) { return server().sql(text); }
  std::string value(const std::string& query) {
    pqxx::connection connection(owner_);
    pqxx::work work(connection);
    return work.exec1(query)[0].as<std::string>();
  }
  static void run_of(RunStore& store, const std::string& recipe = "edf-25", int touches = 3) {
    const std::int64_t run = store.begin_run({.recipe = recipe, .started_at = "2026-01-01T00:00:00.000Z"});
    touch(store, run, touches);
    store.finish_run(run, {.outcome = RunOutcome::kComplete,
                           .verdict = Verdict::kAccepted,
                           .ended_at = "2026-01-01T00:01:00.000Z",
                           .result_json = R"({"a":"ä"})",
                           .arm_json = R"({"b":2})"});
  }
  std::unique_ptr<Sink> connect(const std::string& cell = "edf") {
    return connect_archive(writer_, cell, file_);
  }
  std::vector<Fact> facts() { return OutboxReader(file_).next(0, 1000); }

  std::string owner_ = server().url(), writer_ = server().url("edf");
  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
};

}  // namespace cell
