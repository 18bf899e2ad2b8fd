// What a RunStore writes; run_store_queries.cpp reads it.
#include "service/store/run_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <utility>

#include "service/store/internal/fact.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/opened_file.hpp"
#include "service/store/internal/relaxed_durability.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_insert.hpp"
#include "service/store/internal/run_change.hpp"
#include "service/store/internal/touch_change.hpp"

namespace cell {
namespace {

/// Restarts the write-ahead log, so that no touch of a run finds it full. A reader may prevent it: then it
/// grows.
void restart_log(SQLite::Database& database) { database.tryExec("PRAGMA wal_checkpoint(RESTART)"); }

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

/// row::has_ended() by a statement that is prepared once, not parsed again with each touch: less work
/// before the disk.
bool has_ended(SQLite::Statement& prepared, std::int64_t run_id) {
  OneUse query(prepared);
  query->bind(1, run_id);
  return query->executeStep();
}

}  // namespace

struct RunStore::Statements {
  Statements(SQLite::Database& database, LockTime time)
      : lock_wait(database, std::move(time)),
        append_touch(database, row::insert_touch_sql()),
        set_open_command(database,
                         "INSERT OR REPLACE INTO open_commands(run_id, session, sequence, aimed_with, "
                         "touch_json, checksum)" +
                             row::open_command_rows().values(5)),
        shift_open_command(database, "UPDATE open_commands SET session = session + ? WHERE run_id = ?"),
        has_ended(database, row::kHasEnded),
        opened(row::file_at(database.getFilename())) {}

