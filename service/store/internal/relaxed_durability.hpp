#pragma once

#include <SQLiteCpp/Database.h>

namespace cell {

/// Commits during its lifetime survive a crash of the process, but a power failure only after the next full
/// commit. Not inside a transaction.
class RelaxedDurability {
 public:
  explicit RelaxedDurability(SQLite::Database& database) : database_(database) {
    database_.exec("PRAGMA synchronous = NORMAL");
  }
  ~RelaxedDurability() { database_.tryExec("PRAGMA synchronous = FULL"); }
  RelaxedDurability(const RelaxedDurability&) = delete;
  RelaxedDurability& operator=(const RelaxedDurability&) = delete;

 private:
  SQLite::Database& database_;
};

}  // namespace cell
