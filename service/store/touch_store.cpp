#include "service/store/touch_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <stdexcept>

namespace cell {
namespace {

constexpr int kSchemaVersion = 2;

/// A longer wait for another reader would starve the heartbeat.
constexpr int kBusyMilliseconds = 100;

constexpr const char* kSchema = R"sql(
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

/// What version 2 adds.
constexpr const char* kPlansSchema = R"sql(
CREATE TABLE plans(id TEXT PRIMARY KEY, document TEXT NOT NULL) STRICT;
ALTER TABLE runs ADD COLUMN plan_id TEXT;
)sql";

constexpr const char* kRunColumns =
    "SELECT id, recipe, touches_total, started_at, ended_at, outcome, verdict, fault_code, fault_message, "
    "(SELECT count(*) FROM touches WHERE run_id = runs.id) FROM runs ";

/// Blocks that the log has already are written in a third of the time of new ones: it is made as long as a
/// run of some hundred touches needs. Where that fails commits are slower, and nothing else.
void make_room_in_log(SQLite::Database& database) {
  try {
    database.exec("CREATE TABLE IF NOT EXISTS room(bytes BLOB)");
    database.exec("INSERT INTO room VALUES(zeroblob(3000000))");
    database.exec("DROP TABLE room");
  } catch (const SQLite::Exception&) {
  }
}

/// The log begins anew, so that no touch of a run finds it full. A reader may prevent it: then it grows.
void empty_log(SQLite::Database& database) { database.tryExec("PRAGMA wal_checkpoint(RESTART)"); }

std::optional<std::string> text_or_nothing(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getString());
}

StoredRun read_run(SQLite::Statement& row) {
  return {.id = row.getColumn(0).getInt64(),
          .recipe = row.getColumn(1).getString(),
          .touches_total = row.getColumn(2).getInt(),
          .touches_done = row.getColumn(9).getInt(),
          .started_at = row.getColumn(3).getString(),
          .ended_at = text_or_nothing(row.getColumn(4)),
          .outcome = row.getColumn(5).getString(),
          .verdict = row.getColumn(6).getString(),
          .fault_code = text_or_nothing(row.getColumn(7)),
          .fault_message = text_or_nothing(row.getColumn(8))};
}

std::optional<StoredRun> first_run(SQLite::Statement& query) {
  if (!query.executeStep()) return std::nullopt;
  return read_run(query);
}

void bind_or_null(SQLite::Statement& statement, int index, const std::optional<std::string>& text) {
  if (text) {
    statement.bind(index, *text);
  } else {
    statement.bind(index);
  }
}

}  // namespace

TouchStore::TouchStore(const std::filesystem::path& file) try
    : database_(
          std::make_unique<SQLite::Database>(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)) {
  database_->setBusyTimeout(kBusyMilliseconds);
  database_->exec("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON;");
  // Before the log takes more than a run writes, begin_run() empties it.
  database_->exec("PRAGMA wal_autocheckpoint = 4000");
  const int version = database_->execAndGet("PRAGMA user_version").getInt();
  if (version > kSchemaVersion) {
    throw std::runtime_error(file.string() + " was written by a newer touchcald (schema " +
                             std::to_string(version) + ", this one knows " + std::to_string(kSchemaVersion) +
                             "); install that version or give another --state");
  }
  if (version < kSchemaVersion) {
    SQLite::Transaction transaction(*database_);
    if (version < 1) database_->exec(kSchema);
    database_->exec(kPlansSchema);
    database_->exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
    transaction.commit();
  }
  make_room_in_log(*database_);
} catch (const SQLite::Exception& error) {
  throw std::runtime_error(file.string() + ": " + error.what() + "; mend the file or give another --state");
}

TouchStore::~TouchStore() = default;

std::int64_t TouchStore::begin_run(const NewRun& run) {
  SQLite::Statement insert(
      *database_, "INSERT INTO runs(recipe, touches_total, started_at, idempotency_key) VALUES(?, ?, ?, ?)");
  insert.bind(1, run.recipe);
  insert.bind(2, run.touches_total);
  insert.bind(3, run.started_at);
  bind_or_null(insert, 4, run.idempotency_key);
  insert.exec();
  empty_log(*database_);
  return database_->getLastInsertRowid();
}

void TouchStore::set_plan(std::int64_t run_id, int touches_total, const std::string& plan_id,
                          const std::string& document) {
  SQLite::Transaction transaction(*database_);
  SQLite::Statement insert(*database_, "INSERT OR IGNORE INTO plans(id, document) VALUES(?, ?)");
  insert.bind(1, plan_id);
  insert.bind(2, document);
  insert.exec();
  SQLite::Statement update(*database_, "UPDATE runs SET touches_total = ?, plan_id = ? WHERE id = ?");
  update.bind(1, touches_total);
  update.bind(2, plan_id);
  update.bind(3, run_id);
  update.exec();
  transaction.commit();
}

