#include "service/store/schema.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "service/store/answer_store.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_count.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

/// A file as a touchcald of that schema left it: a run of two touches that ended, one that was running.
std::filesystem::path file_of_version(const Folder& folder, int version) {
  const std::filesystem::path file = folder.path() / ("version" + std::to_string(version) + ".sqlite");
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  for (int i = 0; i < version; ++i) database.exec(migrations()[static_cast<std::size_t>(i)]);
  database.exec(R"sql(
    INSERT INTO runs(recipe, touches_total, started_at, ended_at, outcome, verdict, result_json)
      VALUES('edf-25', 140, 'began', 'ended', 'complete', 'accepted', '{"a":1}');
    INSERT INTO runs(recipe, touches_total, started_at, idempotency_key) VALUES('quick', 40, 'later', 'key');
    INSERT INTO touches(run_id, number, plane, role, j1_microdeg, j2_microdeg, j3_microdeg, j4_microdeg,
      j5_microdeg, j6_microdeg, source, overtravel_dmm, captured_at)
      VALUES(1, 1, 3, 1, -1, 2, -3, 4, -5, 6, 1, 7, 'then'), (1, 2, 4, 0, 1, 2, 3, 4, 5, 6, 0, 0, 'then');
  )sql");
  if (version >= 2) {
    database.exec(
        "INSERT INTO plans(id, document) VALUES('plan', '{}'); UPDATE runs SET plan_id = 'plan' WHERE recipe "
        "= 'quick'");
  }
  if (version >= 3) database.exec("UPDATE runs SET block_temperature_c = 21.5 WHERE id = 1");
  if (version >= 3) {
    database.exec(
        "INSERT INTO faults(run_id, at, code, message) VALUES(1, 'then', 'no_contact', 'early'), (NULL, "
        "'then', 'link_lost', 'late'); INSERT INTO resumptions(run_id, at, touches_done) VALUES(1, 'then', "
        "1); INSERT INTO answers(key, request, body_digest, status, headers_json, body, at) VALUES('key', "
        "'POST /', '', 200, '[]', x'7b7d', 'then')");
  }
  if (version >= static_cast<int>(kChecksumSchema)) {
    row::add_checksum_function(database);
    if (version >= static_cast<int>(kLogChecksumSchema)) row::begin_row_counts(database);
    row::fill_checksums(database, static_cast<std::size_t>(version));
  }
  database.exec("PRAGMA user_version = " + std::to_string(version));
  return file;
}

/// All that makes a schema: what each table has.
std::string shape(const std::filesystem::path& file) {
  SQLite::Database database(file.string());
  SQLite::Statement columns(
      database,
      "SELECT tables.name, columns.name, columns.type, columns.\"notnull\", pk FROM sqlite_schema AS "
      "tables JOIN pragma_table_info(tables.name) AS columns ORDER BY 1, cid");
  std::string text;
  while (columns.executeStep()) {
    for (int i = 0; i < columns.getColumnCount(); ++i) text += columns.getColumn(i).getString() + " ";
    text += "\n";
  }
  return text;
}

class StoreSchema : public ::testing::TestWithParam<int> {};

TEST_P(StoreSchema, AFileOfAnEarlierVersionIsTakenOverWithAllThatIsInIt) {
  const Folder folder;
  const auto file = file_of_version(folder, GetParam());
  RunStore store(file);
  const std::vector<StoredTouch> touches = store.touches(1);
  ASSERT_EQ(touches.size(), 2u);
  EXPECT_EQ(touches[0].plane, 3);
  EXPECT_EQ(touches[0].role, calib::TouchRole::kHeldOut);
  EXPECT_EQ(touches[0].joints, (cs8::JointsMicrodeg{-1, 2, -3, 4, -5, 6}));
  EXPECT_EQ(touches[0].overtravel_dmm, 7);
  EXPECT_EQ(touches[0].sequence, 0u);
  EXPECT_FALSE(touches[0].noise_um || touches[0].first || touches[0].again);
  EXPECT_THAT(find_damage(file), ::testing::IsEmpty());
  EXPECT_EQ(store.result_json(1), "{\"a\":1}");
  EXPECT_EQ(store.last_accepted()->id, 1);
  EXPECT_EQ(store.run_with_key("key")->id, 2);
  EXPECT_EQ(store.running()->id, 2);
  EXPECT_EQ(store.plan_json(2).has_value(), GetParam() >= 2);
  EXPECT_EQ(store.run(1)->block_temperature,
            GetParam() >= 3 ? std::optional(StoredTemperature{.celsius = 21.5}) : std::nullopt);
  EXPECT_FALSE(store.open_command(2) || store.run(2)->operator_name);
  store.append_touch(2, {.number = 1, .plane = 1, .captured_at = "now", .session = 4, .sequence = 5});
  EXPECT_EQ(store.touches(2).at(0).session, 4u);
}

