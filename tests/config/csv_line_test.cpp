#include "config/internal/csv_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "folder.hpp"

namespace cell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kSource = "t.csv";

TEST(CsvLine, SplitsIntoTrimmedCells) {
  EXPECT_THAT(CsvLine(kSource, 1).split<3>(" a,\tb c ,\r", "three"), ElementsAre("a", "b c", ""));
  EXPECT_EQ(trimmed(" \t\r"), "");
  EXPECT_EQ(first_line("one \r\ntwo"), "one");
  EXPECT_EQ(first_line("one"), "one");
}

TEST(CsvLine, NamesItsLineAndWhatItWants) {
  const CsvLine line(kSource, 7);
  EXPECT_STREQ(error_of([&] { static_cast<void>(line.split<2>("a", "a name and a number")); }).what(),
               "t.csv: line 7: wants a name and a number, has 1 values; separate 2 values by commas");
  EXPECT_THAT(error_of([&] { static_cast<void>(line.split<2>("a,b,c", "two")); }).what(),
              HasSubstr("has 3 values"));
  EXPECT_EQ(line.integer("3", "plane", 1, 4), 3);
  for (const char* wrong : {"0", "5", "", "1.5", "3x", " 3", "99999999999"}) {
    EXPECT_THAT(
        error_of([&] { static_cast<void>(line.integer(wrong, "plane", 1, 4)); }).what(),
        HasSubstr("line 7: plane is \"" + std::string(wrong) + "\"; give a whole number from 1 to 4"));
  }
  EXPECT_EQ(line.joint("-1.5e2", 0), -150.0);
  for (const char* wrong : {"", "x", "1,5", "nan", "inf", "1e5x", "1e400"}) {
    EXPECT_THAT(error_of([&] { static_cast<void>(line.joint(wrong, 2)); }).what(),
                HasSubstr("line 7: joint 3 is \"" + std::string(wrong) + "\"; give a finite number"));
  }
  EXPECT_THAT(error_of([&] { static_cast<void>(line.joint("-100001", 5)); }).what(),
              HasSubstr("line 7: joint 6 is -100001; give -100000 to 100000"));
}

TEST(CsvLines, AreGivenTrimmedWithTheirNumbersAndWithoutTheEmptyOnes) {
  std::vector<std::string> taken;
  const auto take = [&taken](const CsvLine& line, std::string_view text) {
    taken.emplace_back(text);
    if (text == "wrong") line.fail("no good");
  };
  take_csv_lines(kSource, "a,b\r\n 1,2 \r\n\n\t\n3,4", "a,b", take);
  EXPECT_EQ(taken, (std::vector<std::string>{"1,2", "3,4"}));
  taken.clear();
  take_csv_lines(kSource,
                 "\xEF\xBB\xBF"
                 "a,b\n1,2",
                 "a,b", take);
  EXPECT_EQ(taken, std::vector<std::string>{"1,2"}) << "with the byte order mark of a spreadsheet";
  EXPECT_STREQ(error_of([&] { take_csv_lines(kSource, "a,b\n\nwrong\n", "a,b", take); }).what(),
               "t.csv: line 3: no good");
  EXPECT_STREQ(error_of([&] { take_csv_lines(kSource, "a;b\n1,2", "a,b", take); }).what(),
               "t.csv: line 1: the header is missing; begin with a,b");
  EXPECT_STREQ(error_of([&] { take_csv_lines(kSource, "a,b\n1,2\n", "a,b", take).fail("more"); }).what(),
               "t.csv: line 3: more");
}

}  // namespace
}  // namespace cell
