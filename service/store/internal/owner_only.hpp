#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace cell {

/// Takes the rights of others from the files of a database, which tell names and addresses: from one that was
/// just made with those of the mask, and from those of an older version. SQLite gives the files that it makes
/// beside it the rights of the database. By its path, as to open and close it would end SQLite's locks.
/// Throws std::runtime_error, with the remedy, where that cannot be done; not on a file system without rights
/// of its own (EPERM for the owner), where those of the mount count.
inline void keep_for_owner_only(const std::filesystem::path& file) {
  for (const char* behind : {"", "-wal", "-shm"}) {
    const std::string one = file.string() + behind;
    struct stat found = {};
    if (::stat(one.c_str(), &found) != 0 || (found.st_mode & (S_IRWXG | S_IRWXO)) == 0) continue;
    if (::chmod(one.c_str(), S_IRUSR | S_IWUSR) != 0 && found.st_uid != ::geteuid())
      throw std::runtime_error(one +
                               ": others have access, and this user cannot change that; chown it to the "
                               "user that touchcald runs as, then chmod 600");
  }
}

}  // namespace cell
