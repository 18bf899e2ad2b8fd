// The fault table says of everything that can go wrong what a person reads: nothing is left out, and nothing
// stands in it that nobody tells.
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

std::set<std::string> codes_in(const std::filesystem::path& file) {
  const std::regex code("FaultCode::(k[A-Za-z]+)");
  std::set<std::string> codes;
  for (const std::string& line : read_lines(file)) {
    for (auto match = std::sregex_iterator(line.begin(), line.end(), code); match != std::sregex_iterator();
         ++match) {
      codes.insert((*match)[1]);
    }
  }
  return codes;
}

std::set<std::string> declared_codes() {
  const std::regex enumerator("  (k[A-Za-z]+),.*");
  std::set<std::string> codes;
  bool inside = false;
  for (const std::string& line : read_lines(kRoot / "service/run/fault_table.hpp")) {
    if (line.starts_with("enum class FaultCode")) inside = true;
    std::smatch match;
    if (inside && std::regex_match(line, match, enumerator)) codes.insert(match[1]);
    if (line == "};") inside = false;
  }
  return codes;
}

TEST(FaultTable, HasEveryCodeAndEachIsRaisedSomewhere) {
  const std::set<std::string> declared = declared_codes();
  EXPECT_GE(declared.size(), 42U);
  EXPECT_EQ(codes_in(kRoot / "service/run/fault_table.cpp"), declared);
  std::set<std::string> raised;
  for (const auto& file : source_files("service")) {
    if (file.filename() != "fault_table.cpp") raised.merge(codes_in(file));
  }
  for (const std::string& code : declared) EXPECT_TRUE(raised.contains(code)) << code << " is never raised";
}

}  // namespace
}  // namespace architecture
