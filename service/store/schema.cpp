#include "service/store/schema.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/spdlog.h>

#include <array>
#include <stdexcept>
#include <string>

#include "service/store/audit_chain.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/internal/owner_only.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_count.hpp"
#include "service/store/log_damage.hpp"

namespace cell {
namespace {

/// For a lock of another program as the file is opened, and for who reads; who writes waits longer
/// (LockWait).
constexpr int kBusyMilliseconds = 100;

constexpr const char* kRunsAndTouches = R"sql(
CREATE TABLE runs(
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  recipe TEXT NOT NULL,
  touches_total INTEGER NOT NULL,
  started_at TEXT NOT NULL,
  ended_at TEXT,
  outcome TEXT NOT NULL DEFAULT 'running',
  verdict TEXT NOT NULL DEFAULT 'none',
  fault_code TEXT,
  fault_message TEXT,
  result_json TEXT,
  idempotency_key TEXT UNIQUE
) STRICT;
CREATE TABLE touches(
  run_id INTEGER NOT NULL REFERENCES runs(id),
  number INTEGER NOT NULL,
  plane INTEGER NOT NULL,
  role INTEGER NOT NULL,
  j1_microdeg INTEGER NOT NULL, j2_microdeg INTEGER NOT NULL, j3_microdeg INTEGER NOT NULL,
  j4_microdeg INTEGER NOT NULL, j5_microdeg INTEGER NOT NULL, j6_microdeg INTEGER NOT NULL,
  source INTEGER NOT NULL,
  overtravel_dmm INTEGER NOT NULL,
  captured_at TEXT NOT NULL,
  PRIMARY KEY(run_id, number)
) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kPlans = R"sql(
CREATE TABLE plans(id TEXT PRIMARY KEY, document TEXT NOT NULL) STRICT;
ALTER TABLE runs ADD COLUMN plan_id TEXT;
)sql";

/// What resuming and tracing a run need; logs of faults and commands.
constexpr const char* kDiary = R"sql(
ALTER TABLE runs ADD COLUMN operator_name TEXT;
ALTER TABLE runs ADD COLUMN block_temperature_c REAL;
ALTER TABLE runs ADD COLUMN config_digest TEXT;
ALTER TABLE runs ADD COLUMN trace_json TEXT;
ALTER TABLE touches ADD COLUMN session INTEGER NOT NULL DEFAULT 0;
ALTER TABLE touches ADD COLUMN sequence INTEGER NOT NULL DEFAULT 0;
ALTER TABLE touches ADD COLUMN aimed_with INTEGER NOT NULL DEFAULT 0;
CREATE TABLE superseded_touches(
  id INTEGER PRIMARY KEY,
  run_id INTEGER NOT NULL REFERENCES runs(id),
  number INTEGER NOT NULL,
  plane INTEGER NOT NULL,
  role INTEGER NOT NULL,
  j1_microdeg INTEGER NOT NULL, j2_microdeg INTEGER NOT NULL, j3_microdeg INTEGER NOT NULL,
  j4_microdeg INTEGER NOT NULL, j5_microdeg INTEGER NOT NULL, j6_microdeg INTEGER NOT NULL,
  source INTEGER NOT NULL,
  overtravel_dmm INTEGER NOT NULL,
  captured_at TEXT NOT NULL,
  session INTEGER NOT NULL,
  sequence INTEGER NOT NULL,
  aimed_with INTEGER NOT NULL,
  reason TEXT NOT NULL
) STRICT;
CREATE INDEX superseded_touches_of_run ON superseded_touches(run_id);
CREATE TABLE reference_touches(
  run_id INTEGER NOT NULL REFERENCES runs(id),
  number INTEGER NOT NULL,
  touches_done INTEGER NOT NULL,
  j1_microdeg INTEGER NOT NULL, j2_microdeg INTEGER NOT NULL, j3_microdeg INTEGER NOT NULL,
  j4_microdeg INTEGER NOT NULL, j5_microdeg INTEGER NOT NULL, j6_microdeg INTEGER NOT NULL,
  drift_mm REAL,
  captured_at TEXT NOT NULL,
  PRIMARY KEY(run_id, number)
) STRICT, WITHOUT ROWID;
CREATE TABLE open_commands(
  run_id INTEGER PRIMARY KEY REFERENCES runs(id),
  session INTEGER NOT NULL,
  sequence INTEGER NOT NULL,
  aimed_with INTEGER NOT NULL,
  touch_json TEXT NOT NULL
) STRICT;
CREATE TABLE plan_changes(
  id INTEGER PRIMARY KEY,
  run_id INTEGER NOT NULL REFERENCES runs(id),
  kind TEXT NOT NULL,
  place INTEGER NOT NULL
) STRICT;
CREATE INDEX plan_changes_of_run ON plan_changes(run_id);
CREATE TABLE resumptions(
  id INTEGER PRIMARY KEY,
  run_id INTEGER NOT NULL REFERENCES runs(id),
  at TEXT NOT NULL,
  touches_done INTEGER NOT NULL
) STRICT;
CREATE INDEX resumptions_of_run ON resumptions(run_id);
CREATE TABLE faults(
  id INTEGER PRIMARY KEY,
  run_id INTEGER REFERENCES runs(id),
  at TEXT NOT NULL,
  code TEXT NOT NULL,
  message TEXT NOT NULL
) STRICT;
CREATE INDEX faults_of_run ON faults(run_id);
CREATE TABLE audit(
  id INTEGER PRIMARY KEY,
  at TEXT NOT NULL,
  who TEXT NOT NULL,
  remote TEXT NOT NULL,
  action TEXT NOT NULL,
  outcome TEXT NOT NULL,
  detail TEXT NOT NULL
) STRICT;
CREATE TABLE answers(
  key TEXT PRIMARY KEY,
  request TEXT NOT NULL,
  body_digest TEXT NOT NULL,
  status INTEGER NOT NULL,
  headers_json TEXT NOT NULL,
  body BLOB NOT NULL,
  at TEXT NOT NULL
) STRICT, WITHOUT ROWID;
)sql";

