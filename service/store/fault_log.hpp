#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

struct StoredFault {
  std::int64_t id = 0;
  std::optional<std::int64_t> run_id;
  std::string at;       // RFC 3339
  std::string code;     // FaultEntry::name
  std::string message;  // cause, then detail
};

/// Every fault, of runs and between them; the oldest are deleted. Throws what the database throws.
class FaultLog {
 public:
  static constexpr int kKept = 10'000;

  explicit FaultLog(SharedDatabase database) : database_(std::move(database)) {}

  /// Durable with the next stored touch: the arm must not wait for the disk.
  void append(std::optional<std::int64_t> run_id, const std::string& at, const std::string& code,
              const std::string& message);
  /// Newest first; only those before `before_id` and only those of a run, if given.
  [[nodiscard]] std::vector<StoredFault> page(int limit, std::optional<std::int64_t> before_id = {},
                                              std::optional<std::int64_t> run_id = {}) const;

 private:
  SharedDatabase database_;
};

}  // namespace cell
