// Arrows between the folders point one way: this table is the whole of what may include what.
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

/// First part of an include path of what a folder may use beside the standard library.
const std::map<std::string, std::set<std::string>> kMayInclude{
    {"calib_core", {"calib_core", "Eigen", "boost"}},
    {"cs8_protocol", {"cs8_protocol", "boost"}},
    {"config", {"config", "calib_core", "nlohmann", "Eigen"}},
    {"sim_controller",
     {"sim_controller", "config", "cs8_protocol", "calib_core", "boost", "spdlog", "CLI", "Eigen"}},
    {"service",
     {"service", "config", "cs8_protocol", "calib_core", "boost", "nlohmann", "spdlog", "SQLiteCpp", "CLI",
      "openssl", "prometheus", "systemd", "Eigen", "fcntl.h", "malloc.h", "spawn.h", "unistd.h", "sys"}},
};

/// Compiling one of these takes seconds: headers that many include leave them to the .cpp files.
const std::set<std::string> kNotInHeaders{"boost/beast.hpp", "nlohmann/json.hpp"};

std::optional<std::string> included(const std::string& line) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::smatch match;
  return std::regex_search(line, match, kInclude) ? std::optional(match[1].str()) : std::nullopt;
}

/// A standard header has neither folder nor extension.
bool is_standard(const std::string& header) { return header.find_first_of("/.") == std::string::npos; }

TEST(Includes, FollowTheArrowsBetweenTheFolders) {
  int seen = 0;
  for (const std::string& folder : kFolders) {
    for (const auto& file : source_files(folder)) {
      int number = 0;
      for (const std::string& line : read_lines(file)) {
        ++number;
        const auto header = included(line);
        if (!header || is_standard(*header)) continue;
        ++seen;
        const std::string first = header->substr(0, header->find('/'));
        EXPECT_TRUE(kMayInclude.at(folder).contains(first)) << file << ':' << number << ": " << line;
      }
    }
  }
  EXPECT_GT(seen, 100) << "the test reads too little to mean anything";
}

TEST(Includes, KeepSlowLibrariesOutOfHeaders) {
  for (const std::string& folder : kFolders) {
    for (const auto& file : source_files(folder)) {
      if (file.extension() != ".hpp") continue;
      for (const std::string& line : read_lines(file)) {
        const auto header = included(line);
        if (!header) continue;
        EXPECT_FALSE(kNotInHeaders.contains(*header) || header->starts_with("boost/beast"))
            << file << ": " << line;
      }
    }
  }
}

TEST(Includes, TheCoreKnowsNoInputOrOutput) {
  const std::set<std::string> forbidden{"iostream", "fstream", "cstdio", "chrono", "thread", "filesystem"};
  for (const auto& file : source_files("calib_core")) {
    for (const std::string& line : read_lines(file)) {
      const auto header = included(line);
      EXPECT_FALSE(header && forbidden.contains(*header)) << file << ": " << line;
    }
  }
}

}  // namespace
}  // namespace architecture
