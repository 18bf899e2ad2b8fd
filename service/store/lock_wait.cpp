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

LockWait::LockWait(SQLite::Database& database, LockSleep sleep)
    : database_(database), sleep_(sleep ? std::move(sleep) : LockSleep(sleep_as_sqlite)) {
  sqlite3_busy_handler(database_.getHandle(), &LockWait::on_locked, this);
}

LockWait::~LockWait() { sqlite3_busy_timeout(database_.getHandle(), static_cast<int>(kLockLook.count())); }

int LockWait::on_locked(void* self, int tries) {
  return static_cast<LockWait*>(self)->waits_on(tries) ? 1 : 0;
}

bool LockWait::waits_on(int tries) {
  if (tries == 0) waited_ = std::chrono::milliseconds(0);
  const std::int64_t changes = database_.getTotalChanges();
  const bool is_known_in_vain = in_vain_at_ == changes;
  if (waited_ >= (is_brief_ || is_known_in_vain ? kLockLook : kLockPatience)) {
    if (!is_brief_) in_vain_at_ = changes;
    return false;
  }
  sleep_(kLockStep);
  waited_ += kLockStep;
  return true;
}

}  // namespace cell::row
