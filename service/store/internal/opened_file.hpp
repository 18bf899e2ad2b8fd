#pragma once

#include <sys/stat.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace cell::row {

/// Which file stands at a path: its device and its inode; nothing where none does.
using FileAtPath = std::optional<std::pair<dev_t, ino_t>>;

inline FileAtPath file_at(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return std::pair{found.st_dev, found.st_ino};
}

/// SQLite goes on writing to a file that was moved or removed, where the next daemon does not find it.
inline void demand_file(const std::string& path, const FileAtPath& opened) {
  if (file_at(path) == opened) return;
  throw std::runtime_error(
      path +
      " was moved, removed or replaced since touchcald started; put it back, or stop the "
      "run and start touchcald again");
}

}  // namespace cell::row