/// What else is known of the temperature that a run was started with.
constexpr const char* kTemperatures = R"sql(
ALTER TABLE runs ADD COLUMN std_block_temperature_k REAL;
ALTER TABLE runs ADD COLUMN block_temperature_at TEXT;
ALTER TABLE runs ADD COLUMN block_temperature_source TEXT;
)sql";

/// Whether the compliance is estimated, where a run was started with a choice of its own.
constexpr const char* kStiffness = "ALTER TABLE runs ADD COLUMN stiffness TEXT;";

/// A checksum for each row that a run rests on (filled in by fill_checksums()), what a run that ended had of
/// them, and the arm that it gave.
constexpr const char* kChecksums = R"sql(
ALTER TABLE touches ADD COLUMN checksum INTEGER;
ALTER TABLE superseded_touches ADD COLUMN checksum INTEGER;
ALTER TABLE reference_touches ADD COLUMN checksum INTEGER;
ALTER TABLE plan_changes ADD COLUMN checksum INTEGER;
ALTER TABLE open_commands ADD COLUMN checksum INTEGER;
ALTER TABLE plans ADD COLUMN checksum INTEGER;
ALTER TABLE runs ADD COLUMN checksum INTEGER;
ALTER TABLE runs ADD COLUMN result_checksum INTEGER;
ALTER TABLE runs ADD COLUMN rows_kept TEXT;
CREATE TABLE arms(
  run_id INTEGER PRIMARY KEY REFERENCES runs(id),
  document TEXT NOT NULL,
  checksum INTEGER
) STRICT;
)sql";

/// Each row of the audit has the hash of the one before with its own content: audit_chain.hpp, whose
/// kAuditChainSql is what the index is on. The rows that are there are chained by migrate().
constexpr const char* kAuditChained = R"sql(
ALTER TABLE audit ADD COLUMN operator_name TEXT NOT NULL DEFAULT '';
ALTER TABLE audit ADD COLUMN hash TEXT NOT NULL DEFAULT '';
CREATE INDEX audit_of_chain ON audit((who IN ('none', 'wrong token')), id);
CREATE TABLE audit_chains(chain INTEGER PRIMARY KEY, anchor TEXT NOT NULL, newest TEXT NOT NULL) STRICT;
)sql";

/// The noise of a touch that is not that of the cell's touches. Checksums cover it from here on:
/// reseal_touches().
constexpr const char* kTouchNoise = R"sql(
ALTER TABLE touches ADD COLUMN noise_um REAL;
ALTER TABLE superseded_touches ADD COLUMN noise_um REAL;
)sql";

/// Whose token a command came with. The hash of a row has it only where there is one.
constexpr const char* kAuditTokenNames = "ALTER TABLE audit ADD COLUMN token_name TEXT NOT NULL DEFAULT '';";

