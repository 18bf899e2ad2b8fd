#include "service/store/internal/row_damage.hpp"

#include <sqlite3.h>

#include <nlohmann/json.hpp>

#include "service/store/damaged_store.hpp"

namespace cell::row {

void rethrow(const SQLite::Database& database, const SQLite::Exception& error) {
  if (error.getErrorCode() == SQLITE_CORRUPT || error.getErrorCode() == SQLITE_NOTADB)
    throw DamagedStore(database.getFilename(), "its pages", error.what());
  throw error;
}

void demand_whole(const SQLite::Database& database, SQLite::Statement& query, int column,
                  std::string_view table, std::int64_t run_id, int number_column) {
  if (query.getColumn(column).getInt() == 1) return;
  const auto number =
      number_column < 0 ? std::nullopt : std::optional(query.getColumn(number_column).getInt());
  throw DamagedStore(database.getFilename(), place_of(table, run_id, number), kOtherChecksum);
}

std::string json_text(const SQLite::Database& database, SQLite::Statement& query, int column,
                      std::string_view table, std::int64_t run_id, const char* what) {
  std::string text = query.getColumn(column).getString();
  if (nlohmann::json::accept(text)) return text;
  throw DamagedStore(database.getFilename(), place_of(table, run_id), std::string(what) + " is no JSON");
}

void demand_rows(const SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(
      database, "SELECT " + run_rows().is_whole() + ", " + has_its_rows() + " FROM runs WHERE id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return;
  demand_whole(database, query, 0, "runs", run_id);
  if (query.getColumn(1).getInt() == 1) return;
  throw DamagedStore(database.getFilename(), place_of("runs", run_id),
                     "it has not the touches that it ended with");
}

void demand_none_damaged(const SQLite::Database& database, const CheckedRows& rows, std::int64_t first_id) {
  SQLite::Statement damaged(database, "SELECT " + rows.run + " FROM " + rows.table + " WHERE " + rows.run +
                                          " >= ? AND NOT " + rows.is_whole() + " LIMIT 1");
  damaged.bind(1, first_id);
  if (!damaged.executeStep()) return;
  throw DamagedStore(database.getFilename(), place_of(rows.table, damaged.getColumn(0).getInt64()),
                     kOtherChecksum);
}

}  // namespace cell::row
