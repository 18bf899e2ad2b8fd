// Arrows between the folders point one way: this table is the whole of what may include what.
#include <gtest/gtest.h>

#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

/// First part of an include path of what a folder may use beside the standard library.
const std::map<std::string, std::set<std::string>> kMayInclude{
    {"calib_core", {"calib_core", "Eigen", "boost"}},
    {"cs8_protocol", {"cs8_protocol", "boost"}},
    {"config", {"config", "calib_core", "nlohmann", "Eigen"}},
    {"sim_controller",
     {"sim_controller", "config", "cs8_protocol", "calib_core", "boost", "nlohmann", "spdlog", "CLI", "Eigen",
      "pugixml.hpp"}},
    {"service", {"service",     "config",          "cs8_protocol", "calib_core", "boost",
                 "nlohmann",    "spdlog",          "SQLiteCpp",    "sqlite3.h",  "CLI",
                 "openssl",     "prometheus",      "systemd",      "Eigen",      "fcntl.h",
                 "malloc.h",    "spawn.h",         "unistd.h",     "sys",        "pugixml.hpp",
                 "mosquitto.h", "mqtt_protocol.h", "pqxx",         "sodium.h",   "termios.h"}},
};

/// The layers of calib_core: which may include which. Nothing runs up, and nothing in a circle.
const std::map<std::string, std::set<std::string>> kCoreLayerMayInclude{
    {"geometry", {}},
    {"numerics", {"geometry"}},
    {"kinematics", {"geometry", "numerics"}},
    {"observability", {"geometry", "numerics", "kinematics"}},
    {"estimation", {"geometry", "numerics", "kinematics", "observability"}},
    {"uncertainty", {"geometry", "numerics", "kinematics", "estimation"}},
    {"compensation", {"geometry", "kinematics", "uncertainty"}},
    {"identification", {"numerics", "estimation", "uncertainty"}},
    {"motion", {"geometry", "kinematics"}},
    {"planning", {"geometry", "numerics", "kinematics", "estimation", "uncertainty", "motion"}},
    {"proof",
     {"geometry", "numerics", "kinematics", "estimation", "uncertainty", "identification", "motion",
      "planning"}},
    {"qualification", {"geometry", "numerics", "kinematics", "estimation", "motion", "planning", "proof"}},
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

TEST(Includes, OfTheCoreFollowTheArrowsBetweenItsLayers) {
  int seen = 0;
  for (const auto& file : source_files("calib_core")) {
    const std::string layer = *std::next(file.lexically_relative(kRoot).begin());
    ASSERT_TRUE(kCoreLayerMayInclude.contains(layer)) << file;
    for (const std::string& line : read_lines(file)) {
      const auto header = included(line);
      if (!header || !header->starts_with("calib_core/")) continue;
      ++seen;
      const std::string target = *std::next(std::filesystem::path(*header).begin());
      EXPECT_TRUE(target == layer || kCoreLayerMayInclude.at(layer).contains(target)) << file << ": " << line;
    }
  }
  EXPECT_GT(seen, 100) << "the test reads too little to mean anything";
}

/// x/internal/ belongs to x: only x and its tests include from there.
TEST(Includes, OfInternalHeadersStayInTheirFolder) {
  std::vector<std::filesystem::path> files = source_files("tests");
  for (const std::string& folder : kFolders) {
    const auto more = source_files(folder);
    files.insert(files.end(), more.begin(), more.end());
  }
  for (const auto& file : files) {
    std::string place = file.lexically_relative(kRoot).string();
    if (place.starts_with("tests/")) place.erase(0, 6);
    for (const std::string& line : read_lines(file)) {
      const auto header = included(line);
      const std::size_t found = header ? header->find("/internal/") : std::string::npos;
      if (found == std::string::npos) continue;
      EXPECT_TRUE(place.starts_with(header->substr(0, found + 1))) << file << ": " << line;
    }
  }
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
