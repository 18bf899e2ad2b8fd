#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace cell {

/// Commits that may stand in a write-ahead log without having reached the disk, when power fails: as many
/// changes of a plan as the way to one touch makes, the command behind them, one that is taken back, and the
/// commit that is under way. The disk may have written any part of them.
inline constexpr int kUnsyncedCommitsMax = 11;

/// SQLite reads its write-ahead log up to the first frame that is not whole and drops the others without a
/// word. That is right behind a break-off; but where more commits than kUnsyncedCommitsMax stand whole behind
/// such a frame, more is missing than a run is ever ahead of the disk: one line that says so. Nothing
/// for a log that is whole, broken off, or not there. Ask before SQLite opens the database to write. Reads
/// the log only: to close the database file would end the locks that SQLite has on it in this process.
std::optional<std::string> find_log_damage(const std::filesystem::path& database_file);

}  // namespace cell
