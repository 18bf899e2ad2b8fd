#include "service/store/maintenance.hpp"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/fmt/fmt.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "service/base/durable_file.hpp"
#include "service/base/state_directory.hpp"
#include "service/store/audit_chain.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/owner_only.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_count.hpp"
#include "service/store/internal/row_text.hpp"
#include "service/store/log_damage.hpp"
#include "service/store/model_store.hpp"
#include "service/store/outbox.hpp"

namespace cell {
namespace {

/// How long to wait for a daemon that writes.
constexpr int kReadBusyMilliseconds = 5000;

/// A file that no version has begun, or that has lost all that it had.
constexpr const char* kHoldsNothing = "it holds nothing";

/// A row of touches that no run can have made.
std::string impossible_touches() {
  std::string largest_joint = row::kJointColumns;
  for (std::size_t at = 0; (at = largest_joint.find(", ", at)) != std::string::npos; at += 7)
    largest_joint.replace(at, 2, "), abs(");
  return "SELECT run_id, number FROM touches WHERE plane < 1 OR role NOT BETWEEN 0 AND 2 OR source NOT "
         "BETWEEN 0 AND 2 OR number < 1 OR max(abs(" +
         largest_joint + ")) > 2147483648";
}

/// Rows that are not as they were written. A file of an earlier schema has no checksums yet.
void find_damaged_rows(SQLite::Database& database, std::vector<std::string>& damage) {
  row::add_checksum_function(database);
  const auto version = static_cast<std::size_t>(database.execAndGet("PRAGMA user_version").getInt());
  if (version == 0) {
    damage.emplace_back(kHoldsNothing);
    return;
  }
  const bool has_checksums =
      database.execAndGet("SELECT count(*) FROM pragma_table_info('touches') WHERE name = 'checksum'")
          .getInt() > 0;
  if (has_checksums != (version >= kChecksumSchema)) {
    damage.push_back("its tables are not those of schema " + std::to_string(version));
    return;
  }
  if (!has_checksums) return;
  for (const row::CheckedRows* rows : row::all_checked_rows(version)) {
    SQLite::Statement query(database, "SELECT " + rows->run + ", " + rows->number + " FROM " + rows->table +
                                          " WHERE NOT " + rows->is_whole());
    while (query.executeStep()) {
      const std::string run = query.getColumn(0).getString(), number = query.getColumn(1).getString();
      std::string line = "table " + rows->name;
      if (!run.empty()) line.append(", run ").append(run);
      if (!number.empty()) line.append(", number ").append(number);
      line.append(": ").append(row::kOtherChecksum);
      damage.push_back(std::move(line));
    }
  }
  SQLite::Statement lost(database, "SELECT id FROM runs WHERE NOT " + row::has_its_rows(version) +
                                       " OR (plan_id IS NOT NULL AND plan_id NOT IN (SELECT id FROM plans))");
  while (lost.executeStep())
    damage.push_back("run " + lost.getColumn(0).getString() +
                     ": touches or the plan that it had are not there");
  if (version >= kLogChecksumSchema)
    std::ranges::move(row::find_row_count_damage(database), std::back_inserter(damage));
  if (version >= kModelSchema) std::ranges::move(find_model_damage(database), std::back_inserter(damage));
  if (version >= kOutboxSchema) std::ranges::move(find_outbox_damage(database), std::back_inserter(damage));
}

SQLite::Database open_to_read(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw std::runtime_error(file.string() + ": there is no such file");
  return {file.string(), SQLite::OPEN_READONLY, kReadBusyMilliseconds};
}

std::string uri_of(const std::filesystem::path& file, std::string_view parameter) {
  std::string uri = "file:";
  for (const char byte : std::filesystem::absolute(file).string())
    uri += byte == '%' ? "%25" : byte == '?' ? "%3f" : byte == '#' ? "%23" : std::string(1, byte);
  return uri.append("?").append(parameter);
}

SQLite::Database open_by_uri(const std::filesystem::path& file, std::string_view parameter) {
  return {uri_of(file, parameter), SQLite::OPEN_READONLY | SQLite::OPEN_URI, kReadBusyMilliseconds};
}

/// Whether it holds commits that may not be in the database yet.
bool has_log(const std::filesystem::path& file) {
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(file.string() + "-wal", missing);
  return !missing && bytes > 0;
}

/// The same, also on a disk that cannot be written: a database with a log needs a file beside it.
SQLite::Database open_to_check(const std::filesystem::path& file) {
  try {
    SQLite::Database database = open_to_read(file);
    database.exec("SELECT count(*) FROM sqlite_schema");
    return database;
  } catch (const SQLite::Exception& error) {
    const int code = error.getErrorCode();
    if (code != SQLITE_CANTOPEN && code != SQLITE_READONLY) throw;
  }
  if (has_log(file)) {
    throw StoreNotChecked(file.string() +
                          ": its directory cannot be written, and its log (-wal) is not in it "
                          "yet; copy both to a writable disk and verify the copy");
  }
  return open_by_uri(file, "immutable=1");
}

StoreLogNotRead not_looked_at(const std::filesystem::path& file, std::string_view why) {
  return StoreLogNotRead(
      fmt::format("{}: not looked at: {}; touchcald --verify checks it, and may change the files beside it",
                  file.string(), why));
}

/// So that no file beside it is made or changed. Who has the log open keeps an index of it beside it, which
/// is only read here; where nobody has, SQLite makes its own in memory.
SQLite::Database open_without_trace(const std::filesystem::path& file) {
  if (!has_log(file)) return open_by_uri(file, "immutable=1");
  if (!std::filesystem::exists(file.string() + "-shm"))
    throw not_looked_at(file, "its log (-wal) is not in it yet, and reading that would make a file (-shm)");
  try {
    SQLite::Database database = open_by_uri(file, "readonly_shm=1");
    database.exec("SELECT count(*) FROM sqlite_schema");
    return database;
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() != SQLITE_CANTOPEN) throw;
    throw not_looked_at(file, error.what());
  }
}

/// A daemon that writes meanwhile, or a disk that cannot be read now, is none.
bool is_damage(const SQLite::Exception& error) {
  const int code = error.getErrorCode();
  return code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
}

/// What a newer version has written is no damage, and no backup is the remedy.
void demand_known_schema(SQLite::Database& database, const std::filesystem::path& file) {
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  if (version < 0) throw std::runtime_error("its schema has the number " + std::to_string(version));
  if (static_cast<std::size_t>(version) <= migrations().size()) return;
  throw StoreNotChecked(file.string() + ": a newer touchcald wrote it (schema " + std::to_string(version) +
                        ", this one knows " + std::to_string(migrations().size()) +
                        "); verify it with that version");
}

/// The damage of a database that is open, one line each.
void find_damage_in(SQLite::Database& database, const std::filesystem::path& file,
                    std::vector<std::string>& damage) {
  if (auto lost = find_log_damage(file)) damage.push_back(*std::move(lost));
  SQLite::Statement integrity(database, "PRAGMA integrity_check");
  while (integrity.executeStep()) {
    if (const std::string line = integrity.getColumn(0).getString(); line != "ok") damage.push_back(line);
  }
  SQLite::Statement orphans(database, "PRAGMA foreign_key_check");
  while (orphans.executeStep()) {
    damage.push_back("table " + orphans.getColumn(0).getString() + ": a row belongs to no " +
                     orphans.getColumn(2).getString());
  }
  find_damaged_rows(database, damage);
  SQLite::Statement touches(database, impossible_touches());
  while (touches.executeStep()) {
    damage.push_back("run " + touches.getColumn(0).getString() + ", touch " +
                     touches.getColumn(1).getString() + ": not a touch");
  }
  std::ranges::move(find_audit_damage(database), std::back_inserter(damage));
}

std::uintmax_t bytes_with_log(const std::filesystem::path& file) {
  std::uintmax_t sum = 0;
  for (const char* behind : {"", "-wal"}) {
    std::error_code missing;
    const auto bytes = std::filesystem::file_size(file.string() + behind, missing);
    if (!missing) sum += bytes;
  }
  return sum;
}

/// In one transaction: a daemon may write meanwhile.
StoreLook looked_at(const std::filesystem::path& file, std::uintmax_t whole_up_to) try {
  SQLite::Database database = open_without_trace(file);
  demand_known_schema(database, file);
  const SQLite::Transaction as_of_now(database);
  StoreLook look{.unusable = {}, .damage = {}, .is_whole = bytes_with_log(file) <= whole_up_to};
  const std::string found = database.execAndGet("PRAGMA quick_check(1)").getString();
  if (found != "ok") {
    look.unusable = found;
  } else if (look.is_whole) {
    find_damage_in(database, file, look.damage);
  }
  return look;
} catch (const StoreNotChecked&) {
  throw;
} catch (const SQLite::Exception& error) {
  const int code = error.getErrorCode();
  if (code == SQLITE_CANTOPEN)
    throw StoreNotChecked(file.string() + ": cannot be read by this user; make it this user's own");
  if (!is_damage(error)) throw not_looked_at(file, error.what());
  return {.unusable = error.what(), .damage = {}};
} catch (const std::exception& error) {
  return {.unusable = error.what(), .damage = {}};
}

}  // namespace

