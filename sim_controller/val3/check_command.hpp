#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// As linters have them; 2 is for a command line that cannot be read.
enum CheckExit { kCheckClean = 0, kCheckFindings = 1, kCheckUnreadable = 3 };

struct CheckCommand {
  std::filesystem::path folder;  // of a project or of several, or a .pjx file
  std::optional<Version> language;
  bool json = false;  // SARIF instead of text
  std::string tool_version;
};

/// Checks every project in a folder and below; findings go to `out`, what keeps it from that to `errors`.
/// Exit code: kCheckClean when there is nothing above a note.
CheckExit run_check(const CheckCommand& command, std::ostream& out, std::ostream& errors);

/// "s6" as its last version, "s6.4" as that; nothing for what is none.
std::optional<Version> language_named(std::string_view text);

inline constexpr std::size_t kProjectsMax = 1000;
/// Files and folders that are looked at for projects.
inline constexpr std::size_t kEntriesMax = 200'000;

}  // namespace val3
