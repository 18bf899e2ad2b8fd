#pragma once

#include <SQLiteCpp/Database.h>

namespace cell {

/// What is committed while this lives outlives the process, and with the next commit behind it the machine.
/// Not inside a transaction.
class Unsynced {
 public:
  explicit Unsynced(SQLite::Database& database) : database_(database) {
    database_.exec("PRAGMA synchronous = NORMAL");
  }
  ~Unsynced() { database_.tryExec("PRAGMA synchronous = FULL"); }
  Unsynced(const Unsynced&) = delete;
  Unsynced& operator=(const Unsynced&) = delete;

 private:
  SQLite::Database& database_;
};

}  // namespace cell
