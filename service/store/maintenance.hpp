#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

/// Copies the database into a new file, also beside a running daemon; everything committed before the call is
/// in the copy. The place of the block, which lies beside the database, is copied to the file of the same
/// name with ".place.json" behind it. Throws std::runtime_error if it fails, DamagedStore if that is the
/// database's; no partial file remains.
void back_up(const std::filesystem::path& database_file, const std::filesystem::path& copy);

/// Throws std::runtime_error, with what to do, for a state directory that was in use (what mark_begun() left,
/// the place of the block or both tokens are there) and whose database is missing or empty: it would begin as
/// if nothing had been.
void refuse_lost_store(const std::filesystem::path& state_directory);

/// Leaves a file beside the database, where there is none, that tells that one was begun there. Throws
/// std::runtime_error if it cannot be written.
void mark_begun(const std::filesystem::path& state_directory);

/// Nobody can say here whether a database is damaged.
class StoreNotChecked : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Damage of a database file, one line each; empty if there is none. Checks the log, pages, indices, foreign
/// keys, the checksum of every row, that no row of an ended run, no fault and no answer is gone, plane, role
/// and source of every touch, the approved models, and the chains of the audit. Read-only, also on a disk
/// that cannot be written; StoreNotChecked where a log lies beside the file there, which only a writer can
/// put into it, and for a file of a newer version.
std::vector<std::string> find_damage(const std::filesystem::path& database_file);

/// The log beside a database holds what is not in it yet, and cannot be read without leaving a trace.
class StoreLogNotRead : public StoreNotChecked {
 public:
  using StoreNotChecked::StoreNotChecked;
};

/// Of a larger database, with its log, look_without_trace() looks at the pages only: it stands in the way of
/// every start of the service. The rows of so much take a processor about a second.
inline constexpr std::uintmax_t kLookedAtBytesMax = 64ULL * 1024 * 1024;

/// What is wrong with a database, as far as it was looked at.
struct StoreLook {
  std::optional<std::string> unusable;  // why a daemon cannot open it: it is no database, or its pages
  std::vector<std::string> damage;      // the rest of what find_damage() sees; a daemon starts all the same
  bool is_whole = true;                 // false: for more than `unusable` it is too large
};

/// Changes no file and makes none, also beside a running daemon; StoreLogNotRead where that cannot be done,
/// StoreNotChecked for a file of a newer version. `whole_up_to`: bytes.
StoreLook look_without_trace(const std::filesystem::path& database_file,
                             std::uintmax_t whole_up_to = kLookedAtBytesMax);

/// Free bytes on the disk of the database; nothing where its directory is no longer there.
std::optional<std::uintmax_t> disk_room_bytes(const SharedDatabase& database);

/// So many of the last runs stay however old they are.
inline constexpr int kLastRunsKept = 10;

/// On so many days, or all that are kept where those are fewer, runs must have begun since the date before
/// which others are deleted.
inline constexpr int kDaysThatAgree = 3;

/// Deletes the runs that began before `oldest` (as in format_utc()) with all their rows, except the last
/// accepted run of this daemon and one with a model that was ever approved, each with its proofs and checks,
/// a running one, one that was imported since, one with a fact that not all `sinks` have confirmed, and the
/// last kLastRunsKept; returns how many. What is deleted does not come back, so no clock is believed alone:
/// where runs began on fewer than `days_that_agree` days since `oldest`, nothing is deleted. More likely than
/// a cell at rest is a clock that stands years ahead, at this start of the daemon or at one before that made
/// some runs. Faults and audit entries have their own limits.
int delete_runs_before(const SharedDatabase& database, const std::string& oldest,
                       int days_that_agree = kDaysThatAgree, const std::vector<std::string>& sinks = {});

}  // namespace cell
