// What a RunStore writes; run_store_queries.cpp reads it.
#include "service/store/run_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "service/store/internal/relaxed_durability.hpp"
#include "service/store/internal/row_text.hpp"

namespace cell {
namespace {

/// Restarts the write-ahead log, so that no touch of a run finds it full. A reader may prevent it: then it
/// grows.
void restart_log(SQLite::Database& database) { database.tryExec("PRAGMA wal_checkpoint(RESTART)"); }

template <class Value>
void bind_or_null(SQLite::Statement& statement, int index, const std::optional<Value>& value) {
  if (value) {
    statement.bind(index, *value);
  } else {
    statement.bind(index);
  }
}

/// The columns of a touch, in the order of both tables, from `index` on.
int bind_touch(SQLite::Statement& insert, std::int64_t run_id, const StoredTouch& touch) {
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
  return index;
}

/// Moves a touch to superseded_touches, inside the caller's transaction.
void supersede(SQLite::Database& database, std::int64_t run_id, int number, const std::string& reason) {
  SQLite::Statement keep(database, "INSERT INTO superseded_touches(run_id, " + row::kTouchColumns +
                                       ", reason) SELECT run_id, " + row::kTouchColumns +
                                       ", ? FROM touches WHERE run_id = ? AND number = ?");
  keep.bind(1, reason);
  keep.bind(2, run_id);
  keep.bind(3, number);
  if (keep.exec() != 1) throw SQLite::Exception("there is no such touch to supersede");
  SQLite::Statement remove(database, "DELETE FROM touches WHERE run_id = ? AND number = ?");
  remove.bind(1, run_id);
  remove.bind(2, number);
  remove.exec();
}

void insert_plan_change(SQLite::Database& database, std::int64_t run_id, const PlanChange& change) {
  SQLite::Statement insert(database, "INSERT INTO plan_changes(run_id, kind, place) VALUES(?, ?, ?)");
  insert.bind(1, run_id);
  insert.bind(2, std::string(row::plan_change_name(change.kind)));
  insert.bind(3, change.place);
  insert.exec();
}

/// A statement that is kept between calls, for one use: it ends with it, also when it failed. One that a
/// lock of another program left unended would be a transaction that stays open: what is written after it
/// reads as stored on this connection, and never reaches the file.
class OneUse {
 public:
  explicit OneUse(SQLite::Statement& statement) : statement_(statement) {}
  ~OneUse() { statement_.tryReset(); }
  OneUse(const OneUse&) = delete;
  OneUse& operator=(const OneUse&) = delete;
  SQLite::Statement* operator->() { return &statement_; }
  SQLite::Statement& operator*() { return statement_; }

