#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace cell {

/// Makes the file of a database, where there is none, for its owner only whatever the mask is: it tells names
/// and addresses. SQLite gives the files that it makes beside it the same rights. One that cannot be made is
/// told by who opens it. A file that is there is not opened: closing it would end SQLite's locks on it.
inline void make_for_owner_only(const std::filesystem::path& file) {
  const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (made >= 0) ::close(made);
}

/// Takes the rights of others from the files of a database, which an older version gave them. Throws
/// std::runtime_error, with the remedy, where that cannot be done; not on a file system without rights of its
/// own (EPERM for the owner), where those of the mount count.
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
