#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <string>

#include "service/store/audit_chain.hpp"

namespace cell::row {

/// Of the audit, in the order of audit_entry_in().
inline constexpr const char* kAuditColumns =
    "id, at, who, token_name, operator_name, remote, action, outcome, detail, hash";

/// The same of a file that an older daemon wrote, whose tokens had no names.
inline constexpr const char* kAuditColumnsWithoutTokenName =
    "id, at, who, '', operator_name, remote, action, outcome, detail, hash";

inline bool audit_has_column(SQLite::Database& database, const std::string& name) {
  SQLite::Statement query(database, "SELECT count(*) FROM pragma_table_info('audit') WHERE name = ?");
  query.bind(1, name);
  query.executeStep();
  return query.getColumn(0).getInt() > 0;
}

inline AuditEntry audit_entry_in(SQLite::Statement& row) {
  return {.id = row.getColumn(0).getInt64(),
          .at = row.getColumn(1).getString(),
          .who = row.getColumn(2).getString(),
          .token_name = row.getColumn(3).getString(),
          .operator_name = row.getColumn(4).getString(),
          .remote = row.getColumn(5).getString(),
          .action = row.getColumn(6).getString(),
          .outcome = row.getColumn(7).getString(),
          .detail = row.getColumn(8).getString(),
          .hash = row.getColumn(9).getString()};
}

}  // namespace cell::row
