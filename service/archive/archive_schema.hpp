#pragma once

#include <stdexcept>
#include <string>

namespace cell {

/// An archive that is there and does not do: of a newer version, not prepared, of another encoding, or
/// without the rights that are needed.
class ArchiveRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Makes the tables of an archive, or brings them to the newest version, all or nothing; returns what was
/// done, a sentence. `url`: of the owner of the database, who may make roles. Throws std::runtime_error where
/// that fails; ArchiveRefused for an archive of a newer version, a database that is not UTF-8, and who may
/// not.
std::string prepare_archive(const std::string& url);

/// The version of the tables that this program knows.
int newest_archive_schema();

}  // namespace cell
