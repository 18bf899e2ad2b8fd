#include "service/store/audit_chain.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <optional>

#include "service/base/digest.hpp"
#include "service/store/internal/audit_row.hpp"

namespace cell {
namespace {

constexpr std::array kAuditChains{AuditChain::kOfTokens, AuditChain::kOfStrangers};

/// The rows of a chain, oldest first.
SQLite::Statement rows_of(SQLite::Database& database, AuditChain chain) {
  const bool has_names = row::audit_has_column(database, "token_name");
  SQLite::Statement rows(database, std::string("SELECT ") +
                                       (has_names ? row::kAuditColumns : row::kAuditColumnsWithoutTokenName) +
                                       " FROM audit WHERE " + kAuditChainSql + " = ? ORDER BY id");
  rows.bind(1, static_cast<int>(chain));
  return rows;
}

std::optional<std::string> first_break(SQLite::Database& database, AuditChain chain) {
  const AuditChainEnds ends = read_chain_ends(database, chain);
  std::string before = ends.anchor;
  std::string place = "the audit's first row";
  SQLite::Statement rows = rows_of(database, chain);
  while (rows.executeStep()) {
    const AuditEntry entry = row::audit_entry_in(rows);
    place = "audit, row " + std::to_string(entry.id);
    if (entry.hash != audit_hash(before, entry))
      return place + ": it was changed or put in, or a row before it was taken out";
    before = entry.hash;
  }
  if (before == ends.newest) return std::nullopt;
  return place + ": rows behind it were taken out";
}

}  // namespace

AuditChain chain_of(const AuditEntry& entry) {
  return entry.who == "none" || entry.who == "wrong token" ? AuditChain::kOfStrangers : AuditChain::kOfTokens;
}

AuditChainEnds read_chain_ends(SQLite::Database& database, AuditChain chain) {
  SQLite::Statement query(database, "SELECT anchor, newest FROM audit_chains WHERE chain = ?");
  query.bind(1, static_cast<int>(chain));
  if (!query.executeStep()) return {};
  return {.anchor = query.getColumn(0).getString(), .newest = query.getColumn(1).getString()};
}

void write_chain_ends(SQLite::Database& database, AuditChain chain, const AuditChainEnds& ends) {
  SQLite::Statement write(database, "INSERT OR REPLACE INTO audit_chains VALUES(?, ?, ?)");
  write.bind(1, static_cast<int>(chain));
  write.bind(2, ends.anchor);
  write.bind(3, ends.newest);
  write.exec();
}

std::string audit_hash(const std::string& hash_before, const AuditEntry& entry) {
  std::string text = hash_before;
  const auto add = [&](const std::string& field) { text += std::to_string(field.size()) + ":" + field; };
  for (const std::string* field : {&entry.at, &entry.who, &entry.operator_name, &entry.remote, &entry.action,
                                   &entry.outcome, &entry.detail})
    add(*field);
  if (!entry.token_name.empty()) add(entry.token_name);
  return sha256_hex(text);
}

void chain_audit_rows(SQLite::Database& database) {
  SQLite::Statement set(database, "UPDATE audit SET hash = ? WHERE id = ?");
  for (const AuditChain chain : kAuditChains) {
    AuditChainEnds ends;
    SQLite::Statement rows = rows_of(database, chain);
    while (rows.executeStep()) {
      const AuditEntry entry = row::audit_entry_in(rows);
      ends.newest = audit_hash(ends.newest, entry);
      set.bind(1, ends.newest);
      set.bind(2, entry.id);
      set.exec();
      set.reset();
    }
    write_chain_ends(database, chain, ends);
  }
}

std::vector<std::string> find_audit_damage(SQLite::Database& database) {
  std::vector<std::string> damage;
  if (!row::audit_has_column(database, "hash")) return damage;
  for (const AuditChain chain : kAuditChains)
    if (auto found = first_break(database, chain)) damage.push_back(*std::move(found));
  return damage;
}

}  // namespace cell
