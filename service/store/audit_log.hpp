#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

/// Who asked for what, from where, and what came of it.
struct AuditEntry {
  std::int64_t id = 0;  // given by append()
  std::string at;       // RFC 3339
  std::string who;      // role: "operate", "view", "none"; with the operator's name where it was told
  std::string remote;   // address
  std::string action;   // "POST /api/v1/runs"
  std::string outcome;  // "201", "401 token"
  std::string detail;   // one line, may be empty
};

/// Every command and every refusal, oldest dropped. Throws what the database throws.
class AuditLog {
 public:
  static constexpr int kKept = 100'000;

  explicit AuditLog(SharedDatabase database) : database_(std::move(database)) {}

  /// A command is durable when this returns; a refusal, of which there may be a flood, with the next commit.
  void append_command(const AuditEntry& entry) { append(entry, true); }
  void append_refusal(const AuditEntry& entry) { append(entry, false); }
  /// Newest first; only those before `before_id` when given.
  [[nodiscard]] std::vector<AuditEntry> page(int limit, std::optional<std::int64_t> before_id = {}) const;

 private:
  void append(const AuditEntry& entry, bool at_once);

  SharedDatabase database_;
};

}  // namespace cell