TEST_P(StoreSchema, AFileOfAnEarlierVersionGetsTheShapeOfANewOne) {
  const Folder folder;
  const auto old = file_of_version(folder, GetParam()), fresh = folder.path() / "fresh.sqlite";
  open_database(old);
  open_database(fresh);
  EXPECT_EQ(shape(old), shape(fresh));
}

INSTANTIATE_TEST_SUITE_P(Versions, StoreSchema, ::testing::Range(1, static_cast<int>(migrations().size())));

class ResealedTouches : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ResealedTouches, ATouchThatWasDamagedBeforeItsChecksumCoversMoreStaysKnownAsDamaged) {
  const Folder folder;
  const auto file = file_of_version(folder, static_cast<int>(GetParam()) - 1);
  EXPECT_THAT(find_damage(file), ::testing::IsEmpty()) << "of a file of that schema";
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE touches SET plane = 2 WHERE run_id = 1 AND number = 2");
  const auto damaged = ::testing::ElementsAre(::testing::HasSubstr("table touches, run 1, number 2"));
  EXPECT_THAT(find_damage(file), damaged);
  const RunStore store(file);
  EXPECT_THAT(find_damage(file), damaged);
  EXPECT_THROW(static_cast<void>(store.touches(1)), DamagedStore);
}

TEST(SealedLogs, ARunThatWasDamagedOrLackedRowsBeforeStaysKnownAsSuch) {
  for (const char* tampered :
       {"UPDATE runs SET recipe = 'other' WHERE id = 1", "DELETE FROM touches WHERE number = 2"}) {
    const Folder folder;
    const auto file = file_of_version(folder, static_cast<int>(kLogChecksumSchema) - 1);
    SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec(tampered);
    const RunStore store(file);
    EXPECT_THROW(static_cast<void>(store.run(1)), DamagedStore) << tampered;
    EXPECT_THAT(find_damage(file), ::testing::Contains(::testing::HasSubstr("run 1"))) << tampered;
  }
}

TEST(SealedLogs, FaultsAndAnswersOfAnEarlierVersionAreSealedAndCounted) {
  const Folder folder;
  const auto file = file_of_version(folder, static_cast<int>(kLogChecksumSchema) - 1);
  const RunStore store(file);
  EXPECT_EQ(FaultLog(store.database()).page(10).size(), 2u);
  AnswerStore answers(store.database());
  EXPECT_TRUE(std::holds_alternative<StoredAnswer>(answers.take({"key", "POST /", ""}, "a")));
  EXPECT_THAT(find_damage(file), ::testing::IsEmpty());
  store.database()->exec("DELETE FROM faults WHERE id = 1");
  EXPECT_THAT(find_damage(file), ::testing::ElementsAre(::testing::HasSubstr("table faults")));
}

TEST(ResealedRuns, ARunThatWasDamagedBeforeItsChecksumCoversItsKindStaysKnownAsDamaged) {
  const Folder folder;
  const auto file = file_of_version(folder, static_cast<int>(kRunKindSchema) - 1);
  EXPECT_THAT(find_damage(file), ::testing::IsEmpty()) << "of a file of that schema";
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE runs SET recipe = 'other' WHERE id = 1");
  const RunStore store(file);
  EXPECT_THROW(static_cast<void>(store.run(1)), DamagedStore);
  EXPECT_EQ(store.run(2)->kind, RunKind::kCalibration);
  EXPECT_EQ(store.run(2)->of_run, std::nullopt);
}

