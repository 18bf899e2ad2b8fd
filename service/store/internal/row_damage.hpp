#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "service/store/internal/row_checksum.hpp"

/// What each reading of a row demands of it. All throw DamagedStore.
namespace cell::row {

/// A failure to read that is damage of the file, as such; every other one as it is.
[[noreturn]] void rethrow(const SQLite::Database& database, const SQLite::Exception& error);

/// `column` of a row: whether it is as it was written. `number_column`: its number among the rows of the run,
/// for the message; none below 0.
void demand_whole(const SQLite::Database& database, SQLite::Statement& query, int column,
                  std::string_view table, std::int64_t run_id, int number_column = -1);

/// Text that another part of the daemon reads as JSON.
std::string json_text(const SQLite::Database& database, SQLite::Statement& query, int column,
                      std::string_view table, std::int64_t run_id, const char* what);

/// A run that ended has all its rows still; a row may be gone, or stand at another run.
void demand_rows(const SQLite::Database& database, std::int64_t run_id);

/// A row that is not found may be one whose number, or what was asked for, is another now. Of runs from
/// `first_id` on.
void demand_none_damaged(const SQLite::Database& database, const CheckedRows& rows,
                         std::int64_t first_id = 0);

}  // namespace cell::row