  row::LockWait lock_wait;
  SQLite::Statement append_touch;
  SQLite::Statement set_open_command;
  SQLite::Statement shift_open_command;
  SQLite::Statement has_ended;
  row::FileAtPath opened;  // the file of the database
};

RunStore::RunStore(const std::filesystem::path& file, LockTime time)
    : database_(open_database(file)),
      statements_(std::make_unique<Statements>(*database_, std::move(time))) {}

RunStore::RunStore(SharedDatabase to_read) : database_(std::move(to_read)) {}

std::unique_ptr<const RunStore> RunStore::reader(const std::filesystem::path& file) {
  return std::unique_ptr<const RunStore>(new RunStore(open_database_to_read(file)));
}

RunStore::~RunStore() = default;

std::filesystem::path RunStore::file() const { return database_->getFilename(); }

std::int64_t RunStore::begin_run(const NewRun& run) {
  const std::int64_t id = insert_run(run);
  const row::LockWait::Brief brief(statements_->lock_wait);
  restart_log(*database_);
  return id;
}

std::int64_t RunStore::insert_run(const NewRun& run) {
  row::WriteTransaction transaction(*database_);
  const std::int64_t id = row::insert_run(*database_, run);
  row::seal(*database_, row::run_rows(), "id", id);
  row::tell_run_started(*database_, id);
  transaction.commit();
  return id;
}

void RunStore::withdraw_run(std::int64_t run_id) {
  row::WriteTransaction transaction(*database_);
  row::tell_run_withdrawn(*database_, run_id);
  SQLite::Statement remove(*database_, "DELETE FROM runs WHERE id = ?");
  remove.bind(1, run_id);
  remove.exec();
  transaction.commit();
}

void RunStore::set_plan(std::int64_t run_id, int touches_total, const std::string& plan_id,
                        const std::string& document, const std::vector<PlanChange>& changes) {
  row::WriteTransaction transaction(*database_);
  row::insert_plan(*database_, plan_id, document);
  for (const PlanChange& change : changes) row::insert_plan_change(*database_, run_id, change);
  row::change_run(*database_, run_id, [&] {
    SQLite::Statement update(*database_, "UPDATE runs SET touches_total = ?, plan_id = ? WHERE id = ?");
    update.bind(1, touches_total);
    update.bind(2, plan_id);
    update.bind(3, run_id);
    update.exec();
  });
  row::note_rows(*database_, run_id);
  transaction.commit();
}

void RunStore::set_touches_total(std::int64_t run_id, int touches_total) {
  row::WriteTransaction transaction(*database_);
  row::change_run(*database_, run_id, [&] {
    SQLite::Statement update(*database_, "UPDATE runs SET touches_total = ? WHERE id = ?");
    update.bind(1, touches_total);
    update.bind(2, run_id);
    update.exec();
  });
  transaction.commit();
}

void RunStore::append_plan_change(std::int64_t run_id, const PlanChange& change) {
  const RelaxedDurability unsynced(*database_);
  row::WriteTransaction transaction(*database_);
  row::insert_plan_change(*database_, run_id, change);
  row::note_rows(*database_, run_id);
  transaction.commit();
}

void RunStore::change_plan(std::int64_t run_id, const std::vector<PlanChange>& changes,
                           const std::optional<Withdrawal>& withdrawn) {
  row::WriteTransaction transaction(*database_);
  if (withdrawn) row::supersede(*database_, run_id, withdrawn->number, withdrawn->reason);
  for (const PlanChange& change : changes) row::insert_plan_change(*database_, run_id, change);
  row::note_touches(*database_, run_id);
  transaction.commit();
}

void RunStore::demand_in_place() const { row::demand_file(database_->getFilename(), statements_->opened); }

void RunStore::set_open_command(std::int64_t run_id, const OpenCommand& command) {
  demand_in_place();
  const RelaxedDurability unsynced(*database_);
  OneUse insert(statements_->set_open_command);
  insert->bind(1, run_id);
  insert->bind(2, command.session);
  insert->bind(3, command.sequence);
  insert->bind(4, command.aimed_with);
  insert->bind(5, command.touch_json);
  insert->exec();
}

void RunStore::forget_open_command(std::int64_t run_id) {
  const RelaxedDurability unsynced(*database_);
  SQLite::Statement remove(*database_, "DELETE FROM open_commands WHERE run_id = ?");
  remove.bind(1, run_id);
  remove.exec();
}

bool RunStore::make_durable(std::int64_t run_id) {
  // A commit is synced where it writes a page, and what is set to what it was writes none.
  const auto shift = [&](int by) {
    OneUse update(statements_->shift_open_command);
    update->bind(1, by);
    update->bind(2, run_id);
    update->exec();
  };
  try {
    row::WriteTransaction transaction(*database_);
    shift(1);
    shift(-1);
    transaction.commit();
    return true;
  } catch (const SQLite::Exception&) {
    return false;
  }
}

void RunStore::append_touch(std::int64_t run_id, const StoredTouch& touch) {
  if (!has_ended(statements_->has_ended, run_id)) {
    insert_touch(run_id, touch);
    return;
  }
  row::WriteTransaction transaction(*database_);
  insert_touch(run_id, touch);
  row::note_touches(*database_, run_id);
  transaction.commit();
}

void RunStore::insert_touch(std::int64_t run_id, const StoredTouch& touch) {
  OneUse insert(statements_->append_touch);
  row::bind_touch(*insert, run_id, touch);
  try {
    insert->exec();
  } catch (const SQLite::Exception& failure) {
    if (failure.getErrorCode() != SQLITE_CONSTRAINT || !row::has_answer(*database_, run_id, touch)) throw;
  }
}

void RunStore::withdraw_touch(std::int64_t run_id, int number, const std::string& reason) {
  row::WriteTransaction transaction(*database_);
  row::supersede(*database_, run_id, number, reason);
  row::note_touches(*database_, run_id);
  transaction.commit();
}

void RunStore::replace_touch(std::int64_t run_id, const StoredTouch& again, const std::string& reason) {
  row::WriteTransaction transaction(*database_);
  if (row::is_there(*database_, run_id, again)) return;
  row::supersede(*database_, run_id, again.number, reason);
  insert_touch(run_id, again);
  row::note_touches(*database_, run_id);
  transaction.commit();
}

void RunStore::confirm_touch(std::int64_t run_id, int number, const cs8::JointsMicrodeg& again) {
  row::WriteTransaction transaction(*database_);
  row::confirm(*database_, run_id, number, again);
  row::note_touches(*database_, run_id);
  transaction.commit();
}

void RunStore::append_reference(std::int64_t run_id, const ReferenceTouch& touch) {
  row::WriteTransaction transaction(*database_);
  if (row::is_there(*database_, run_id, touch)) return;
  row::insert_reference(*database_, run_id, touch);
  row::note_rows(*database_, run_id);
  transaction.commit();
}

void RunStore::append_resumption(std::int64_t run_id, const std::string& at, int touches_done) {
  row::WriteTransaction transaction(*database_);
  SQLite::Statement insert(*database_, "INSERT INTO resumptions(run_id, at, touches_done) VALUES(?, ?, ?)");
  insert.bind(1, run_id);
  insert.bind(2, at);
  insert.bind(3, touches_done);
  insert.exec();
  row::seal(*database_, row::resumption_rows(), "id", database_->getLastInsertRowid());
  row::note_rows(*database_, run_id);
  transaction.commit();
}

void RunStore::finish_run(std::int64_t run_id, const RunEnd& end) {
  row::WriteTransaction transaction(*database_);
  row::write_result(*database_, run_id, end.result_json, end.arm_json);
  row::end_run(*database_, run_id, [&] {
    SQLite::Statement update(*database_,
                             "UPDATE runs SET outcome = ?, verdict = ?, ended_at = ?, fault_code = ?, "
                             "fault_message = ? WHERE id = ?");
    update.bind(1, std::string(run_outcome_name(end.outcome)));
    update.bind(2, std::string(verdict_name(end.verdict)));
    update.bind(3, end.ended_at);
    row::bind_or_null(update, 4, end.fault_code);
    row::bind_or_null(update, 5, end.fault_message);
    update.bind(6, run_id);
    update.exec();
  });
  transaction.commit();
}

void RunStore::set_result_json(std::int64_t run_id, const std::string& result_json,
                               const std::optional<std::string>& arm_json) {
  row::WriteTransaction transaction(*database_);
  row::write_result(*database_, run_id, result_json, arm_json);
  row::note_touches(*database_, run_id);
  transaction.commit();
}

int RunStore::finish_interrupted(const std::string& now, std::optional<std::int64_t> but) {
  SQLite::Statement query(*database_, "SELECT id FROM runs WHERE outcome = ? AND id IS NOT ?");
  query.bind(1, std::string(run_outcome_name(RunOutcome::kRunning)));
  row::bind_or_null(query, 2, but);
  std::vector<std::int64_t> open;
  while (query.executeStep()) open.push_back(query.getColumn(0).getInt64());
  query.reset();
  if (open.empty()) return 0;  // nothing is written: a locked file does not keep the daemon from beginning
  row::WriteTransaction transaction(*database_);
  for (const std::int64_t run_id : open) {
    row::end_run(*database_, run_id, [&] {
      SQLite::Statement update(*database_,
                               "UPDATE runs SET outcome = ?, verdict = ?, ended_at = ? WHERE id = ?");
      update.bind(1, std::string(run_outcome_name(RunOutcome::kInterrupted)));
      update.bind(2, std::string(verdict_name(Verdict::kIncomplete)));
      update.bind(3, now);
      update.bind(4, run_id);
      update.exec();
    });
  }
  transaction.commit();
  return static_cast<int>(open.size());
}

}  // namespace cell
