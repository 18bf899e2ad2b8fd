#include "service/store/audit_log.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "service/store/internal/relaxed_durability.hpp"

namespace cell {

void AuditLog::append(const AuditEntry& entry, bool at_once) {
  std::optional<RelaxedDurability> unsynced;
  if (!at_once) unsynced.emplace(*database_);
  SQLite::Transaction transaction(*database_);
  SQLite::Statement insert(
      *database_, "INSERT INTO audit(at, who, remote, action, outcome, detail) VALUES(?, ?, ?, ?, ?, ?)");
  insert.bind(1, entry.at);
  insert.bind(2, entry.who);
  insert.bind(3, entry.remote);
  insert.bind(4, entry.action);
  insert.bind(5, entry.outcome);
  insert.bind(6, entry.detail);
  insert.exec();
  SQLite::Statement drop(*database_, "DELETE FROM audit WHERE id <= ?");
  drop.bind(1, database_->getLastInsertRowid() - kKept);
  drop.exec();
  transaction.commit();
}

std::vector<AuditEntry> AuditLog::page(int limit, std::optional<std::int64_t> before_id) const {
  SQLite::Statement query(*database_,
                          "SELECT id, at, who, remote, action, outcome, detail FROM audit WHERE id < ? "
                          "ORDER BY id DESC LIMIT ?");
  query.bind(1, before_id.value_or(INT64_MAX));
  query.bind(2, limit);
  std::vector<AuditEntry> found;
  while (query.executeStep()) {
    found.push_back({.id = query.getColumn(0).getInt64(),
                     .at = query.getColumn(1).getString(),
                     .who = query.getColumn(2).getString(),
                     .remote = query.getColumn(3).getString(),
                     .action = query.getColumn(4).getString(),
                     .outcome = query.getColumn(5).getString(),
                     .detail = query.getColumn(6).getString()});
  }
  return found;
}

}  // namespace cell
