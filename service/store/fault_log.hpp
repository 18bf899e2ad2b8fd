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

/// Every fault, of runs and between them; the oldest are deleted. Throws what the database throws, and
/// DamagedStore for a row that is not as it was written.
class FaultLog {
 public:
  static constexpr int kKept = 10'000;
  /// Faults that could not be stored and wait for it; of further ones only the number is kept.
  static constexpr std::size_t kWaitingMax = 100;

  explicit FaultLog(SharedDatabase database) : database_(std::move(database)) {}

  /// Durable with the next stored touch: the arm must not wait for the disk. When it throws, the fault waits
  /// in memory and is stored with a later one or by store_waiting(), and how many were lost with it.
  void append(std::optional<std::int64_t> run_id, const std::string& at, const std::string& code,
              const std::string& message);
  /// Stores the faults that wait, once another write on this connection has gone on since they failed; what
  /// fails then is tried again in the same way. False while some wait. Does not throw.
  bool store_waiting();
  /// Newest first; only those before `before_id` and only those of a run, if given.
  [[nodiscard]] std::vector<StoredFault> page(int limit, std::optional<std::int64_t> before_id = {},
                                              std::optional<std::int64_t> run_id = {}) const;

 private:
  void store_all();
  void insert(const StoredFault& fault);

  SharedDatabase database_;
  std::vector<StoredFault> waiting_;  // oldest first
  std::int64_t newest_ = 0;           // id of the fault that was stored last
  std::int64_t lost_ = 0;             // that found no room in waiting_
  std::int64_t changes_ = 0;          // of the connection, when storing failed last
};

}  // namespace cell
