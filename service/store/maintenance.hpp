#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

/// Copies the database of a running daemon, or of one that is down, into a new file; what is committed when
/// this begins is in it. std::runtime_error when the copy cannot be made; no half file stays then.
void back_up(const std::filesystem::path& database_file, const std::filesystem::path& copy);

/// What is wrong with a database file, one line each; empty when all is in order: pages, indices, foreign
/// keys, and every touch lies on a plane, in a role and from a source that there are. Changes nothing.
std::vector<std::string> find_damage(const std::filesystem::path& database_file);

/// Deletes the runs that began before `oldest` (as in format_utc()) with all that belongs to them, but for
/// the last accepted one and one that runs; how many. Faults and audit entries keep to their own bounds.
int delete_runs_before(const SharedDatabase& database, const std::string& oldest);

}  // namespace cell
