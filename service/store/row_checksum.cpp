#include "service/store/internal/row_checksum.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <array>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "service/store/internal/row_text.hpp"
#include "service/store/internal/run_change.hpp"

namespace cell::row {
namespace {

constexpr std::uint64_t kFnvOffset = 0xcbf29ce484222325U;
constexpr std::uint64_t kFnvPrime = 0x100000001b3U;

std::uint64_t mixed(std::uint64_t sum, const unsigned char* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) sum = (sum ^ bytes[i]) * kFnvPrime;
  return sum;
}

std::uint64_t mixed(std::uint64_t sum, std::uint64_t value) {
  const auto bytes = std::bit_cast<std::array<unsigned char, sizeof value>>(value);
  return mixed(sum, bytes.data(), bytes.size());
}

void checksum_values(sqlite3_context* context, int count, sqlite3_value** values) {
  std::uint64_t sum = kFnvOffset;
  for (int i = 0; i < count; ++i) {
    sqlite3_value* value = values[i];
    const int type = sqlite3_value_type(value);
    sum = mixed(sum, static_cast<std::uint64_t>(type));
    if (type == SQLITE_INTEGER) {
      sum = mixed(sum, static_cast<std::uint64_t>(sqlite3_value_int64(value)));
    } else if (type == SQLITE_FLOAT) {
      sum = mixed(sum, std::bit_cast<std::uint64_t>(sqlite3_value_double(value)));
    } else if (type != SQLITE_NULL) {
      const auto* bytes = static_cast<const unsigned char*>(sqlite3_value_blob(value));
      const auto length = static_cast<std::size_t>(sqlite3_value_bytes(value));
      sum = mixed(mixed(sum, length), bytes, length);
    }
  }
  sqlite3_result_int64(context, static_cast<std::int64_t>(sum));
}

std::string count_of(const std::string& table) {
  return "(SELECT count(*) FROM " + table + " WHERE run_id = runs.id)";
}

CheckedRows rows_of(const std::string& table, std::string columns, std::string number) {
  return {.name = table,
          .table = table,
          .columns = std::move(columns),
          .checksum = "checksum",
          .run = "run_id",
          .number = std::move(number),
          .applies = "1"};
}

CheckedRows rows_of_no_run(const std::string& table, std::string columns, std::string number) {
  CheckedRows rows = rows_of(table, std::move(columns), std::move(number));
  rows.run = "NULL";
  return rows;
}

CheckedRows touch_rows_of(const std::string& columns) {
  return rows_of("touches", "run_id, " + columns, "number");
}

CheckedRows superseded_rows_of(const std::string& columns) {
  return rows_of("superseded_touches", "id, run_id, " + columns + ", reason", "number");
}

/// Both tables of touches.
struct TouchTables {
  CheckedRows touches;
  CheckedRows superseded;
};

CheckedRows run_rows_of(std::string columns) {
  return {.name = "runs",
          .table = "runs",
          .columns = std::move(columns),
          .checksum = "checksum",
          .run = "id",
          .number = "NULL",
          .applies = "1"};
}

TouchTables touch_tables_of(const std::string& columns) {
  return {touch_rows_of(columns), superseded_rows_of(columns)};
}

/// As they are in a file of this schema.
const TouchTables& touch_tables(std::size_t schema) {
  static const TouchTables without_noise = touch_tables_of(kTouchColumnsWithoutNoise);
  static const TouchTables without_contacts = touch_tables_of(kTouchColumnsWithoutContacts);
  static const TouchTables newest = touch_tables_of(kTouchColumns);
  if (schema < kTouchNoiseSchema) return without_noise;
  return schema < kTouchContactsSchema ? without_contacts : newest;
}

void reseal(SQLite::Database& database, const CheckedRows& before, const CheckedRows& now) {
  database.exec("UPDATE " + now.table + " SET " + now.checksum + " = " + now.computed() + " WHERE " +
                before.is_whole());
}

void fill_checksums_of(SQLite::Database& database, const CheckedRows& rows) {
  const std::string column = rows.checksum.substr(rows.checksum.find('.') + 1);
  database.exec("UPDATE " + rows.table + " SET " + column + " = " + rows.computed() + " WHERE " +
                rows.checksum + " IS NULL AND " + rows.applies);
}

}  // namespace

