#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

/// Who requested what, from where, and the outcome.
struct AuditEntry {
  std::int64_t id = 0;  // given by append()
  std::string at;       // RFC 3339
  std::string who;      // role: "operate", "view", "none"; with the operator's name if known
  std::string remote;   // address
  std::string action;   // "POST /api/v1/runs"
  std::string outcome;  // "201", "401 token"
  std::string detail;   // one line, may be empty
};

/// Every command and every refusal; the oldest are deleted. Throws what the database throws.
class AuditLog {
 public:
  static constexpr int kKept = 100'000;

  explicit AuditLog(SharedDatabase database) : database_(std::move(database)) {}

  /// A command is durable on return; a refusal, of which there may be many, with the next commit.
  void append_command(const AuditEntry& entry) { append(entry, true); }
  void append_refusal(const AuditEntry& entry) { append(entry, false); }
  /// Newest first; only those before `before_id`, if given.
  [[nodiscard]] std::vector<AuditEntry> page(int limit, std::optional<std::int64_t> before_id = {}) const;

 private:
  void append(const AuditEntry& entry, bool at_once);

  SharedDatabase database_;
};

}  // namespace cell
