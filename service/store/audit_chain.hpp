#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace SQLite {
class Database;
}

namespace cell {

/// Who requested what, from where, and the outcome.
struct AuditEntry {
  std::int64_t id = 0;        // given by AuditLog
  std::string at;             // RFC 3339
  std::string who;            // the token's role: "operate", "view"; "none" or "wrong token" for a stranger
  std::string token_name;     // of the token; empty where it has none
  std::string operator_name;  // of the run that the request is for; empty where nobody was named
  std::string remote;         // address
  std::string action;         // "POST /api/v1/runs"
  std::string outcome;        // "201", "401 token"
  std::string detail;         // one line, may be empty
  std::string hash;           // audit_hash(); given by AuditLog
};

/// The rows form two chains, since their oldest rows are deleted apart: those of strangers (who is "none" or
/// "wrong token"), and all others. Each row has the hash of its content with the hash of the row before it in
/// its chain, so that a row that was changed, put in or taken out shows at the next one. It is no signature:
/// who writes the whole file can write a whole chain; what has been exported tells it from the one before.
enum class AuditChain { kOfTokens = 0, kOfStrangers = 1 };
AuditChain chain_of(const AuditEntry& entry);

/// SQL that is 1 for a row of strangers and else 0; the index audit_of_chain is on it.
inline constexpr const char* kAuditChainSql = "(who IN ('none', 'wrong token'))";

/// Where a chain begins and ends: the hash of the last row that was deleted as the oldest, and of the newest
/// row. Both are empty where there is none.
struct AuditChainEnds {
  std::string anchor;
  std::string newest;
};
AuditChainEnds read_chain_ends(SQLite::Database& database, AuditChain chain);
void write_chain_ends(SQLite::Database& database, AuditChain chain, const AuditChainEnds& ends);

/// SHA-256, in hexadecimal, of the hash of the row before and then of at, who, operator_name, remote, action,
/// outcome, detail and, where there is one, token_name, each as its length in bytes, a colon and its text. So
/// the rows of a daemon whose tokens had no names keep their hashes.
std::string audit_hash(const std::string& hash_before, const AuditEntry& entry);

/// Chains the rows that an older daemon wrote. Within a transaction of the caller.
void chain_audit_rows(SQLite::Database& database);

/// The first row of each chain that does not follow from the one before it, a line each; empty if there is
/// none, and for a file of a daemon that chained nothing.
std::vector<std::string> find_audit_damage(SQLite::Database& database);

}  // namespace cell
