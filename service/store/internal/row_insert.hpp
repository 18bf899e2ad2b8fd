#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <optional>
#include <string>

#include "service/store/refused_result.hpp"
#include "service/store/run_store.hpp"

/// New rows of a run, each inside the caller's transaction and with its checksum unless stated otherwise.
namespace cell::row {

/// Returns the id. Without a checksum, which the caller writes when the row is complete.
std::int64_t insert_run(SQLite::Database& database, const NewRun& run);
/// One that is there stays, unless it is damaged.
void insert_plan(SQLite::Database& database, const std::string& plan_id, const std::string& document);
void insert_plan_change(SQLite::Database& database, std::int64_t run_id, const PlanChange& change);
void insert_reference(SQLite::Database& database, std::int64_t run_id, const ReferenceTouch& touch);
void insert_refused(SQLite::Database& database, std::int64_t run_id, const RefusedResult& refused);

/// The statement that writes a touch, for bind_touch(): it is prepared once for many.
std::string insert_touch_sql();
void bind_touch(SQLite::Statement& insert, std::int64_t run_id, const StoredTouch& touch);

/// The result and the arm of a run: nothing takes the place of an arm that belongs to another result.
void write_result(SQLite::Database& database, std::int64_t run_id,
                  const std::optional<std::string>& result_json, const std::optional<std::string>& arm_json);

}  // namespace cell::row
