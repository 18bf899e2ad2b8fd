#pragma once

#include <filesystem>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What a folder holds, and all that is wrong with its files.
struct ReadApplication {
  Application application;
  Findings findings;  // of files, forms, declarations and syntax
};

/// Reads a project (.pjx, or its folder) of VAL3 s5 to s8 with its data, programs, libraries and user types,
/// and parses its programs. Nothing in a file makes it fail: what cannot be read is left out and found. A
/// library that is not beside the project is left null; so is one that is on its way of being read.
/// Limits: kFileBytesMax a file, kFilesMax files, libraries nested kLibrariesDeepMax.
ReadApplication read_application(const std::filesystem::path& project_or_folder);

inline constexpr std::size_t kFileBytesMax = 16U << 20U;
inline constexpr std::size_t kFilesMax = 20'000;
inline constexpr int kLibrariesDeepMax = 8;

}  // namespace val3