std::string CheckedRows::computed() const { return "row_checksum('" + name + "', " + columns + ")"; }

std::string CheckedRows::is_whole() const {
  return "(" + checksum + " IS CASE WHEN " + applies + " THEN " + computed() + " END)";
}

std::string CheckedRows::values(int count) const {
  std::string parameters;
  for (int i = 1; i <= count; ++i) parameters += (i > 1 ? ", ?" : "?") + std::to_string(i);
  return " VALUES(" + parameters + ", row_checksum('" + name + "', " + parameters + "))";
}

const CheckedRows& touch_rows() { return touch_tables(kTouchContactsSchema).touches; }

const CheckedRows& superseded_rows() { return touch_tables(kTouchContactsSchema).superseded; }

const CheckedRows& reference_rows() {
  static const CheckedRows rows =
      rows_of("reference_touches",
              "run_id, number, touches_done, " + kJointColumns + ", drift_mm, captured_at", "number");
  return rows;
}

const CheckedRows& plan_change_rows() {
  static const CheckedRows rows = rows_of("plan_changes", "id, run_id, kind, place", "id");
  return rows;
}

const CheckedRows& open_command_rows() {
  static const CheckedRows rows =
      rows_of("open_commands", "run_id, session, sequence, aimed_with, touch_json", "NULL");
  return rows;
}

const CheckedRows& plan_rows() {
  static const CheckedRows rows{.name = "plans",
                                .table = "plans",
                                .columns = "plans.id, plans.document",
                                .checksum = "plans.checksum",
                                .run = "NULL",
                                .number = "id",
                                .applies = "1"};
  return rows;
}

const CheckedRows& run_rows(std::size_t schema) {
  static const std::string columns =
      "id, recipe, touches_total, started_at, ended_at, outcome, verdict, fault_code, "
      "fault_message, idempotency_key, plan_id, operator_name, block_temperature_c, "
      "config_digest, trace_json, std_block_temperature_k, block_temperature_at, "
      "block_temperature_source, stiffness, rows_kept";
  static const CheckedRows without_kind = run_rows_of(columns),
                           newest = run_rows_of(columns + ", kind, of_run");
  return schema < kRunKindSchema ? without_kind : newest;
}

const CheckedRows& result_rows() {
  static const CheckedRows rows{.name = "results",
                                .table = "runs",
                                .columns = "id, result_json",
                                .checksum = "result_checksum",
                                .run = "id",
                                .number = "NULL",
                                .applies = "result_json IS NOT NULL"};
  return rows;
}

const CheckedRows& arm_rows() {
  static const CheckedRows rows = rows_of("arms", "run_id, document", "NULL");
  return rows;
}

const CheckedRows& model_rows() {
  static const CheckedRows rows = rows_of(
      "models", "id, kind, run_id, at, operator_name, hash, valid_until, document, arm, chained", "id");
  return rows;
}

const CheckedRows& fault_rows() {
  static const CheckedRows rows = rows_of("faults", "id, run_id, at, code, message", "id");
  return rows;
}

const CheckedRows& resumption_rows() {
  static const CheckedRows rows = rows_of("resumptions", "id, run_id, at, touches_done", "id");
  return rows;
}

const CheckedRows& answer_rows() {
  static const CheckedRows rows =
      rows_of_no_run("answers", "key, request, body_digest, status, headers_json, body, at", "key");
  return rows;
}

const CheckedRows& refused_rows() {
  static const CheckedRows rows =
      rows_of("refused_results", "id, run_id, session, sequence, " + kJointColumns + ", reason, at", "id");
  return rows;
}

const CheckedRows& row_count_rows() {
  static const CheckedRows rows = rows_of_no_run("row_counts", "name, row_count", "name");
  return rows;
}

const CheckedRows& import_rows() {
  static const CheckedRows rows{
      .name = "imported_runs",
      .table = "imported_runs",
      .columns =
          "imported_runs.run_id, imported_runs.cell, imported_runs.origin_run, imported_runs.exported_at, "
          "imported_runs.imported_at, imported_runs.sha256",
      .checksum = "imported_runs.origin_checksum",
      .run = "imported_runs.run_id",
      .number = "NULL",
      .applies = "1"};
  return rows;
}

