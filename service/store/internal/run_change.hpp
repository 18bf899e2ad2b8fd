#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>
#include <utility>

#include "service/store/internal/fact.hpp"
#include "service/store/internal/row_checksum.hpp"

/// Changes of a row of runs, each inside the caller's transaction.
namespace cell::row {

/// Changes a row of runs inside the caller's transaction. One that was damaged before stays known as such.
template <class Change>
void change_run(SQLite::Database& database, std::int64_t run_id, Change&& change) {
  SQLite::Statement query(database, "SELECT " + run_rows().is_whole() + " FROM runs WHERE id = ?");
  query.bind(1, run_id);
  const bool whole = query.executeStep() && query.getColumn(0).getInt() == 1;
  query.reset();
  std::forward<Change>(change)();
  if (whole) seal(database, run_rows(), "id", run_id);
}

inline constexpr const char* kHasEnded = "SELECT 1 FROM runs WHERE id = ? AND rows_kept IS NOT NULL";

inline bool has_ended(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(database, kHasEnded);
  query.bind(1, run_id);
  return query.executeStep();
}

inline void count_rows_of(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement update(database, "UPDATE runs SET rows_kept = " + rows_of_run() + " WHERE id = ?");
  update.bind(1, run_id);
  update.exec();
}

/// Changes the row of a run that ends by it: what it has of rows counts from now on, and others hear of it.
template <class Change>
void end_run(SQLite::Database& database, std::int64_t run_id, Change&& change) {
  change_run(database, run_id, [&] {
    std::forward<Change>(change)();
    count_rows_of(database, run_id);
  });
  tell_run_ended(database, run_id);
}

/// What a run that ended has gained or lost since counts with it.
inline void note_rows(SQLite::Database& database, std::int64_t run_id) {
  if (!has_ended(database, run_id)) return;
  change_run(database, run_id, [&] { count_rows_of(database, run_id); });
}

/// The same of its touches or its result, of which others hear too.
inline void note_touches(SQLite::Database& database, std::int64_t run_id) {
  if (!has_ended(database, run_id)) return;
  note_rows(database, run_id);
  tell_touch_set(database, run_id);
}

}  // namespace cell::row
