#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <utility>

namespace cell {

/// A directory as its path named it when this was made. It may be moved away and another put in its place:
/// then the same path names what this process has never written.
class KnownDirectory {
 public:
  explicit KnownDirectory(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// What its path names now. One that was not there at first is gone whatever comes.
  enum class Found { kItself, kNothing, kAnother };
  [[nodiscard]] Found look() const;

 private:
  /// The device and the number on it, which a directory keeps where it is moved.
  using Identity = std::pair<dev_t, ino_t>;
  [[nodiscard]] std::optional<Identity> identity_now() const;

  std::filesystem::path path_;
  std::optional<Identity> identity_;
};

}  // namespace cell
