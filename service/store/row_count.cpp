#include "service/store/internal/row_count.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/fmt/fmt.h>

#include <array>

#include "service/store/internal/row_checksum.hpp"

namespace cell::row {
namespace {

constexpr std::array kCountedTables{CountedTable::kFaults, CountedTable::kAnswers};

std::string name_of(CountedTable table) { return table == CountedTable::kFaults ? "faults" : "answers"; }

std::int64_t rows_there(SQLite::Database& database, CountedTable table) {
  return database.execAndGet("SELECT count(*) FROM " + name_of(table)).getInt64();
}

}  // namespace

void begin_row_counts(SQLite::Database& database) {
  for (const CountedTable table : kCountedTables) {
    SQLite::Statement insert(
        database, "INSERT INTO row_counts(name, row_count, checksum)" + row_count_rows().values(2));
    insert.bind(1, name_of(table));
    insert.bind(2, rows_there(database, table));
    insert.exec();
  }
}

void change_row_count(SQLite::Database& database, CountedTable table, std::int64_t by) {
  if (by == 0) return;
  SQLite::Statement update(database,
                           "UPDATE row_counts SET row_count = row_count + ?1, checksum = "
                           "row_checksum('row_counts', name, row_count + ?1) WHERE name = ?2 AND " +
                               row_count_rows().is_whole());
  update.bind(1, by);
  update.bind(2, name_of(table));
  update.exec();
}

std::vector<std::string> find_row_count_damage(SQLite::Database& database) {
  std::vector<std::string> damage;
  for (const CountedTable table : kCountedTables) {
    SQLite::Statement query(database, "SELECT row_count FROM row_counts WHERE name = ?");
    query.bind(1, name_of(table));
    if (!query.executeStep()) {
      damage.push_back("table row_counts: that of " + name_of(table) + " is not there");
      continue;
    }
    const std::int64_t kept = query.getColumn(0).getInt64(), there = rows_there(database, table);
    if (there == kept) continue;
    damage.push_back(
        there < kept
            ? fmt::format("table {}: {} rows that it had are not there", name_of(table), kept - there)
            : fmt::format("table {}: {} rows were put in past the daemon", name_of(table), there - kept));
  }
  return damage;
}

}  // namespace cell::row
