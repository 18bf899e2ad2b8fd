#pragma once

#include <filesystem>
#include <string_view>

#include "sim_controller/val3/files/folder_names.hpp"

namespace val3 {

/// Where a library or a type is that a project names (language reference, 1.6).
struct LibraryPlace {
  enum class Is { kProject, kEncrypted, kOutside, kMissing };
  Is is = Is::kMissing;
  std::filesystem::path file;  // of kProject: its .pjx; of kEncrypted: its .zip
};

/// `Disk://folder/name/name.pjx`, `./name/name.pjx`, `folder/name` or `name`, looked for in the project's
/// folder, beside it and up to kFoldersUpMax folders above it: the folder of user applications is one of
/// these. Never elsewhere.
LibraryPlace find_library(FolderNames& names, const std::filesystem::path& project_folder,
                          std::string_view path);

inline constexpr int kFoldersUpMax = 4;

}  // namespace val3
