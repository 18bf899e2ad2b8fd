#include "service/store/fault_log.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "service/store/internal/relaxed_durability.hpp"

namespace cell {

void FaultLog::append(std::optional<std::int64_t> run_id, const std::string& at, const std::string& code,
                      const std::string& message) {
  const RelaxedDurability unsynced(*database_);
  SQLite::Transaction transaction(*database_);
  SQLite::Statement insert(*database_, "INSERT INTO faults(run_id, at, code, message) VALUES(?, ?, ?, ?)");
  if (run_id) insert.bind(1, *run_id);
  insert.bind(2, at);
  insert.bind(3, code);
  insert.bind(4, message);
  insert.exec();
  SQLite::Statement drop(*database_, "DELETE FROM faults WHERE id <= ?");
  drop.bind(1, database_->getLastInsertRowid() - kKept);
  drop.exec();
  transaction.commit();
}

std::vector<StoredFault> FaultLog::page(int limit, std::optional<std::int64_t> before_id,
                                        std::optional<std::int64_t> run_id) const {
  SQLite::Statement query(*database_,
                          "SELECT id, run_id, at, code, message FROM faults WHERE id < ?1 AND "
                          "(?2 IS NULL OR run_id = ?2) ORDER BY id DESC LIMIT ?3");
  query.bind(1, before_id.value_or(INT64_MAX));
  if (run_id) query.bind(2, *run_id);
  query.bind(3, limit);
  std::vector<StoredFault> found;
  while (query.executeStep()) {
    const SQLite::Column run = query.getColumn(1);
    found.push_back({.id = query.getColumn(0).getInt64(),
                     .run_id = run.isNull() ? std::nullopt : std::optional(run.getInt64()),
                     .at = query.getColumn(2).getString(),
                     .code = query.getColumn(3).getString(),
                     .message = query.getColumn(4).getString()});
  }
  return found;
}

}  // namespace cell
