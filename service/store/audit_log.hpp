#pragma once

#include <cstdint>
#include <deque>
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

/// Every command and every refusal. Those of strangers (who is "none" or "wrong token") are limited apart, so
/// that no flood of them displaces a command; the oldest of each are deleted. Throws what the database
/// throws.
class AuditLog {
 public:
  static constexpr int kKept = 100'000;
  static constexpr std::size_t kOfStrangersKept = 1000;

  explicit AuditLog(SharedDatabase database) : database_(std::move(database)) {}

  /// A command is durable on return; a refusal, of which there may be many, with the next commit.
  void append_command(const AuditEntry& entry) { append(entry, true); }
  void append_refusal(const AuditEntry& entry) { append(entry, false); }
  /// A refusal of somebody without a token of this daemon, not durable at once.
  void append_of_stranger(const AuditEntry& entry);
  /// Newest first; only those before `before_id`, if given.
  [[nodiscard]] std::vector<AuditEntry> page(int limit, std::optional<std::int64_t> before_id = {}) const;

 private:
  void append(const AuditEntry& entry, bool at_once);
  std::int64_t insert(const AuditEntry& entry);
  void count_rows();

  SharedDatabase database_;
  std::optional<std::int64_t> count_;      // without those of strangers; absent: not counted yet
  std::deque<std::int64_t> of_strangers_;  // oldest first
};

}  // namespace cell