 private:
  SQLite::Statement& statement_;
};

}  // namespace

struct RunStore::Statements {
  explicit Statements(SQLite::Database& database)
      : append_touch(database, "INSERT INTO touches(run_id, " + row::kTouchColumns +
                                   ") VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
        set_open_command(database,
                         "INSERT OR REPLACE INTO open_commands(run_id, session, sequence, aimed_with, "
                         "touch_json) VALUES(?, ?, ?, ?, ?)"),
        make_durable(database, "UPDATE open_commands SET session = session WHERE run_id = ?") {}

  SQLite::Statement append_touch;
  SQLite::Statement set_open_command;
  SQLite::Statement make_durable;
};

RunStore::RunStore(const std::filesystem::path& file)
    : database_(open_database(file)), statements_(std::make_unique<Statements>(*database_)) {}

RunStore::~RunStore() = default;

std::int64_t RunStore::begin_run(const NewRun& run) {
  SQLite::Statement insert(*database_,
                           "INSERT INTO runs(recipe, touches_total, started_at, idempotency_key, "
                           "operator_name, config_digest, trace_json, block_temperature_c, "
                           "std_block_temperature_k, block_temperature_at, block_temperature_source, "
                           "stiffness) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
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
  insert.exec();
  const std::int64_t id = database_->getLastInsertRowid();
  restart_log(*database_);
  return id;
}

void RunStore::set_plan(std::int64_t run_id, int touches_total, const std::string& plan_id,
                        const std::string& document) {
  SQLite::Transaction transaction(*database_);
  SQLite::Statement insert(*database_, "INSERT OR IGNORE INTO plans(id, document) VALUES(?, ?)");
  insert.bind(1, plan_id);
  insert.bind(2, document);
  insert.exec();
  SQLite::Statement update(*database_, "UPDATE runs SET touches_total = ?, plan_id = ? WHERE id = ?");
  update.bind(1, touches_total);
  update.bind(2, plan_id);
  update.bind(3, run_id);
  update.exec();
  transaction.commit();
}

void RunStore::set_touches_total(std::int64_t run_id, int touches_total) {
  SQLite::Statement update(*database_, "UPDATE runs SET touches_total = ? WHERE id = ?");
  update.bind(1, touches_total);
  update.bind(2, run_id);
  update.exec();
}

void RunStore::append_plan_change(std::int64_t run_id, const PlanChange& change) {
  const RelaxedDurability unsynced(*database_);
  insert_plan_change(*database_, run_id, change);
}

void RunStore::leave_out(std::int64_t run_id, const std::vector<PlanChange>& changes,
                         const std::optional<Withdrawal>& withdrawn) {
  SQLite::Transaction transaction(*database_);
  if (withdrawn) supersede(*database_, run_id, withdrawn->number, withdrawn->reason);
  for (const PlanChange& change : changes) insert_plan_change(*database_, run_id, change);
  transaction.commit();
}

void RunStore::set_open_command(std::int64_t run_id, const OpenCommand& command) {
  const RelaxedDurability unsynced(*database_);
  OneUse insert(statements_->set_open_command);
  insert->bind(1, run_id);
  insert->bind(2, command.session);
  insert->bind(3, command.sequence);
  insert->bind(4, command.aimed_with);
  insert->bind(5, command.touch_json);
  insert->exec();
}

bool RunStore::make_durable(std::int64_t run_id) {
  try {
    OneUse update(statements_->make_durable);
    update->bind(1, run_id);
    update->exec();
    return true;
  } catch (const SQLite::Exception&) {
    return false;
  }
}

void RunStore::append_touch(std::int64_t run_id, const StoredTouch& touch) {
  OneUse insert(statements_->append_touch);
  bind_touch(*insert, run_id, touch);
  insert->exec();
}

void RunStore::withdraw_touch(std::int64_t run_id, int number, const std::string& reason) {
  SQLite::Transaction transaction(*database_);
  supersede(*database_, run_id, number, reason);
  transaction.commit();
}

void RunStore::replace_touch(std::int64_t run_id, const StoredTouch& again, const std::string& reason) {
  SQLite::Transaction transaction(*database_);
  supersede(*database_, run_id, again.number, reason);
  append_touch(run_id, again);
  transaction.commit();
}

void RunStore::append_reference(std::int64_t run_id, const ReferenceTouch& touch) {
  SQLite::Statement insert(
      *database_, "INSERT INTO reference_touches(run_id, number, touches_done, " + row::kJointColumns +
                      ", drift_mm, captured_at) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  int index = 0;
  insert.bind(++index, run_id);
  insert.bind(++index, touch.number);
  insert.bind(++index, touch.touches_done);
  for (const std::int32_t joint : touch.joints) insert.bind(++index, joint);
  bind_or_null(insert, ++index, touch.drift_mm);
  insert.bind(++index, touch.captured_at);
  insert.exec();
}

void RunStore::append_resumption(std::int64_t run_id, const std::string& at, int touches_done) {
  SQLite::Statement insert(*database_, "INSERT INTO resumptions(run_id, at, touches_done) VALUES(?, ?, ?)");
  insert.bind(1, run_id);
  insert.bind(2, at);
  insert.bind(3, touches_done);
  insert.exec();
}

void RunStore::finish_run(std::int64_t run_id, const RunEnd& end) {
  SQLite::Statement update(*database_,
                           "UPDATE runs SET outcome = ?, verdict = ?, ended_at = ?, fault_code = ?, "
                           "fault_message = ?, result_json = ? WHERE id = ?");
  update.bind(1, std::string(run_outcome_name(end.outcome)));
  update.bind(2, std::string(verdict_name(end.verdict)));
  update.bind(3, end.ended_at);
  bind_or_null(update, 4, end.fault_code);
  bind_or_null(update, 5, end.fault_message);
  bind_or_null(update, 6, end.result_json);
  update.bind(7, run_id);
  update.exec();
}

void RunStore::set_result_json(std::int64_t run_id, const std::string& result_json) {
  SQLite::Statement update(*database_, "UPDATE runs SET result_json = ? WHERE id = ?");
  update.bind(1, result_json);
  update.bind(2, run_id);
  update.exec();
}

int RunStore::finish_interrupted(const std::string& now, std::optional<std::int64_t> but) {
  SQLite::Statement update(*database_,
                           "UPDATE runs SET outcome = ?, verdict = ?, ended_at = ? WHERE outcome = ? AND id "
                           "IS NOT ?");
  update.bind(1, std::string(run_outcome_name(RunOutcome::kInterrupted)));
  update.bind(2, std::string(verdict_name(Verdict::kIncomplete)));
  update.bind(3, now);
  update.bind(4, std::string(run_outcome_name(RunOutcome::kRunning)));
  bind_or_null(update, 5, but);
  return update.exec();
}

}  // namespace cell
