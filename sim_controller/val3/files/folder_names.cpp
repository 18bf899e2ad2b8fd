#include "sim_controller/val3/files/folder_names.hpp"

#include <algorithm>

namespace val3 {

std::string in_lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

bool is_absolute_path(std::string_view path) {
  return path.starts_with('/') || path.starts_with('\\') || (path.size() > 1 && path[1] == ':');
}

std::vector<std::string> path_parts(std::string_view path) {
  std::vector<std::string> result;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find_first_of("/\\"), path.size());
    if (end > 0 && path.substr(0, end) != ".") result.emplace_back(path.substr(0, end));
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return result;
}

const std::vector<std::string>& FolderNames::names_in(const std::filesystem::path& folder) {
  const auto [found, is_new] = listed_.try_emplace(folder);
  if (!is_new) return found->second;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (found->second.size() >= kNamesPerFolderMax) break;
    found->second.push_back(at->path().filename().string());
  }
  std::ranges::sort(found->second);
  return found->second;
}

std::optional<std::filesystem::path> FolderNames::find(const std::filesystem::path& base,
                                                       std::string_view relative, int levels_up) {
  if (is_absolute_path(relative) || relative.find('\0') != std::string_view::npos) return std::nullopt;
  std::filesystem::path at = base;
  int depth = 0;
  std::error_code error;
  for (const std::string& part : path_parts(relative)) {
    if (part == "..") {
      if (--depth < -levels_up) return std::nullopt;
      at = at.has_filename() ? at.parent_path() : at.parent_path().parent_path();
      continue;
    }
    ++depth;
    if (std::filesystem::exists(at / part, error)) {
      at /= part;
      continue;
    }
    const auto& names = names_in(at);
    const auto found = std::ranges::find(names, in_lower_case(part), in_lower_case);
    if (found == names.end()) return std::nullopt;
    at /= *found;
  }
  return at;
}

}  // namespace val3
