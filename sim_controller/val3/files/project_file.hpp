#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sim_controller/val3/files/xml_file.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// A larger stackSize is refused: no controller has so much for a task, and it would take this machine's
/// memory.
inline constexpr std::size_t kStackBytesMax = 16U << 20U;

/// What a project file (.pjx) lists. Language reference, 1.2.
struct ProjectFile {
  struct Listed {
    std::string file;
    int line = 0;
  };
  struct Other {
    std::string name;  // the alias of a library, the name of a type
    std::string path;
    bool autoload = true;
    int line = 0;
  };

  int form = 7;  // 5 (s5, s6) or 7 (s7, s8)
  std::string version;
  Version language;
  std::size_t stack_bytes = 5000;
  bool is_metric = true;
  std::vector<Listed> programs;
  std::vector<Listed> data;
  std::vector<Other> libraries;
  std::vector<Other> types;
};

/// Empty when the file is no project of a known form. What it says and must not is found, and left out.
std::optional<ProjectFile> read_project_file(const XmlFile& xml, FileFindings& findings);

/// "s7.7.2", "~VAL3:s5.4", "s8.13.1Cs9_BS2800". Empty when no version is in it.
std::optional<Version> version_in(std::string_view text);

}  // namespace val3
