#pragma once

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace touchcal::testing {

/// A new empty folder that goes with its test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "touchcal-e2e-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// One in it that only its owner may enter, with all on the way to it, as a daemon makes its own, whatever
  /// the mask of the test is.
  std::filesystem::path directory(const std::string& name) const {
    std::filesystem::path made = path_;
    for (const std::filesystem::path& step : std::filesystem::path(name)) {
      made /= step;
      std::filesystem::create_directory(made);
      std::filesystem::permissions(made, std::filesystem::perms::owner_all);
    }
    return made;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace touchcal::testing
