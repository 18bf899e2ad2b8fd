#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "service/store/schema.hpp"

/// A checksum for each row that a run rests on: SQLite finds damage of its pages, not of what is in them.
namespace cell::row {

/// Rows with a checksum, all in SQL. The checksum covers `name`, which keeps rows of tables apart, and
/// `columns`.
struct CheckedRows {
  std::string name;
  std::string table;
  std::string columns;   // in this order
  std::string checksum;  // the column that has it
  std::string run;       // the run of a row, "NULL" where there is none
  std::string number;    // the row within its run; "NULL" for the only one
  std::string applies;   // which rows have one: a condition

  /// The checksum that a row should have.
  [[nodiscard]] std::string computed() const;
  /// 1 for a row that is as it was written, else 0.
  [[nodiscard]] std::string is_whole() const;
  /// " VALUES(?1, ?2, ..., checksum of them all)": one statement writes the `count` columns and the checksum.
  [[nodiscard]] std::string values(int count) const;
};

const CheckedRows& touch_rows();
const CheckedRows& superseded_rows();
const CheckedRows& reference_rows();
const CheckedRows& plan_change_rows();
const CheckedRows& open_command_rows();
const CheckedRows& plan_rows();
/// Without the result; as they are in a file of this schema.
const CheckedRows& run_rows(std::size_t schema = kRunKindSchema);
const CheckedRows& result_rows();  // of the table of the runs
const CheckedRows& arm_rows();
const CheckedRows& model_rows();  // from kModelSchema on
const CheckedRows& fault_rows();  // these five from kLogChecksumSchema on
const CheckedRows& resumption_rows();
const CheckedRows& answer_rows();
const CheckedRows& refused_rows();
const CheckedRows& row_count_rows();
const CheckedRows& import_rows();  // from kImportSchema on
/// Of a file of this schema, kChecksumSchema or later.
std::span<const CheckedRows* const> all_checked_rows(std::size_t schema);

/// Of a row of runs: how many rows it has in each table, as kept with a run that ended. A row that is gone
/// shows in it. In a file of this schema.
const std::string& rows_of_run(std::size_t schema = kLogChecksumSchema);
/// 1 unless a run that ended has other rows than it had.
const std::string& has_its_rows(std::size_t schema = kLogChecksumSchema);

/// Makes row_checksum(...), which the SQL above calls, known to a connection. The checksum (FNV-1a, 64 bit)
/// tells types and lengths apart; it finds damage, it does not prevent forgery.
void add_checksum_function(SQLite::Database& database);

/// Writes the checksums of the rows that have none, as in a file of this schema.
void fill_checksums(SQLite::Database& database, std::size_t schema);

/// Brings the checksums of touches to this schema from the one before, which had fewer columns. A row that
/// was damaged before stays known as such.
void reseal_touches(SQLite::Database& database, std::size_t schema);

/// Brings the checksums of runs to kRunKindSchema from the one before, likewise.
void reseal_runs(SQLite::Database& database);

/// Brings a file to kLogChecksumSchema from the one before: checksums for the rows that have none, and what
/// the runs that ended have of rows. A run that was damaged before stays known as such.
void seal_logs(SQLite::Database& database);

/// Writes the checksum of the rows where `condition` (SQL) holds for `key`.
void seal(SQLite::Database& database, const CheckedRows& rows, const std::string& condition,
          std::int64_t key);

}  // namespace cell::row
