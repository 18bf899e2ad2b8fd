#include "service/store/internal/lock_wait.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <utility>

namespace cell::row {
namespace {

/// Between two looks at the lock.
constexpr std::chrono::milliseconds kLockStep{10};

void sleep_as_sqlite(std::chrono::milliseconds time) { sqlite3_sleep(static_cast<int>(time.count())); }

}  // namespace

LockWait::LockWait(SQLite::Database& database, LockTime time) : database_(database), time_(std::move(time)) {
  if (!time_.sleep) time_.sleep = sleep_as_sqlite;
  sqlite3_busy_handler(database_.getHandle(), &LockWait::on_locked, this);
}

LockWait::~LockWait() { sqlite3_busy_timeout(database_.getHandle(), static_cast<int>(kLockLook.count())); }

int LockWait::on_locked(void* self, int tries) {
  return static_cast<LockWait*>(self)->waits_on(tries) ? 1 : 0;
}

std::chrono::steady_clock::time_point LockWait::now() const {
  return time_.now ? time_.now() : std::chrono::steady_clock::time_point();
}

bool LockWait::waits_on(int tries) {
  if (tries == 0) waited_ = std::chrono::milliseconds(0);
  const std::int64_t changes = database_.getTotalChanges();
  const bool is_known_in_vain = in_vain_ && in_vain_->changes == changes && now() - in_vain_->at < kLockLapse;
  if (waited_ >= (is_brief_ || is_known_in_vain ? kLockLook : kLockPatience)) {
    if (!is_brief_ && !is_known_in_vain) in_vain_ = InVain{changes, now()};
    return false;
  }
  time_.sleep(kLockStep);
  waited_ += kLockStep;
  return true;
}

}  // namespace cell::row
