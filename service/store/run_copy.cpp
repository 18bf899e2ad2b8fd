#include "service/store/run_copy.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "service/base/digest.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_insert.hpp"
#include "service/store/internal/row_text.hpp"
#include "service/store/internal/run_change.hpp"
#include "service/store/internal/touch_change.hpp"

namespace cell {
namespace {

/// Of the digest of a plan, in the id of an imported one.
constexpr std::size_t kPlanDigits = 12;

/// What a file says is a plan's id must not stand for a plan of this cell.
std::string id_of_imported_plan(const std::string& plan_id, const std::string& document) {
  return plan_id + "-imported-" + sha256_hex(document).substr(0, kPlanDigits);
}

void insert_touch(SQLite::Database& database, std::int64_t run_id, const StoredTouch& touch) {
  SQLite::Statement insert(database, row::insert_touch_sql());
  row::bind_touch(insert, run_id, touch);
  insert.exec();
}

void insert_rows(SQLite::Database& database, std::int64_t run_id, const RunCopy& copy) {
  for (const SupersededTouch& before : copy.superseded) {
    insert_touch(database, run_id, before.touch);
    row::supersede(database, run_id, before.touch.number, before.reason);
  }
  for (const StoredTouch& touch : copy.touches) insert_touch(database, run_id, touch);
  for (const ReferenceTouch& touch : copy.references) row::insert_reference(database, run_id, touch);
  for (const PlanChange& change : copy.plan_changes) row::insert_plan_change(database, run_id, change);
  for (const RefusedResult& refused : copy.refused) row::insert_refused(database, run_id, refused);
}

void insert_origin(SQLite::Database& database, std::int64_t run_id, const RunOrigin& origin) {
  SQLite::Statement insert(database,
                           "INSERT INTO imported_runs(run_id, cell, origin_run, exported_at, imported_at, "
                           "sha256, origin_checksum)" +
                               row::import_rows().values(6));
  insert.bind(1, run_id);
  insert.bind(2, origin.cell);
  insert.bind(3, origin.run_id);
  insert.bind(4, origin.exported_at);
  insert.bind(5, origin.imported_at);
  insert.bind(6, origin.sha256);
  insert.exec();
}

void write_end(SQLite::Database& database, std::int64_t run_id, const RunCopy& copy) {
  const StoredRun& run = copy.run;
  SQLite::Statement update(database,
                           "UPDATE runs SET outcome = ?, verdict = ?, ended_at = ?, fault_code = ?, "
                           "fault_message = ?, plan_id = ? WHERE id = ?");
  update.bind(1, std::string(run_outcome_name(run.outcome)));
  update.bind(2, std::string(verdict_name(run.verdict)));
  row::bind_or_null(update, 3, run.ended_at);
  row::bind_or_null(update, 4, run.fault_code);
  row::bind_or_null(update, 5, run.fault_message);
  row::bind_or_null(update, 6,
                    copy.plan_json
                        ? std::optional(id_of_imported_plan(run.plan_id.value_or("plan"), *copy.plan_json))
                        : std::nullopt);
  update.bind(7, run_id);
  update.exec();
}

NewRun new_run_of(const StoredRun& run, std::optional<std::int64_t> of_run) {
  return {.kind = run.kind,
          .of_run = of_run,
          .recipe = run.recipe,
          .touches_total = run.touches_total,
          .started_at = run.started_at,
          .idempotency_key = {},
          .operator_name = run.operator_name,
          .block_temperature = run.block_temperature,
          .stiffness = run.stiffness,
          .config_digest = run.config_digest,
          .conditions_json = run.conditions_json};
}

}  // namespace

std::string_view plan_change_word(PlanChange::Kind kind) { return row::plan_change_name(kind); }

std::optional<PlanChange::Kind> plan_change_with(std::string_view word) {
  for (const auto kind :
       {PlanChange::Kind::kDefer, PlanChange::Kind::kDropFitTouches, PlanChange::Kind::kSkip,
        PlanChange::Kind::kBlockToMove, PlanChange::Kind::kBlockMoved})
    if (row::plan_change_name(kind) == word) return kind;
  return std::nullopt;
}

RunCopy copy_of_run(const RunStore& store, const StoredRun& run) {
  return {.run = run,
          .touches = store.touches(run.id),
          .superseded = store.superseded_touches(run.id),
          .references = store.references(run.id),
          .plan_changes = store.plan_changes(run.id),
          .refused = refused_results(store, run.id),
          .plan_json = store.plan_json(run.id),
          .result_json = store.result_json(run.id),
          .arm_json = store.arm_json(run.id)};
}

std::optional<std::int64_t> RunImports::imported_run(const std::string& cell, std::int64_t run_id) const {
  SQLite::Statement query(*database_,
                          "SELECT max(run_id) FROM imported_runs WHERE cell = ? AND origin_run = ?");
  query.bind(1, cell);
  query.bind(2, run_id);
  if (!query.executeStep() || query.getColumn(0).isNull()) return std::nullopt;
  return query.getColumn(0).getInt64();
}

std::optional<std::int64_t> RunImports::find(const RunOrigin& origin, const std::string& started_at,
                                             const std::string& own_cell) const {
  SQLite::Statement query(
      *database_,
      "SELECT max(id) FROM runs WHERE started_at = ?1 AND (id IN (SELECT run_id FROM "
      "imported_runs WHERE cell = ?2 AND origin_run = ?3) OR (?2 = ?4 AND id = ?3 AND id NOT "
      "IN (SELECT run_id FROM imported_runs)))");
  query.bind(1, started_at);
  query.bind(2, origin.cell);
  query.bind(3, origin.run_id);
  query.bind(4, own_cell);
  if (!query.executeStep() || query.getColumn(0).isNull()) return std::nullopt;
  return query.getColumn(0).getInt64();
}

std::int64_t RunImports::add(const RunCopy& copy, const RunOrigin& origin,
                             std::optional<std::int64_t> of_run) {
  SQLite::Database& database = *database_;
  row::WriteTransaction transaction(database);
  const std::int64_t run_id = row::insert_run(database, new_run_of(copy.run, of_run));
  if (copy.plan_json)
    row::insert_plan(database, id_of_imported_plan(copy.run.plan_id.value_or("plan"), *copy.plan_json),
                     *copy.plan_json);
  insert_rows(database, run_id, copy);
  row::write_result(database, run_id, copy.result_json, copy.arm_json);
  write_end(database, run_id, copy);
  insert_origin(database, run_id, origin);
  row::count_rows_of(database, run_id);
  row::seal(database, row::run_rows(), "id", run_id);
  transaction.commit();
  return run_id;
}

}  // namespace cell
