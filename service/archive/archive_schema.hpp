#pragma once

#include <string>

namespace cell {

/// Makes the tables of an archive, or brings them to the newest version, all or nothing; returns what was
/// done, a sentence. `url`: of the owner of the database, who may make roles. Throws std::runtime_error where
/// that fails, and for an archive of a newer version.
std::string prepare_archive(const std::string& url);

/// The version of the tables that this program knows.
int newest_archive_schema();

}  // namespace cell
