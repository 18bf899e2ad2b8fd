// Every unit has a test of the same name in the same place below tests/, or stands in the list with the
// reason.
#include <gtest/gtest.h>

#include <string>

#include "tests/architecture/source_files.hpp"
#include "tests/architecture/units_without_test.hpp"

namespace architecture {
namespace {

/// The folders in which every unit has a test.
const std::vector<std::string> kTestedFolders{"calib_core", "config", "cs8_protocol", "service",
                                              "sim_controller"};

bool has_test(const std::string& unit) {
  return std::filesystem::exists(kRoot / "tests" / (unit + "_test.cpp"));
}

TEST(Units, HaveATestOfTheirNameOrAReason) {
  int seen = 0;
  for (const std::string& folder : kTestedFolders) {
    for (const auto& file : source_files(folder)) {
      if (file.extension() != ".cpp") continue;
      ++seen;
      const std::string unit = file.lexically_relative(kRoot).replace_extension().string();
      EXPECT_NE(has_test(unit), kUnitsWithoutTest.contains(unit))
          << unit << (has_test(unit) ? " has a test: take it off the list" : " needs a test or a reason");
    }
  }
  EXPECT_GT(seen, 150) << "the test reads too little to mean anything";
}

TEST(Units, OfTheListExist) {
  for (const auto& [unit, reason] : kUnitsWithoutTest) {
    EXPECT_TRUE(std::filesystem::exists(kRoot / (unit + ".cpp"))) << unit;
    EXPECT_FALSE(reason.empty()) << unit;
  }
}

}  // namespace
}  // namespace architecture
