#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/config/folder.hpp"

namespace cell {

/// A PostgreSQL 15 of its own in a temporary folder, on a Unix socket there. As root it runs as the user
/// `postgres` of Debian's package, since it refuses root.
class Postgres {
 public:
  /// `settings`: as postgresql.conf has them, "wal_level=logical".
  explicit Postgres(std::vector<std::string> settings = {});
  ~Postgres();
  Postgres(const Postgres&) = delete;
  Postgres& operator=(const Postgres&) = delete;

  void start();
  /// As at a power cut.
  void kill();
  /// As its owner; the rows affected.
  std::size_t sql(const std::string& text) const;
  /// Of a user of the database: `postgres` owns it, others have to be made.
  [[nodiscard]] std::string url(const std::string& user = "postgres") const;

 private:
  void run(const std::vector<std::string>& call) const;

  std::vector<std::string> settings_;
  Folder folder_;
  pid_t pid_ = -1;
};

}  // namespace cell
