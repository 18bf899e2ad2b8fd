#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Transaction.h>

#include <chrono>
#include <cstdint>
#include <optional>

#include "service/store/run_store.hpp"

namespace cell::row {

/// A transaction that writes, whatever it reads before: it meets another program's lock as it begins, where
/// LockWait waits for it.
class WriteTransaction : public SQLite::Transaction {
 public:
  explicit WriteTransaction(SQLite::Database& database)
      : SQLite::Transaction(database, SQLite::TransactionBehavior::IMMEDIATE) {}
};

/// Who writes over this connection waits for a lock of another program, on the thread that writes: up to
/// kLockPatience for each lock. Once that was in vain, what follows waits kLockLook only, until a write of
/// the connection has gone through or kLockLapse is over: work that has queued up under a lasting lock is not
/// held up by each of it again.
class LockWait {
 public:
  static constexpr std::chrono::milliseconds kLockLook{100};

  /// `database` must outlive it; its own wait is set to kLockLook with the end. Without LockTime::sleep:
  /// SQLite's.
  LockWait(SQLite::Database& database, LockTime time);
  ~LockWait();
  LockWait(const LockWait&) = delete;
  LockWait& operator=(const LockWait&) = delete;

  /// Waits kLockLook at most in its lifetime: for what need not be done now.
  class Brief {
   public:
    explicit Brief(LockWait& wait) : wait_(wait) { wait_.is_brief_ = true; }
    ~Brief() { wait_.is_brief_ = false; }
    Brief(const Brief&) = delete;
    Brief& operator=(const Brief&) = delete;

   private:
    LockWait& wait_;
  };

 private:
  static int on_locked(void* self, int tries);
  bool waits_on(int tries);
  [[nodiscard]] std::chrono::steady_clock::time_point now() const;

  SQLite::Database& database_;
  LockTime time_;
  std::chrono::milliseconds waited_{0};  // for the lock that is met now
  struct InVain {
    std::int64_t changes;  // of the connection
    std::chrono::steady_clock::time_point at;
  };
  std::optional<InVain> in_vain_;  // when waiting was in vain last
  bool is_brief_ = false;
};

}  // namespace cell::row
