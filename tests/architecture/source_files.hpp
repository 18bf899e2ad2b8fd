#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

/// The tree as the architecture tests read it.
namespace architecture {

inline const std::filesystem::path kRoot = TOUCHCAL_SOURCE_DIR;

/// The five folders that hold the product's code.
inline const std::vector<std::string> kFolders{"calib_core", "cs8_protocol", "config", "sim_controller",
                                               "service"};

/// Every .hpp and .cpp below a folder of the tree.
inline std::vector<std::filesystem::path> source_files(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".hpp" || extension == ".cpp") files.push_back(entry.path());
  }
  return files;
}

inline std::vector<std::string> read_lines(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace architecture