void back_up(const std::filesystem::path& database_file, const std::filesystem::path& copy) {
  const std::filesystem::path place = database_file.parent_path() / kBlockPoseFile;
  const std::filesystem::path place_copy = copy.string() + "." + std::string(kBlockPoseFile);
  for (const std::filesystem::path& file : {copy, place_copy})
    if (std::filesystem::exists(file))
      throw std::runtime_error(file.string() + ": the file exists; name a new one");
  try {
    if (std::filesystem::exists(place)) std::filesystem::copy_file(place, place_copy);
    SQLite::Database from = open_to_read(database_file);
    if (from.execAndGet("PRAGMA user_version").getInt() == 0)
      throw DamagedStore(database_file, "no backup was made", kHoldsNothing);
    SQLite::Database to(copy.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    keep_for_owner_only(copy);
    to.exec("PRAGMA synchronous = FULL");
    SQLite::Backup backup(to, from);
    backup.executeStep();  // all pages at once: a consistent snapshot
    if (backup.getRemainingPageCount() != 0) throw std::runtime_error("the database is busy; try again");
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove(copy, ignored);
    std::filesystem::remove(place_copy, ignored);
    if (dynamic_cast<const DamagedStore*>(&error)) throw;
    const auto* of_store = dynamic_cast<const SQLite::Exception*>(&error);
    if (of_store && is_damage(*of_store))
      throw DamagedStore(database_file, "no backup was made", error.what());
    throw std::runtime_error(copy.string() + ": no backup was made: " + error.what());
  }
}

void refuse_lost_store(const std::filesystem::path& state_directory) {
  const auto has = [&](std::string_view file) { return std::filesystem::exists(state_directory / file); };
  std::string shown_by;
  for (const std::string_view file : {kBegunFile, kBlockPoseFile, kLocatingFile})
    if (shown_by.empty() && has(file)) shown_by = file;
  if (shown_by.empty() && has(kOperateTokenFile) && has(kViewTokenFile)) shown_by = "both tokens";
  const std::filesystem::path database = state_directory / kStoreFile;
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(database, missing);
  if (shown_by.empty() || (!missing && bytes > 0)) return;
  throw std::runtime_error(
      database.string() + (missing ? ": is missing" : ": is empty") +
      ", and its state directory was in use (" + shown_by +
      " there shows it); restore the last backup to it, or give another --state to begin "
      "without the earlier runs");
}

void mark_begun(const std::filesystem::path& state_directory) {
  const std::filesystem::path marker = state_directory / kBegunFile;
  if (std::filesystem::exists(marker)) return;
  replace_file(marker,
               fmt::format("{} was begun here. While this file is there, touchcald does not begin anew "
                           "where that one is lost.\n",
                           kStoreFile));
}

std::vector<std::string> find_damage(const std::filesystem::path& database_file) {
  std::vector<std::string> damage;
  try {
    SQLite::Database database = open_to_check(database_file);
    demand_known_schema(database, database_file);
    find_damage_in(database, database_file, damage);
  } catch (const StoreNotChecked&) {
    throw;
  } catch (const std::exception& error) {
    damage.emplace_back(error.what());
  }
  return damage;
}

StoreLook look_without_trace(const std::filesystem::path& database_file, std::uintmax_t whole_up_to) {
  const bool had_log = has_log(database_file);
  StoreLook look = looked_at(database_file, whole_up_to);
  // Without a log it is read as if nobody wrote, and a daemon may have begun to.
  if ((look.unusable || !look.damage.empty()) && !had_log && has_log(database_file))
    throw not_looked_at(database_file, "it was written to meanwhile");
  return look;
}

std::optional<std::uintmax_t> disk_room_bytes(const SharedDatabase& database) {
  std::error_code unknown;
  const auto space =
      std::filesystem::space(std::filesystem::path(database->getFilename()).parent_path(), unknown);
  return unknown ? std::nullopt : std::optional(space.available);
}

int delete_runs_before(const SharedDatabase& database, const std::string& oldest, int days_that_agree,
                       const std::vector<std::string>& sinks) {
  constexpr std::array kOfRuns{"touches",      "superseded_touches", "reference_touches", "open_commands",
                               "plan_changes", "resumptions",        "refused_results",   "arms",
                               "imported_runs"};
  row::WriteTransaction transaction(*database);
  // What a model rests on: each that was approved, and the calibration that a proof or a check is of now.
  const std::string kept =
      "(SELECT run_id FROM models UNION SELECT max(id) FROM runs WHERE verdict = ?3 AND kind = 'calibration' "
      "AND " +
      std::string(row::kOfThisDaemon) + ")";
  SQLite::Statement choose(
      *database,
      "CREATE TEMP TABLE old_runs AS SELECT id FROM runs WHERE started_at < ?1 AND outcome <> ?2 AND id NOT "
      "IN "
      "(SELECT run_id FROM imported_runs WHERE imported_at >= ?1) AND id NOT IN (SELECT id FROM runs ORDER "
      "BY "
      "id DESC LIMIT ?4) AND NOT EXISTS (SELECT 1 FROM outbox WHERE run_id = runs.id AND seq > ?5) AND "
      "?6 <= (SELECT count(DISTINCT substr(started_at, 1, 10)) FROM runs WHERE started_at >= ?1) AND "
      "id NOT IN (SELECT * FROM " +
          kept + " WHERE run_id IS NOT NULL) AND (of_run IS NULL OR of_run NOT IN (SELECT * FROM " + kept +
          " WHERE run_id IS NOT NULL))");
  choose.bind(1, oldest);
  choose.bind(2, std::string(run_outcome_name(RunOutcome::kRunning)));
  choose.bind(3, std::string(verdict_name(Verdict::kAccepted)));
  choose.bind(4, kLastRunsKept);
  choose.bind(5, confirmed_by_all(*database, sinks));
  choose.bind(6, days_that_agree);
  choose.exec();
  for (const std::string table : kOfRuns)
    database->exec("DELETE FROM " + table + " WHERE run_id IN (SELECT id FROM old_runs)");
  const int faults = database->exec("DELETE FROM faults WHERE run_id IN (SELECT id FROM old_runs)");
  row::change_row_count(*database, row::CountedTable::kFaults, -faults);
  const int deleted = database->exec("DELETE FROM runs WHERE id IN (SELECT id FROM old_runs)");
  database->exec(
      "DELETE FROM plans WHERE id NOT IN (SELECT plan_id FROM runs WHERE plan_id IS NOT NULL); DROP TABLE "
      "old_runs");
  transaction.commit();
  return deleted;
}

}  // namespace cell
