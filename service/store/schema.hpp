#pragma once

#include <filesystem>
#include <memory>
#include <span>

namespace SQLite {
class Database;
}

namespace cell {

/// One file for all that a cell keeps. Its parts (runs and touches, faults, audit, answers) share the one
/// connection, on one thread.
using SharedDatabase = std::shared_ptr<SQLite::Database>;

/// What each version of the schema adds to the one before, as SQL, from version 1 on.
std::span<const char* const> migrations();

/// Opens or creates the file (WAL, synchronous FULL: what a call wrote is durable when it returns) and brings
/// it to the newest schema, all or nothing. std::runtime_error, which names the file, when that cannot be,
/// also for the file of a newer schema, which is left as it is.
SharedDatabase open_database(const std::filesystem::path& file);

}  // namespace cell
