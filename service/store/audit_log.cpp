#include "service/store/audit_log.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>

#include "service/store/internal/relaxed_durability.hpp"

namespace cell {

namespace {

constexpr const char* kByStrangers = "who IN ('none', 'wrong token')";

}  // namespace

std::int64_t AuditLog::insert(const AuditEntry& entry) {
  SQLite::Statement insert(
      *database_, "INSERT INTO audit(at, who, remote, action, outcome, detail) VALUES(?, ?, ?, ?, ?, ?)");
  insert.bind(1, entry.at);
  insert.bind(2, entry.who);
  insert.bind(3, entry.remote);
  insert.bind(4, entry.action);
  insert.bind(5, entry.outcome);
  insert.bind(6, entry.detail);
  insert.exec();
  return database_->getLastInsertRowid();
}

/// What is there from earlier starts.
void AuditLog::count_rows() {
  if (count_) return;
  of_strangers_.clear();
  SQLite::Statement strangers(*database_,
                              std::string("SELECT id FROM audit WHERE ") + kByStrangers + " ORDER BY id");
  while (strangers.executeStep()) of_strangers_.push_back(strangers.getColumn(0).getInt64());
  count_ = database_->execAndGet("SELECT count(*) FROM audit").getInt64() -
           static_cast<std::int64_t>(of_strangers_.size());
}

void AuditLog::append(const AuditEntry& entry, bool at_once) {
  std::optional<RelaxedDurability> unsynced;
  if (!at_once) unsynced.emplace(*database_);
  SQLite::Transaction transaction(*database_);
  count_rows();
  insert(entry);
  const std::int64_t excess = std::max<std::int64_t>(*count_ + 1 - kKept, 0);
  if (excess > 0) {
    SQLite::Statement drop(*database_,
                           std::string("DELETE FROM audit WHERE id IN (SELECT id FROM audit WHERE NOT ") +
                               kByStrangers + " ORDER BY id LIMIT ?)");
    drop.bind(1, excess);
    drop.exec();
  }
  transaction.commit();
  *count_ += 1 - excess;
}

void AuditLog::append_of_stranger(const AuditEntry& entry) {
  const RelaxedDurability unsynced(*database_);
  SQLite::Transaction transaction(*database_);
  count_rows();
  const std::int64_t id = insert(entry);
  const std::size_t excess = of_strangers_.size() + 1 - std::min(of_strangers_.size() + 1, kOfStrangersKept);
  SQLite::Statement drop(*database_, "DELETE FROM audit WHERE id = ?");
  for (std::size_t i = 0; i < excess; ++i) {
    drop.reset();
    drop.bind(1, of_strangers_[i]);
    drop.exec();
  }
  transaction.commit();
  of_strangers_.erase(of_strangers_.begin(), of_strangers_.begin() + static_cast<std::ptrdiff_t>(excess));
  of_strangers_.push_back(id);
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