void TouchStore::set_touches_total(std::int64_t run_id, int touches_total) {
  SQLite::Statement update(*database_, "UPDATE runs SET touches_total = ? WHERE id = ?");
  update.bind(1, touches_total);
  update.bind(2, run_id);
  update.exec();
}

void TouchStore::append_touch(std::int64_t run_id, const StoredTouch& touch) {
  SQLite::Statement insert(*database_, "INSERT INTO touches VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  int index = 0;
  insert.bind(++index, run_id);
  insert.bind(++index, touch.number);
  insert.bind(++index, touch.plane);
  insert.bind(++index, static_cast<int>(touch.role));
  for (const std::int32_t joint : touch.joints) insert.bind(++index, joint);
  insert.bind(++index, static_cast<int>(touch.source));
  insert.bind(++index, touch.overtravel_dmm);
  insert.bind(++index, touch.captured_at);
  insert.exec();
}

void TouchStore::finish_run(std::int64_t run_id, const RunEnd& end) {
  SQLite::Statement update(*database_,
                           "UPDATE runs SET outcome = ?, verdict = ?, ended_at = ?, fault_code = ?, "
                           "fault_message = ?, result_json = ? WHERE id = ?");
  update.bind(1, end.outcome);
  update.bind(2, end.verdict);
  update.bind(3, end.ended_at);
  bind_or_null(update, 4, end.fault_code);
  bind_or_null(update, 5, end.fault_message);
  bind_or_null(update, 6, end.result_json);
  update.bind(7, run_id);
  update.exec();
}

void TouchStore::set_result_json(std::int64_t run_id, const std::string& result_json) {
  SQLite::Statement update(*database_, "UPDATE runs SET result_json = ? WHERE id = ?");
  update.bind(1, result_json);
  update.bind(2, run_id);
  update.exec();
}

int TouchStore::finish_interrupted(const std::string& now) {
  SQLite::Statement update(*database_,
                           "UPDATE runs SET outcome = 'interrupted', verdict = 'incomplete', ended_at = ? "
                           "WHERE outcome = 'running'");
  update.bind(1, now);
  return update.exec();
}

std::vector<StoredRun> TouchStore::runs(int limit, std::optional<std::int64_t> before_id) const {
  SQLite::Statement query(*database_, std::string(kRunColumns) + "WHERE id < ? ORDER BY id DESC LIMIT ?");
  query.bind(1, before_id.value_or(INT64_MAX));
  query.bind(2, limit);
  std::vector<StoredRun> found;
  while (query.executeStep()) found.push_back(read_run(query));
  return found;
}

std::optional<StoredRun> TouchStore::run(std::int64_t id) const {
  SQLite::Statement query(*database_, std::string(kRunColumns) + "WHERE id = ?");
  query.bind(1, id);
  return first_run(query);
}

std::optional<StoredRun> TouchStore::run_with_key(const std::string& idempotency_key) const {
  SQLite::Statement query(*database_, std::string(kRunColumns) + "WHERE idempotency_key = ?");
  query.bind(1, idempotency_key);
  return first_run(query);
}

std::optional<StoredRun> TouchStore::last_accepted() const {
  SQLite::Statement query(*database_,
                          std::string(kRunColumns) + "WHERE verdict = 'accepted' ORDER BY id DESC LIMIT 1");
  return first_run(query);
}

std::vector<StoredTouch> TouchStore::touches(std::int64_t run_id) const {
  SQLite::Statement query(*database_,
                          "SELECT number, plane, role, j1_microdeg, j2_microdeg, j3_microdeg, j4_microdeg, "
                          "j5_microdeg, j6_microdeg, source, overtravel_dmm, captured_at FROM touches "
                          "WHERE run_id = ? ORDER BY number");
  query.bind(1, run_id);
  std::vector<StoredTouch> found;
  while (query.executeStep()) {
    StoredTouch touch{.number = query.getColumn(0).getInt(),
                      .plane = query.getColumn(1).getInt(),
                      .role = static_cast<calib::TouchRole>(query.getColumn(2).getInt()),
                      .source = static_cast<cs8::CaptureSource>(query.getColumn(9).getInt()),
                      .overtravel_dmm = query.getColumn(10).getInt(),
                      .captured_at = query.getColumn(11).getString()};
    for (std::size_t i = 0; i < touch.joints.size(); ++i)
      touch.joints[i] = query.getColumn(static_cast<int>(3 + i)).getInt();
    found.push_back(touch);
  }
  return found;
}

std::optional<std::string> TouchStore::result_json(std::int64_t run_id) const {
  SQLite::Statement query(*database_, "SELECT result_json FROM runs WHERE id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return std::nullopt;
  return text_or_nothing(query.getColumn(0));
}

std::optional<std::string> TouchStore::plan_json(std::int64_t run_id) const {
  SQLite::Statement query(
      *database_, "SELECT plans.document FROM runs JOIN plans ON plans.id = runs.plan_id WHERE runs.id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return std::nullopt;
  return text_or_nothing(query.getColumn(0));
}

}  // namespace cell
