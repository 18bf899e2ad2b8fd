#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace SQLite {
class Database;
}

/// How many rows a table has whose oldest rows are deleted, so that no run can tell: of faults and answers. A
/// row that was taken out or put in past the daemon shows in it.
namespace cell::row {

enum class CountedTable { kFaults, kAnswers };

/// Counts what is there, in a file that had no counts. Within the caller's transaction, as the next.
void begin_row_counts(SQLite::Database& database);

/// So many rows came, or went where it is negative. A count that was damaged before stays known as such.
void change_row_count(SQLite::Database& database, CountedTable table, std::int64_t by);

/// The tables that have other rows than they were left with, a line each.
std::vector<std::string> find_row_count_damage(SQLite::Database& database);

}  // namespace cell::row
