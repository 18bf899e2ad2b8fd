// The documents are maps of the tree: what they name is there, and what they link to as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> documents() {
  std::vector<fs::path> found{kRoot / "README.md", kRoot / ".github/CONTRIBUTING.md"};
  for (const std::string& folder : kFolders) found.push_back(kRoot / folder / "README.md");
  found.push_back(kRoot / "tests/README.md");
  found.push_back(kRoot / "tests/benchmark/README.md");
  for (const auto& entry : fs::directory_iterator(kRoot / "service/doc"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

/// "run/verdict" names verdict.hpp and verdict.cpp, or the folder run/verdict.
bool is_there(const fs::path& named) {
  if (fs::exists(named)) return true;
  if (!fs::is_directory(named.parent_path())) return false;
  const std::string stem = named.filename().string() + ".";
  return std::any_of(fs::directory_iterator(named.parent_path()), fs::directory_iterator(),
                     [&](const auto& entry) { return entry.path().filename().string().starts_with(stem); });
}

std::vector<std::string> all_matches(const std::string& line, const std::regex& pattern) {
  std::vector<std::string> found;
  for (auto match = std::sregex_iterator(line.begin(), line.end(), pattern); match != std::sregex_iterator();
       ++match) {
    found.push_back((*match)[1]);
  }
  return found;
}

TEST(Documents, NameFilesThatAreThere) {
  const std::regex path("`([A-Za-z0-9_]+(?:/[A-Za-z0-9_.]+)+/?)`");
  int seen = 0;
  for (const auto& document : documents()) {
    const fs::path folder = document.parent_path();
    for (const std::string& line : read_lines(document)) {
      for (const std::string& named : all_matches(line, path)) {
        const std::string first = named.substr(0, named.find('/'));
        if (first == "build") continue;
        const bool is_inside = fs::is_directory(folder / first);
        if (!is_inside && !fs::is_directory(kRoot / first)) continue;  // a schema, an option, another project
        ++seen;
        EXPECT_TRUE((is_inside && is_there(folder / named)) || is_there(kRoot / named))
            << document << ": " << named;
      }
    }
  }
  EXPECT_GT(seen, 150) << "the test reads too little to mean anything";
}

TEST(Documents, LinkToFilesThatAreThere) {
  const std::regex link(R"re(\]\(([^)#]+))re");
  int seen = 0;
  for (const auto& document : documents()) {
    for (const std::string& line : read_lines(document)) {
      for (const std::string& target : all_matches(line, link)) {
        ++seen;
        EXPECT_TRUE(fs::exists(document.parent_path() / target)) << document << ": " << target;
      }
    }
  }
  EXPECT_GT(seen, 20) << "the test reads too little to mean anything";
}

}  // namespace
}  // namespace architecture