std::span<const CheckedRows* const> all_checked_rows(std::size_t schema) {
  // What came last stands last.
  constexpr std::size_t kModels = 1, kLogs = 5, kImports = 1;
  static const auto as_in = [](std::size_t version) {
    const TouchTables& tables = touch_tables(version);
    return std::array{&tables.touches,      &tables.superseded, &reference_rows(),  &plan_change_rows(),
                      &open_command_rows(), &plan_rows(),       &run_rows(version), &result_rows(),
                      &arm_rows(),          &model_rows(),      &fault_rows(),      &resumption_rows(),
                      &answer_rows(),       &refused_rows(),    &row_count_rows(),  &import_rows()};
  };
  static const std::array without_noise = as_in(kChecksumSchema), without_contacts = as_in(kTouchNoiseSchema);
  static const std::array without_kinds = as_in(kTouchContactsSchema), newest = as_in(kRunKindSchema);
  const std::span<const CheckedRows* const> rows = schema < kTouchNoiseSchema      ? without_noise
                                                   : schema < kTouchContactsSchema ? without_contacts
                                                   : schema < kRunKindSchema       ? without_kinds
                                                                                   : newest;
  const std::size_t later = schema < kModelSchema         ? kModels + kLogs + kImports
                            : schema < kLogChecksumSchema ? kLogs + kImports
                            : schema < kImportSchema      ? kImports
                                                          : 0;
  return rows.first(rows.size() - later);
}

const std::string& rows_of_run(std::size_t schema) {
  static const std::string without_logs = count_of("touches") + " || '/' || " +
                                          count_of("superseded_touches") + " || '/' || " +
                                          count_of("reference_touches") + " || '/' || " +
                                          count_of("plan_changes") + " || '/' || " + count_of("arms");
  static const std::string before = "(" + without_logs + ")";
  static const std::string newest = "(" + without_logs + " || '/' || " + count_of("resumptions") +
                                    " || '/' || " + count_of("refused_results") + ")";
  return schema < kLogChecksumSchema ? before : newest;
}

const std::string& has_its_rows(std::size_t schema) {
  static const auto has = [](std::size_t of) {
    return "(rows_kept IS NULL OR rows_kept = " + rows_of_run(of) + ")";
  };
  static const std::string before = has(kChecksumSchema), newest = has(kLogChecksumSchema);
  return schema < kLogChecksumSchema ? before : newest;
}

void add_checksum_function(SQLite::Database& database) {
  constexpr int kAnyCount = -1;
  database.createFunction("row_checksum", kAnyCount, true, nullptr, checksum_values);
}

void fill_checksums(SQLite::Database& database, std::size_t schema) {
  database.exec("UPDATE runs SET rows_kept = " + rows_of_run(schema) +
                " WHERE outcome <> 'running' AND checksum IS NULL");
  for (const CheckedRows* rows : all_checked_rows(schema)) fill_checksums_of(database, *rows);
}

void reseal_touches(SQLite::Database& database, std::size_t schema) {
  const TouchTables &before = touch_tables(schema - 1), &now = touch_tables(schema);
  reseal(database, before.touches, now.touches);
  reseal(database, before.superseded, now.superseded);
}

void reseal_runs(SQLite::Database& database) { reseal(database, run_rows(kRunKindSchema - 1), run_rows()); }

void seal_logs(SQLite::Database& database) {
  const CheckedRows& runs = run_rows(kLogChecksumSchema);
  for (const CheckedRows* rows : {&fault_rows(), &resumption_rows(), &answer_rows()})
    fill_checksums_of(database, *rows);
  SQLite::Statement query(database, "SELECT id FROM runs WHERE rows_kept IS NOT NULL AND " + runs.is_whole() +
                                        " AND " + has_its_rows(kLogChecksumSchema - 1));
  std::vector<std::int64_t> ended;
  while (query.executeStep()) ended.push_back(query.getColumn(0).getInt64());
  for (const std::int64_t run_id : ended) {
    count_rows_of(database, run_id);
    seal(database, runs, "id", run_id);
  }
}

void seal(SQLite::Database& database, const CheckedRows& rows, const std::string& condition,
          std::int64_t key) {
  SQLite::Statement update(database, "UPDATE " + rows.table + " SET " + rows.checksum + " = " +
                                         rows.computed() + " WHERE " + condition + " = ?");
  update.bind(1, key);
  update.exec();
}

}  // namespace cell::row
