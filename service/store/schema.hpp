#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace SQLite {
class Database;
}

namespace cell {

/// One file per cell. Its tables (runs and touches, faults, audit, answers) share one connection, on one
/// thread.
using SharedDatabase = std::shared_ptr<SQLite::Database>;

/// SQL of each schema version, relative to the one before, from version 1 on.
std::span<const char* const> migrations();

/// From this schema on rows have checksums.
inline constexpr std::size_t kChecksumSchema = 6;

/// From this schema on a touch may have a noise of its own, which its checksum covers.
inline constexpr std::size_t kTouchNoiseSchema = 8;

/// From this schema on a touch may have a first contact and a repetition, which its checksum covers.
inline constexpr std::size_t kTouchContactsSchema = 10;

/// From this schema on there are models that a person approved.
inline constexpr std::size_t kModelSchema = 11;

/// From this schema on faults, resumptions and answers have checksums too, refused results are kept, and a
/// run counts both with its rows.
inline constexpr std::size_t kLogChecksumSchema = 12;

/// From this schema on facts for others than this cell are kept until they have heard of them.
inline constexpr std::size_t kOutboxSchema = 13;

/// From this schema on a run has a kind and may be of another run, which its checksum covers.
inline constexpr std::size_t kRunKindSchema = 14;

/// From this schema on runs of other daemons may be imported.
inline constexpr std::size_t kImportSchema = 15;

/// Opens or creates the file (WAL, synchronous FULL: a commit is durable on return) and migrates it to the
/// newest schema, all or nothing. Throws std::runtime_error that names the file if that fails, also for a
/// file of a newer schema, which is not changed.
SharedDatabase open_database(const std::filesystem::path& file);

/// A further connection to a file that open_database() has opened, for another thread: it reads what is
/// committed, never waits for a commit under way, and refuses to write. Throws std::runtime_error that names
/// the file.
SharedDatabase open_database_to_read(const std::filesystem::path& file);

}  // namespace cell
