#include "service/base/known_directory.hpp"

#include <sys/stat.h>

namespace cell {

KnownDirectory::KnownDirectory(std::filesystem::path path)
    : path_(std::move(path)), identity_(identity_now()) {}

KnownDirectory::Found KnownDirectory::look() const {
  const auto now = identity_now();
  if (!now || !identity_) return Found::kNothing;
  return *now == *identity_ ? Found::kItself : Found::kAnother;
}

std::optional<KnownDirectory::Identity> KnownDirectory::identity_now() const {
  struct stat found = {};
  if (::stat(path_.c_str(), &found) != 0) return std::nullopt;
  return Identity{found.st_dev, found.st_ino};
}

}  // namespace cell
