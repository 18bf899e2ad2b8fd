// Two types of one name and namespace with different members are undefined behaviour that no compiler
// reports: each name is defined once.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

/// The files that define each type of namespace scope, by namespace and name; nested and local types stand
/// apart by their scope and are indented.
std::map<std::pair<std::string, std::string>, std::vector<std::string>> types_in_headers() {
  static const std::regex kNamespace(R"(^namespace ([\w:]+) \{)");
  static const std::regex kType(R"(^(?:struct|class|enum class) (\w+)(?: final)?(?: : [^;{]*)?\s*\{.*)");
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> found;
  for (const std::string& folder : kFolders) {
    for (const auto& file : source_files(folder)) {
      if (file.extension() != ".hpp") continue;
      std::string scope;
      for (const std::string& line : read_lines(file)) {
        std::smatch match;
        if (std::regex_search(line, match, kNamespace)) scope = match[1];
        if (std::regex_match(line, match, kType)) found[{scope, match[1]}].push_back(file.string());
      }
    }
  }
  return found;
}

TEST(Types, AreEachDefinedInOneHeader) {
  const auto found = types_in_headers();
  EXPECT_GT(found.size(), 200U) << "the test reads too little to mean anything";
  for (const auto& [name, files] : found)
    EXPECT_EQ(files.size(), 1U) << name.first << "::" << name.second << " in " << files.front() << " and "
                                << files.back();
}

}  // namespace
}  // namespace architecture
