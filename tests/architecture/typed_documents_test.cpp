// Report and command line read documents as structs (service/documents/*_document.hpp): a field that is
// renamed does not compile. No key of a document stands there as text.
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

/// Files that may look into JSON by its keys, each with the reason. There is none.
const std::set<std::string> kMayUseKeys{};

const std::set<std::string> kReaders{"service/report", "service/cli"};

TEST(TypedDocuments, ReportAndCommandLineNameNoKey) {
  const std::regex by_key(R"re(\.(at|value|contains)\(\s*"|[\w)\]]\[\s*")re");
  int seen = 0;
  for (const std::string& folder : kReaders) {
    for (const auto& file : source_files(folder)) {
      if (kMayUseKeys.contains(std::filesystem::relative(file, kRoot))) continue;
      ++seen;
      for (const std::string& line : read_lines(file))
        EXPECT_FALSE(std::regex_search(line, by_key)) << file << ": " << line;
    }
  }
  EXPECT_GT(seen, 20) << "the test reads too little to mean anything";
}

TEST(TypedDocuments, ReportAndCommandLineReadNoJson) {
  for (const std::string& folder : kReaders) {
    for (const auto& file : source_files(folder)) {
      for (const std::string& line : read_lines(file)) {
        EXPECT_EQ(line.find("#include <nlohmann/"), std::string::npos) << file << ": " << line;
        EXPECT_EQ(line.find("document_fields.hpp"), std::string::npos) << file << ": " << line;
      }
    }
  }
}

}  // namespace
}  // namespace architecture