/// What else was touched at the place of a touch: the first contact of two, and a repetition that agreed.
/// Checksums cover both from here on: reseal_touches().
constexpr const char* kTouchContacts = R"sql(
ALTER TABLE touches ADD COLUMN first_source INTEGER;
ALTER TABLE touches ADD COLUMN first_j1_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN first_j2_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN first_j3_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN first_j4_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN first_j5_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN first_j6_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN again_j1_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN again_j2_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN again_j3_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN again_j4_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN again_j5_microdeg INTEGER;
ALTER TABLE touches ADD COLUMN again_j6_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN first_source INTEGER;
ALTER TABLE superseded_touches ADD COLUMN first_j1_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN first_j2_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN first_j3_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN first_j4_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN first_j5_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN first_j6_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN again_j1_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN again_j2_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN again_j3_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN again_j4_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN again_j5_microdeg INTEGER;
ALTER TABLE superseded_touches ADD COLUMN again_j6_microdeg INTEGER;
)sql";

/// The models of the cell, as approvals and rollbacks behind each other: model_store.hpp. `chained` is the
/// hash of the row before with this one's content.
constexpr const char* kModelTable = R"sql(
CREATE TABLE models(
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  kind TEXT NOT NULL,
  run_id INTEGER NOT NULL REFERENCES runs(id),
  at TEXT NOT NULL,
  operator_name TEXT,
  hash TEXT NOT NULL,
  valid_until TEXT,
  document TEXT,
  arm TEXT,
  chained TEXT NOT NULL,
  checksum INTEGER
) STRICT;
)sql";

/// Checksums for what else is kept of runs and requests (seal_logs()); how many rows the tables have whose
/// oldest rows are deleted (row_count.hpp); and where contacts were that count for nothing
/// (refused_result.hpp).
constexpr const char* kLogChecksums = R"sql(
ALTER TABLE faults ADD COLUMN checksum INTEGER;
ALTER TABLE resumptions ADD COLUMN checksum INTEGER;
ALTER TABLE answers ADD COLUMN checksum INTEGER;
CREATE TABLE row_counts(name TEXT PRIMARY KEY, row_count INTEGER NOT NULL, checksum INTEGER) STRICT, WITHOUT ROWID;
CREATE TABLE refused_results(
  id INTEGER PRIMARY KEY,
  run_id INTEGER NOT NULL REFERENCES runs(id),
  session INTEGER NOT NULL,
  sequence INTEGER NOT NULL,
  j1_microdeg INTEGER NOT NULL, j2_microdeg INTEGER NOT NULL, j3_microdeg INTEGER NOT NULL,
  j4_microdeg INTEGER NOT NULL, j5_microdeg INTEGER NOT NULL, j6_microdeg INTEGER NOT NULL,
  reason TEXT NOT NULL,
  at TEXT NOT NULL,
  checksum INTEGER
) STRICT;
CREATE INDEX refused_results_of_run ON refused_results(run_id);
)sql";

/// What others must hear of, how far each of them has heard, and which expiry was told of: outbox.hpp.
constexpr const char* kOutboxTables = R"sql(
CREATE TABLE outbox(
  seq INTEGER PRIMARY KEY AUTOINCREMENT,
  instance INTEGER NOT NULL,
  kind TEXT NOT NULL,
  at TEXT NOT NULL,
  run_id INTEGER,
  previous TEXT NOT NULL,
  body TEXT NOT NULL,
  sha256 TEXT NOT NULL
) STRICT;
CREATE TABLE outbox_state(id INTEGER PRIMARY KEY CHECK(id = 1), instance INTEGER NOT NULL, newest TEXT NOT NULL) STRICT;
INSERT INTO outbox_state VALUES(1, 0, '');
CREATE TABLE delivered(sink TEXT PRIMARY KEY, seq INTEGER NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE told_certificates(
  artefact TEXT NOT NULL, valid_until TEXT NOT NULL, PRIMARY KEY(artefact, valid_until)
) STRICT, WITHOUT ROWID;
)sql";

/// Whether a run calibrates, or proves or checks an earlier one. Checksums cover both from here on:
/// reseal_runs().
constexpr const char* kRunKindColumns = R"sql(
ALTER TABLE runs ADD COLUMN kind TEXT NOT NULL DEFAULT 'calibration';
ALTER TABLE runs ADD COLUMN of_run INTEGER;
CREATE INDEX runs_of_run ON runs(of_run, kind);
)sql";

/// Where the runs are from that other daemons made: run_copy.hpp.
constexpr const char* kImportTable = R"sql(
CREATE TABLE imported_runs(
  run_id INTEGER PRIMARY KEY REFERENCES runs(id),
  cell TEXT NOT NULL,
  origin_run INTEGER NOT NULL,
  exported_at TEXT NOT NULL,
  imported_at TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  origin_checksum INTEGER
) STRICT;
)sql";

