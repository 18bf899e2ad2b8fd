#include "service/store/audit_log.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>

#include "service/store/internal/audit_row.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/relaxed_durability.hpp"

namespace cell {

void AuditLog::insert(const AuditEntry& entry) {
  SQLite::Statement insert(*database_,
                           "INSERT INTO audit(at, who, token_name, operator_name, remote, action, outcome, "
                           "detail, hash) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, entry.at);
  insert.bind(2, entry.who);
  insert.bind(3, entry.token_name);
  insert.bind(4, entry.operator_name);
  insert.bind(5, entry.remote);
  insert.bind(6, entry.action);
  insert.bind(7, entry.outcome);
  insert.bind(8, entry.detail);
  insert.bind(9, entry.hash);
  insert.exec();
}

/// Deletes so many of the oldest rows of a chain; returns the hash of the last of them.
std::string AuditLog::drop_oldest(AuditChain chain, std::int64_t excess) {
  SQLite::Statement last(*database_, std::string("SELECT id, hash FROM audit WHERE ") + kAuditChainSql +
                                         " = ? ORDER BY id LIMIT 1 OFFSET ?");
  last.bind(1, static_cast<int>(chain));
  last.bind(2, excess - 1);
  if (!last.executeStep()) return {};
  std::string anchor = last.getColumn(1).getString();
  SQLite::Statement drop(*database_,
                         std::string("DELETE FROM audit WHERE ") + kAuditChainSql + " = ? AND id <= ?");
  drop.bind(1, static_cast<int>(chain));
  drop.bind(2, last.getColumn(0).getInt64());
  last.reset();
  drop.exec();
  return anchor;
}

void AuditLog::append(AuditEntry entry, bool at_once) {
  std::optional<RelaxedDurability> unsynced;
  if (!at_once) unsynced.emplace(*database_);
  const AuditChain chain = chain_of(entry);
  const std::int64_t kept = chain == AuditChain::kOfStrangers ? kOfStrangersKept : kKept;
  row::WriteTransaction transaction(*database_);
  auto& count = counts_.at(static_cast<std::size_t>(chain));
  if (!count) {  // what is there from earlier starts
    SQLite::Statement rows(*database_,
                           std::string("SELECT count(*) FROM audit WHERE ") + kAuditChainSql + " = ?");
    rows.bind(1, static_cast<int>(chain));
    rows.executeStep();
    count = rows.getColumn(0).getInt64();
  }
  AuditChainEnds ends = read_chain_ends(*database_, chain);
  entry.hash = audit_hash(ends.newest, entry);
  ends.newest = entry.hash;
  insert(entry);
  const std::int64_t excess = std::max<std::int64_t>(*count + 1 - kept, 0);
  if (excess > 0) ends.anchor = drop_oldest(chain, excess);
  write_chain_ends(*database_, chain, ends);
  transaction.commit();
  *count += 1 - excess;
}

std::vector<AuditEntry> AuditLog::page(int limit, std::optional<std::int64_t> before_id) const {
  SQLite::Statement query(*database_, std::string("SELECT ") + row::kAuditColumns +
                                          " FROM audit WHERE id < ? ORDER BY id DESC LIMIT ?");
  query.bind(1, before_id.value_or(INT64_MAX));
  query.bind(2, limit);
  std::vector<AuditEntry> found;
  while (query.executeStep()) found.push_back(row::audit_entry_in(query));
  return found;
}

}  // namespace cell
