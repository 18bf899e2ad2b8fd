#include "sim_controller/val3/files/library_path.hpp"

#include <algorithm>

namespace val3 {
namespace {

bool ends_like(std::string_view path, std::string_view ending) {
  return path.size() >= ending.size() && in_lower_case(path.substr(path.size() - ending.size())) == ending;
}

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

/// The project of a folder: the one of its name, else the only one.
std::optional<std::filesystem::path> project_in(FolderNames& names, const std::filesystem::path& folder) {
  if (auto named = names.find(folder, folder.filename().string() + ".pjx")) return named;
  std::optional<std::filesystem::path> only;
  for (const std::string& name : names.names_in(folder)) {
    if (!ends_like(name, ".pjx")) continue;
    if (only) return std::nullopt;
    only = folder / name;
  }
  return only;
}

LibraryPlace place_below(FolderNames& names, const std::filesystem::path& base, const std::string& path) {
  using Is = LibraryPlace::Is;
  const auto found = names.find(base, path, kFoldersUpMax);
  if (found && is_file(*found)) return {ends_like(path, ".zip") ? Is::kEncrypted : Is::kProject, *found};
  if (found) {
    const auto project = project_in(names, *found);
    if (project && is_file(*project)) return {Is::kProject, *project};
  }
  for (const auto& [ending, is] : {std::pair{".pjx", Is::kProject}, {".zip", Is::kEncrypted}}) {
    const auto with_ending = names.find(base, path + ending, kFoldersUpMax);
    if (with_ending && is_file(*with_ending)) return {is, *with_ending};
  }
  return {};
}

}  // namespace

LibraryPlace find_library(FolderNames& names, const std::filesystem::path& project_folder,
                          std::string_view path) {
  const std::size_t root = path.find("://");
  const bool is_rooted = root != std::string_view::npos;
  // "/Libraries/x" is s5's way to begin at the folder of user applications.
  std::string_view below = is_rooted ? path.substr(root + 3) : path;
  while (below.starts_with('/') || below.starts_with('\\')) below.remove_prefix(1);
  if (is_absolute_path(below)) return {LibraryPlace::Is::kOutside, {}};
  const std::vector<std::string> parts = path_parts(below);
  if (std::ranges::count(parts, "..") > kFoldersUpMax) return {LibraryPlace::Is::kOutside, {}};
  if (parts.empty()) return {};
  const auto joined = [&parts](std::size_t from) {
    std::string result;
    for (std::size_t i = from; i < parts.size(); ++i) result += (result.empty() ? "" : "/") + parts[i];
    return result;
  };
  // A copy of a cell often leaves out the outer folders: then the innermost two say enough.
  std::vector<std::string> wanted{joined(0)};
  if (is_rooted && parts.size() > 2) wanted.push_back(joined(parts.size() - 2));
  for (const std::string& one : wanted) {
    std::filesystem::path base = project_folder;
    for (int up = 0; up <= kFoldersUpMax && base.has_relative_path(); ++up, base = base.parent_path()) {
      LibraryPlace place = place_below(names, base, one);
      if (place.is != LibraryPlace::Is::kMissing) return place;
    }
  }
  return {};
}

}  // namespace val3
