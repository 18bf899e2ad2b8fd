#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>

#include "service/store/run_store.hpp"

namespace cell {

/// So many facts of one time behind those that there are, written at once: of their digests nothing is true.
inline void add_facts(const RunStore& store, std::int64_t count, const std::string& at) {
  SQLite::Database& database = *store.database();
  SQLite::Transaction transaction(database);
  SQLite::Statement insert(
      database,
      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < ?1) INSERT INTO "
      "outbox(instance, "
      "kind, at, run_id, previous, body, sha256) SELECT 1, 'fault', ?2, i, hex(zeroblob(32)), "
      "'{\"code\":\"link_lost\",\"message\":\"' || i || '\"}', hex(zeroblob(32)) FROM n");
  insert.bind(1, count);
  insert.bind(2, at);
  insert.exec();
  transaction.commit();
}

}  // namespace cell
