// The folders of service/ stand on floors; no include runs up, and none is out of this table.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

/// From the ground up: what a folder may include besides itself. Nobody may include the two on the top floor.
const std::map<std::string, std::set<std::string>> kServiceMayInclude{
    {"base", {}},
    {"page", {}},
    {"offline_programs", {"base"}},
    {"store", {"base"}},
    {"run", {"base", "store"}},
    {"plant", {"base", "store"}},
    {"documents", {"base", "store", "run"}},
    {"archive", {"base", "store", "plant", "documents"}},
    {"mqtt", {"base", "store", "plant", "documents"}},
    {"acquisition", {"base", "store", "run", "documents"}},
    {"report", {"base", "store", "documents"}},
    {"exports", {"base", "offline_programs"}},
    {"setup", {"base"}},
    {"http/server", {"base"}},
    {"http/auth", {"base", "http/server"}},
    {"http/routes",
     {"base", "store", "run", "documents", "acquisition", "report", "page", "setup", "http/server",
      "http/auth"}},
    {"cli", {"base", "run", "documents", "archive", "exports", "setup", "offline_programs"}},
    {"daemon",
     {"base", "store", "plant", "run", "documents", "archive", "mqtt", "acquisition", "http/server",
      "http/auth", "http/routes"}},
};

/// The folder of a file of service/: "http/routes" of service/http/routes/internal/start_body.hpp.
std::string service_folder(const std::string& path) {
  static const std::regex kFolder("service/(http/[a-z]+|[a-z_]+)/.*");
  std::smatch match;
  return std::regex_match(path, match, kFolder) ? match[1].str() : std::string();
}

std::optional<std::string> included_of_service(const std::string& line) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*"(service/[^"]+)")re");
  std::smatch match;
  return std::regex_search(line, match, kInclude) ? std::optional(match[1].str()) : std::nullopt;
}

std::string relative_path(const std::filesystem::path& file) {
  return std::filesystem::relative(file, kRoot).generic_string();
}

TEST(ServiceLayers, IncludesRunDownwardsOnly) {
  int seen = 0;
  for (const auto& file : source_files("service")) {
    const std::string folder = service_folder(relative_path(file));
    ASSERT_TRUE(kServiceMayInclude.contains(folder)) << file << ": a folder that the table does not know";
    for (const std::string& line : read_lines(file)) {
      const auto header = included_of_service(line);
      if (!header) continue;
      ++seen;
      const std::string other = service_folder(*header);
      EXPECT_TRUE(other == folder || kServiceMayInclude.at(folder).contains(other)) << file << ": " << line;
    }
  }
  EXPECT_GT(seen, 300) << "the test reads too little to mean anything";
}

TEST(ServiceLayers, TheTableHasNoCircle) {
  std::set<std::string> below;
  for (std::size_t floors = 0; floors < kServiceMayInclude.size(); ++floors) {
    for (const auto& [folder, allowed] : kServiceMayInclude) {
      if (std::ranges::includes(below, allowed)) below.insert(folder);
    }
  }
  EXPECT_EQ(below.size(), kServiceMayInclude.size());
}

// The library of a folder is touchcal_ and its path with underscores.
TEST(ServiceLayers, LibrariesLinkWhatTheirFolderMayInclude) {
  static const std::regex kLibrary("touchcal_[a-z_]+");
  const auto library_of = [](std::string folder) {
    std::ranges::replace(folder, '/', '_');
    return "touchcal_" + folder;
  };
  for (const auto& [folder, allowed] : kServiceMayInclude) {
    std::set<std::string> may_link{library_of(folder)};
    for (const std::string& other : allowed) may_link.insert(library_of(other));
    for (const std::string& line : read_lines(kRoot / "service" / folder / "CMakeLists.txt")) {
      if (line.starts_with("#")) continue;
      for (auto name = std::sregex_iterator(line.begin(), line.end(), kLibrary);
           name != std::sregex_iterator(); ++name) {
        EXPECT_TRUE(may_link.contains(name->str())) << folder << "/CMakeLists.txt: " << line;
      }
    }
  }
}

}  // namespace
}  // namespace architecture