/// From here on the table of models has rows of the kind `applied`, which an older daemon would take for
/// approvals: it must not open the file.
constexpr const char* kApplications = "SELECT 1";

/// Which facts a run has, where a million others wait too: delete_runs_before().
constexpr const char* kOutboxRunIndex =
    "CREATE INDEX outbox_of_run ON outbox(run_id) WHERE run_id IS NOT NULL";

constexpr std::array kMigrations{
    kRunsAndTouches, kPlans,          kDiary,           kTemperatures,  kStiffness,     kChecksums,
    kAuditChained,   kTouchNoise,     kAuditTokenNames, kTouchContacts, kModelTable,    kLogChecksums,
    kOutboxTables,   kRunKindColumns, kImportTable,     kApplications,  kOutboxRunIndex};

/// Overwriting allocated blocks of the log takes a third of the time of appending: the log is preallocated
/// for a run of some hundred touches. If that fails, commits are slower, and nothing else.
void preallocate_log(SQLite::Database& database) {
  try {
    database.exec("CREATE TABLE IF NOT EXISTS room(bytes BLOB)");
    database.exec("INSERT INTO room VALUES(zeroblob(3000000))");
    database.exec("DROP TABLE room");
  } catch (const SQLite::Exception&) {
  }
}

void migrate(SQLite::Database& database, const std::filesystem::path& file) {
  const auto newest = static_cast<int>(kMigrations.size());
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  if (version > newest) {
    throw std::runtime_error(file.string() + " was written by a newer touchcald (schema " +
                             std::to_string(version) + ", this one knows " + std::to_string(newest) +
                             "); install that version or give another --state");
  }
  if (version == newest) return;
  SQLite::Transaction transaction(database);
  for (int next = version; next < newest; ++next) {
    const char* migration = kMigrations[static_cast<std::size_t>(next)];
    database.exec(migration);
    if (migration == kChecksums) row::fill_checksums(database, kChecksumSchema);
    if (migration == kAuditChained) chain_audit_rows(database);
    if (migration == kTouchNoise) row::reseal_touches(database, kTouchNoiseSchema);
    if (migration == kTouchContacts) row::reseal_touches(database, kTouchContactsSchema);
    if (migration == kLogChecksums) {
      row::seal_logs(database);
      row::begin_row_counts(database);
    }
    if (migration == kRunKindColumns) row::reseal_runs(database);
  }
  database.exec("PRAGMA user_version = " + std::to_string(newest));
  transaction.commit();
}

/// What is written into a damaged tree may be lost, and what is read from it missing.
void refuse_damaged_pages(SQLite::Database& database, const std::filesystem::path& file) {
  const std::string found = database.execAndGet("PRAGMA quick_check(1)").getString();
  if (found != "ok") throw DamagedStore(file, "its pages", found);
}

}  // namespace

std::span<const char* const> migrations() { return kMigrations; }

SharedDatabase open_database(const std::filesystem::path& file) try {
  // The next commit would overwrite what shows it.
  if (const auto lost = find_log_damage(file))
    spdlog::error(
        "{}: touches, commands or the end of a run may be missing; look at the newest run, and restore the "
        "last "
        "backup where the disk is not to be trusted",
        *lost);
  auto database =
      std::make_shared<SQLite::Database>(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  keep_for_owner_only(file);
  database->setBusyTimeout(kBusyMilliseconds);
  database->exec("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON;");
  // RunStore::begin_run() restarts the log before it grows beyond what a run writes.
  database->exec("PRAGMA wal_autocheckpoint = 4000");
  row::add_checksum_function(*database);
  refuse_damaged_pages(*database, file);
  migrate(*database, file);
  preallocate_log(*database);
  return database;
} catch (const SQLite::Exception& error) {
  throw std::runtime_error(file.string() + ": " + error.what() + "; repair the file or give another --state");
}

SharedDatabase open_database_to_read(const std::filesystem::path& file) try {
  // Not OPEN_READONLY: a reader of a WAL file takes part in its index.
  auto database = std::make_shared<SQLite::Database>(file.string(), SQLite::OPEN_READWRITE);
  database->setBusyTimeout(kBusyMilliseconds);
  database->exec("PRAGMA query_only = ON");
  row::add_checksum_function(*database);
  return database;
} catch (const SQLite::Exception& error) {
  throw std::runtime_error(file.string() + ": " + error.what());
}

}  // namespace cell
