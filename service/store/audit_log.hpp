#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/store/audit_chain.hpp"
#include "service/store/schema.hpp"

namespace cell {

/// Every command and every refusal. Those of strangers (who is "none" or "wrong token") are limited apart, so
/// that no flood of them displaces a command; the oldest of each are deleted, and each are a chain of their
/// own (audit_chain.hpp). Throws what the database throws.
class AuditLog {
 public:
  static constexpr int kKept = 100'000;
  static constexpr int kOfStrangersKept = 1000;

  explicit AuditLog(SharedDatabase database) : database_(std::move(database)) {}

  /// A command is durable on return; a refusal, of which there may be many, with the next commit.
  void append_command(const AuditEntry& entry) { append(entry, true); }
  void append_refusal(const AuditEntry& entry) { append(entry, false); }
  /// A refusal of somebody without a token of this daemon, not durable at once.
  void append_of_stranger(const AuditEntry& entry) { append(entry, false); }
  /// Newest first; only those before `before_id`, if given.
  [[nodiscard]] std::vector<AuditEntry> page(int limit, std::optional<std::int64_t> before_id = {}) const;

 private:
  void append(AuditEntry entry, bool at_once);
  void insert(const AuditEntry& entry);
  std::string drop_oldest(AuditChain chain, std::int64_t excess);

  SharedDatabase database_;
  std::array<std::optional<std::int64_t>, 2> counts_;  // of rows, by AuditChain; absent: not counted yet
};

}  // namespace cell
