// The tree keeps its shape: what stands at the top, how long a file may be, which names say nothing.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

constexpr std::size_t kLinesMax = 400;
constexpr std::size_t kTestLinesMax = 600;  // a list of cases is read in parts

TEST(Tree, HasNothingAtTheTopButTheFixedFolders) {
  const std::set<std::string> allowed{"CMakeLists.txt", "README.md", "service", "calib_core", "cs8_protocol",
                                      "sim_controller", "config",    "tests",   "build"};
  for (const auto& entry : std::filesystem::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename();
    EXPECT_TRUE(name.starts_with('.') || allowed.contains(name)) << name;
  }
}

TEST(Tree, HoldsFilesOneCanKeepInTheHead) {
  for (const std::string& folder : kFolders) {
    for (const auto& file : source_files(folder)) {
      EXPECT_LE(read_lines(file).size(), kLinesMax) << file << ": look for the second noun in it";
    }
  }
  for (const auto& file : source_files("tests")) {
    EXPECT_LE(read_lines(file).size(), kTestLinesMax) << file << ": look for the second noun in it";
  }
}

TEST(Tree, HasNoNamesThatSayNothing) {
  const std::regex vague("(manager|helper|utils?|misc|common)", std::regex::icase);
  for (const std::string& folder : kFolders) {
    for (const auto& file : source_files(folder)) {
      EXPECT_FALSE(std::regex_search(file.filename().string(), vague)) << file;
    }
  }
}

/// Files of a component are compiled together, in groups that change with every file added, and in other
/// groups for the fuzzers: the same name in two of them is an error of some build to come.
TEST(Tree, ConstantsAndClassesOfAComponentHaveNamesOfTheirOwn) {
  const std::regex name(
      "^(?:(?:inline |static )?constexpr [^=;({]*?\\b(k[A-Z]\\w*)|(?:class|struct) (\\w+)(?: final)? [:{])");
  for (const std::string& folder : kFolders) {
    std::map<std::string, std::filesystem::path> places;
    for (const auto& file : source_files(folder)) {
      if (file.extension() != ".cpp") continue;
      for (const std::string& line : read_lines(file)) {
        std::smatch found;
        if (!std::regex_search(line, found, name)) continue;
        const std::string of = found[1].matched ? found[1] : found[2];
        const auto [place, is_new] = places.emplace(of, file);
        EXPECT_TRUE(is_new) << of << " in " << place->second << " and " << file;
      }
    }
  }
}

/// Who reads a clock of its own, and why; everybody else is handed one.
const std::map<std::string, std::string> kReadsAClock{
    {"daemon.cpp", "hands the machine's clocks to all parts of the daemon"},
    {"touchcal.cpp", "hands the machine's time to the commands that judge a temperature by it"},
    {"watch_command.cpp", "a program of its own, which waits for a daemon"},
};

TEST(Tree, ClocksAreHandedInInTheService) {
  const std::regex clock("_clock::now\\b");
  std::set<std::string> readers;
  for (const auto& file : source_files("service")) {
    for (const std::string& line : read_lines(file)) {
      if (!std::regex_search(line, clock)) continue;
      readers.insert(file.filename());
      EXPECT_TRUE(kReadsAClock.contains(file.filename())) << file << ": " << line;
    }
  }
  for (const auto& [file, reason] : kReadsAClock)
    EXPECT_TRUE(readers.contains(file)) << file << " reads none";
}

TEST(Tree, TestsDoNotSleep) {
  const std::regex sleep(std::string("sleep_") + "for|\\bu" + "sleep\\(");
  for (const auto& file : source_files("tests")) {
    for (const std::string& line : read_lines(file))
      EXPECT_FALSE(std::regex_search(line, sleep)) << file << ": " << line;
  }
}

}  // namespace
}  // namespace architecture
