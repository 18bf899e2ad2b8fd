#include "service/store/fault_log.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "service/store/damaged_store.hpp"
#include "service/store/internal/fact.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/relaxed_durability.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_count.hpp"
#include "service/store/internal/row_text.hpp"

namespace cell {

namespace {

/// The code of the fault that is told where nothing can be stored (run/fault_table.cpp).
constexpr const char* kLostCode = "store_failed";

}  // namespace

void FaultLog::insert(const StoredFault& fault) {
  SQLite::Statement insert(*database_, "INSERT INTO faults(run_id, at, code, message) VALUES(?, ?, ?, ?)");
  if (fault.run_id) insert.bind(1, *fault.run_id);
  insert.bind(2, fault.at);
  insert.bind(3, fault.code);
  insert.bind(4, fault.message);
  insert.exec();
  const std::int64_t id = database_->getLastInsertRowid();
  row::seal(*database_, row::fault_rows(), "id", id);
  row::append_fact(*database_,
                   {FactKind::kFault, fault.at, fault.run_id, row::fault_body(fault.code, fault.message)});
  newest_ = id;
}

/// What waits, all or nothing.
void FaultLog::store_all() try {
  const RelaxedDurability unsynced(*database_);
  row::WriteTransaction transaction(*database_);
  auto came = static_cast<std::int64_t>(waiting_.size());
  for (const StoredFault& fault : waiting_) insert(fault);
  if (lost_ > 0) {
    ++came;
    insert({.run_id = {},
            .at = waiting_.back().at,
            .code = kLostCode,
            .message = std::to_string(lost_) + " more faults up to now could not be stored"});
  }
  SQLite::Statement drop(*database_, "DELETE FROM faults WHERE id <= ?");
  drop.bind(1, newest_ - kKept);
  row::change_row_count(*database_, row::CountedTable::kFaults, came - drop.exec());
  transaction.commit();
  waiting_.clear();
  lost_ = 0;
} catch (...) {
  changes_ = database_->getTotalChanges();
  throw;
}

void FaultLog::append(std::optional<std::int64_t> run_id, const std::string& at, const std::string& code,
                      const std::string& message) {
  waiting_.push_back({.run_id = run_id, .at = at, .code = code, .message = message});
  try {
    store_all();
  } catch (const std::exception&) {
    if (waiting_.size() > kWaitingMax) {
      waiting_.pop_back();
      ++lost_;
    }
    throw;
  }
}

bool FaultLog::store_waiting() {
  if (waiting_.empty()) return true;
  // Not at each call: each may wait for a lock, or for a disk that is still full.
  if (database_->getTotalChanges() == changes_) return false;
  try {
    store_all();
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

std::vector<StoredFault> FaultLog::page(int limit, std::optional<std::int64_t> before_id,
                                        std::optional<std::int64_t> run_id) const {
  SQLite::Statement query(*database_, "SELECT id, run_id, at, code, message, " +
                                          row::fault_rows().is_whole() +
                                          " FROM faults WHERE id < ?1 AND "
                                          "(?2 IS NULL OR run_id = ?2) ORDER BY id DESC LIMIT ?3");
  query.bind(1, before_id.value_or(INT64_MAX));
  if (run_id) query.bind(2, *run_id);
  query.bind(3, limit);
  std::vector<StoredFault> found;
  while (query.executeStep()) {
    const SQLite::Column run = query.getColumn(1);
    if (query.getColumn(5).getInt() != 1)
      throw DamagedStore(database_->getFilename(), "table faults, number " + query.getColumn(0).getString(),
                         row::kOtherChecksum);
    found.push_back({.id = query.getColumn(0).getInt64(),
                     .run_id = run.isNull() ? std::nullopt : std::optional(run.getInt64()),
                     .at = query.getColumn(2).getString(),
                     .code = query.getColumn(3).getString(),
                     .message = query.getColumn(4).getString()});
  }
  return found;
}

}  // namespace cell
