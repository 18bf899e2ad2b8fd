#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace val3 {

/// Finds files by names whose letter case is another one on the disk: a controller's disk and Windows do not
/// mind it. Folders are listed once.
class FolderNames {
 public:
  /// `relative` has its parts separated by / or \. Empty when it is not there, is absolute, or leaves
  /// `base` by more than `levels_up` folders.
  std::optional<std::filesystem::path> find(const std::filesystem::path& base, std::string_view relative,
                                            int levels_up = 0);
  /// Names in a folder, sorted; empty when it cannot be read.
  const std::vector<std::string>& names_in(const std::filesystem::path& folder);

 private:
  std::map<std::filesystem::path, std::vector<std::string>> listed_;
};

std::string in_lower_case(std::string_view text);
/// The parts of a path that are separated by / or \, without empty ones and ".".
std::vector<std::string> path_parts(std::string_view path);
bool is_absolute_path(std::string_view path);

/// More names of a folder are not looked at.
inline constexpr std::size_t kNamesPerFolderMax = 100'000;

}  // namespace val3
