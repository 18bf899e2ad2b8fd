#include "service/store/internal/row_insert.hpp"

#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_text.hpp"
#include "service/store/internal/touch_change.hpp"

namespace cell::row {

std::int64_t insert_run(SQLite::Database& database, const NewRun& run) {
  SQLite::Statement insert(database,
                           "INSERT INTO runs(recipe, touches_total, started_at, idempotency_key, "
                           "operator_name, config_digest, trace_json, block_temperature_c, "
                           "std_block_temperature_k, block_temperature_at, block_temperature_source, "
                           "stiffness, kind, of_run) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, run.recipe);
  insert.bind(2, run.touches_total);
  insert.bind(3, run.started_at);
  bind_or_null(insert, 4, run.idempotency_key);
  bind_or_null(insert, 5, run.operator_name);
  bind_or_null(insert, 6, run.config_digest);
  bind_or_null(insert, 7, run.conditions_json);
  if (const auto& temperature = run.block_temperature) {
    insert.bind(8, temperature->celsius);
    bind_or_null(insert, 9, temperature->std_k);
    bind_or_null(insert, 10, temperature->measured_at);
    bind_or_null(insert, 11, temperature->source);
  }
  bind_or_null(insert, 12, run.stiffness);
  insert.bind(13, std::string(run_kind_name(run.kind)));
  bind_or_null(insert, 14, run.of_run);
  insert.exec();
  return database.getLastInsertRowid();
}

void insert_plan(SQLite::Database& database, const std::string& plan_id, const std::string& document) {
  // One that was damaged is written again.
  SQLite::Statement forget(database, "DELETE FROM plans WHERE id = ? AND NOT " + plan_rows().is_whole());
  forget.bind(1, plan_id);
  forget.exec();
  SQLite::Statement insert(database,
                           "INSERT OR IGNORE INTO plans(id, document, checksum)" + plan_rows().values(2));
  insert.bind(1, plan_id);
  insert.bind(2, document);
  insert.exec();
}

void insert_plan_change(SQLite::Database& database, std::int64_t run_id, const PlanChange& change) {
  SQLite::Statement insert(database, "INSERT INTO plan_changes(run_id, kind, place) VALUES(?, ?, ?)");
  insert.bind(1, run_id);
  insert.bind(2, std::string(plan_change_name(change.kind)));
  insert.bind(3, change.place);
  insert.exec();
  seal(database, plan_change_rows(), "id", database.getLastInsertRowid());
}

void insert_reference(SQLite::Database& database, std::int64_t run_id, const ReferenceTouch& touch) {
  SQLite::Statement insert(database, "INSERT INTO reference_touches(run_id, number, touches_done, " +
                                         kJointColumns + ", drift_mm, captured_at, checksum)" +
                                         reference_rows().values(11));
  int index = 0;
  insert.bind(++index, run_id);
  insert.bind(++index, touch.number);
  insert.bind(++index, touch.touches_done);
  for (const std::int32_t joint : touch.joints) insert.bind(++index, joint);
  bind_or_null(insert, ++index, touch.drift_mm);
  insert.bind(++index, touch.captured_at);
  insert.exec();
}

void insert_refused(SQLite::Database& database, std::int64_t run_id, const RefusedResult& refused) {
  SQLite::Statement insert(database, "INSERT INTO refused_results(run_id, session, sequence, " +
                                         kJointColumns +
                                         ", reason, at) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  int index = 0;
  insert.bind(++index, run_id);
  insert.bind(++index, refused.session);
  insert.bind(++index, refused.sequence);
  bind_joints(insert, index, &refused.joints);
  insert.bind(++index, refused.reason);
  insert.bind(++index, refused.at);
  insert.exec();
  seal(database, refused_rows(), "id", database.getLastInsertRowid());
}

std::string insert_touch_sql() {
  return "INSERT INTO touches(run_id, " + kTouchColumns + ", checksum)" +
         touch_rows().values(1 + kTouchColumnCount);
}

void bind_touch(SQLite::Statement& insert, std::int64_t run_id, const StoredTouch& touch) {
  int index = 0;
  insert.bind(++index, run_id);
  insert.bind(++index, touch.number);
  insert.bind(++index, touch.plane);
  insert.bind(++index, static_cast<int>(touch.role));
  for (const std::int32_t joint : touch.joints) insert.bind(++index, joint);
  insert.bind(++index, static_cast<int>(touch.source));
  insert.bind(++index, touch.overtravel_dmm);
  insert.bind(++index, touch.captured_at);
  insert.bind(++index, touch.session);
  insert.bind(++index, touch.sequence);
  insert.bind(++index, touch.aimed_with);
  bind_or_null(insert, ++index, touch.noise_um);
  bind_or_null(insert, ++index,
               touch.first ? std::optional(static_cast<int>(touch.first->source)) : std::nullopt);
  bind_joints(insert, index, touch.first ? &touch.first->joints : nullptr);
  bind_joints(insert, index, touch.again ? &*touch.again : nullptr);
}

void write_result(SQLite::Database& database, std::int64_t run_id,
                  const std::optional<std::string>& result_json, const std::optional<std::string>& arm_json) {
  SQLite::Statement result(database,
                           "UPDATE runs SET result_json = ?1, result_checksum = CASE WHEN ?1 IS NOT "
                           "NULL THEN row_checksum('results', ?2, ?1) END WHERE id = ?2");
  bind_or_null(result, 1, result_json);
  result.bind(2, run_id);
  result.exec();
  SQLite::Statement forget(database, "DELETE FROM arms WHERE run_id = ?");
  forget.bind(1, run_id);
  forget.exec();
  if (!arm_json) return;
  SQLite::Statement arm(database, "INSERT INTO arms(run_id, document, checksum)" + arm_rows().values(2));
  arm.bind(1, run_id);
  arm.bind(2, *arm_json);
  arm.exec();
}

}  // namespace cell::row