TEST(ResealedRuns, TheKindOfARunAndWhoseProofItIsAreInItsChecksum) {
  for (const char* tampered : {"kind = 'calibration'", "of_run = 7", "of_run = NULL"}) {
    const Folder folder;
    RunStore store(folder.path() / "store.sqlite");
    const std::int64_t run =
        store.begin_run({.kind = RunKind::kProof, .of_run = 1, .recipe = "best", .started_at = "start"});
    store.database()->exec(std::string("UPDATE runs SET ") + tampered);
    EXPECT_THROW(static_cast<void>(store.run(run)), DamagedStore) << tampered;
  }
}

INSTANTIATE_TEST_SUITE_P(Schemas, ResealedTouches,
                         ::testing::Values(kTouchNoiseSchema, kTouchContactsSchema));

TEST(StoreSchemaFile, WhatElseWasTouchedAtAPlaceIsInTheChecksumOfItsTouch) {
  const Folder folder;
  RunStore store(folder.path() / "store.sqlite");
  const std::int64_t run = store.begin_run({.recipe = "edf-25", .touches_total = 140, .started_at = "start"});
  for (const char* tampered :
       {"first_source = 1 - first_source", "first_source = NULL", "first_j6_microdeg = 7",
        "again_j1_microdeg = 7", "again_j1_microdeg = NULL"}) {
    store.database()->exec("DELETE FROM touches");
    store.append_touch(run, {.number = 1, .plane = 1, .captured_at = "now", .first = FirstContact{}});
    store.confirm_touch(run, 1, {1, 2, 3, 4, 5, 6});
    EXPECT_NO_THROW(static_cast<void>(store.touches(run))) << tampered;
    store.database()->exec(std::string("UPDATE touches SET ") + tampered);
    EXPECT_THROW(static_cast<void>(store.touches(run)), DamagedStore) << tampered;
    EXPECT_THROW(store.confirm_touch(run, 1, {1, 2, 3, 4, 5, 6}), DamagedStore) << tampered;
  }
}

TEST(StoreSchemaFile, TheNoiseOfATouchIsInItsChecksum) {
  const Folder folder;
  const auto file = folder.path() / "store.sqlite";
  RunStore store(file);
  const std::int64_t run = store.begin_run({.recipe = "edf-25", .touches_total = 140, .started_at = "start"});
  store.append_touch(run, {.number = 1, .plane = 1, .captured_at = "now", .noise_um = 61.1});
  store.database()->exec("UPDATE touches SET noise_um = NULL");
  EXPECT_THROW(static_cast<void>(store.touches(run)), DamagedStore);
}

TEST(StoreSchemaFile, IsForItsOwnerOnlyWhateverTheMaskWithAllThatIsBesideIt) {
  using std::filesystem::perms;
  const Folder folder;
  const auto file = folder.path() / "store.sqlite";
  const std::vector<std::string> files{file.string(), file.string() + "-wal", file.string() + "-shm"};
  const auto expect_closed = [&] {
    for (const std::string& one : files)
      EXPECT_EQ(std::filesystem::status(one).permissions(), perms::owner_read | perms::owner_write) << one;
  };
  const mode_t before = ::umask(0);
  {
    RunStore store(file);
    store.begin_run({.recipe = "edf-25", .started_at = "start"});
    expect_closed();
  }
  ::umask(before);
  std::filesystem::permissions(file, perms(0644));  // as an older version left it
  RunStore store(file);
  store.begin_run({.recipe = "edf-25", .started_at = "start"});
  expect_closed();
  const auto copy = folder.path() / "copy.sqlite";
  back_up(file, copy);
  EXPECT_EQ(std::filesystem::status(copy).permissions(), perms::owner_read | perms::owner_write);
}

TEST(StoreSchemaFile, AMigrationThatFailsLeavesTheFileAsItWas) {
  const Folder folder;
  const auto file = file_of_version(folder, 1);
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec("CREATE TABLE audit(other)");
  const std::string before = shape(file);
  EXPECT_THROW(open_database(file), std::runtime_error);
  EXPECT_EQ(shape(file), before);
  EXPECT_EQ(SQLite::Database(file.string()).execAndGet("PRAGMA user_version").getInt(), 1);
}

}  // namespace
}  // namespace cell
