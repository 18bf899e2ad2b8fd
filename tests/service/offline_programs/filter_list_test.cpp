#include "service/offline_programs/filter_list.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

const std::string kOne(64, 'a');
const std::string kTwo(64, 'b');

std::string list_refusal(const std::string& text) {
  return error_of([&] { parse_filter_list("points.list", text); }).what();
}

TEST(FilterList, SaysWhatIsFilteredAndWithWhichTool) {
  const FilterList list =
      parse_filter_list("points.list",
                        "\xEF\xBB\xBF# points of the cell\r\n\r\npPick\toffline  gripper  # by drawing\r\n"
                        "pTaught taught\r\njHome leave\r\n  # filtered " +
                            kOne + " " + kTwo + "\r\n");
  ASSERT_EQ(list.variables.size(), 3U);
  EXPECT_EQ(list.variables.at("pPick").mark, FilterMark::kOffline);
  EXPECT_EQ(list.variables.at("pPick").tool, "gripper");
  EXPECT_EQ(list.variables.at("pPick").line, 3);
  EXPECT_EQ(list.variables.at("pTaught").mark, FilterMark::kTaught);
  EXPECT_EQ(list.variables.at("jHome").mark, FilterMark::kLeave);
  EXPECT_EQ(list.variables.at("jHome").tool, "");
  ASSERT_EQ(list.filtered.size(), 1U);
  EXPECT_EQ(list.filtered[0].original_sha256, kOne);
  EXPECT_EQ(list.filtered[0].result_sha256, kTwo);
}

TEST(FilterList, RefusesEachLineThatItDoesNotKnow) {
  EXPECT_EQ(list_refusal("pA offline\n\npB\n"),
            "points.list:3: \"pB\" has no mark; write offline, taught or leave after it");
  EXPECT_EQ(list_refusal("pA Offline\n"),
            "points.list:1: \"Offline\" is no mark; write offline, taught or leave");
  EXPECT_THAT(list_refusal("pA offline tool more"), HasSubstr(":1: \"more\" is one word too many"));
  EXPECT_THAT(list_refusal("2pA offline"), HasSubstr("is no name of a variable"));
  EXPECT_THAT(list_refusal("p-A offline"), HasSubstr("is no name of a variable"));
  EXPECT_THAT(list_refusal("pA[0] offline"), HasSubstr("is no name of a variable"));
  EXPECT_THAT(list_refusal(std::string(65, 'p') + " leave"), HasSubstr("is no name of a variable"));
  EXPECT_THAT(list_refusal("pA offline t\xC3\xA9"), HasSubstr("is no name of a tool"));
  EXPECT_EQ(list_refusal("pA offline\npB leave\npA leave\n"),
            "points.list:3: \"pA\" is there twice, first in line 1; remove one of them");
  EXPECT_THAT(list_refusal("# filtered " + kOne + "\n"), HasSubstr(":1: is no mark of a filtered file"));
  EXPECT_THAT(list_refusal("# filtered " + kOne + " " + std::string(64, 'G')), HasSubstr("is no mark"));
  EXPECT_THAT(list_refusal(std::string(kFilterListBytesMax + 1, '\n')), HasSubstr("make it smaller"));
}

TEST(FilterList, MarksWhatWasFilteredOnceAndInItsOwnLineEnds) {
  const FilteredMark mark{kOne, kTwo};
  EXPECT_EQ(with_filtered_mark("pA leave", mark), "pA leave\n# filtered " + kOne + " " + kTwo + "\n");
  EXPECT_EQ(with_filtered_mark("pA leave\r\npB leave", mark),
            "pA leave\r\npB leave\r\n# filtered " + kOne + " " + kTwo + "\r\n");
  const std::string marked = with_filtered_mark("pA leave\n", mark);
  EXPECT_EQ(with_filtered_mark(marked, mark), marked);
  EXPECT_EQ(with_filtered_mark("pA leave\n", {kOne, kOne}), "pA leave\n") << "nothing was changed";
  EXPECT_EQ(parse_filter_list("points.list", marked).filtered.size(), 1U);
}

TEST(FilterList, MarksThePointsOfEachVariableThatWasChanged) {
  const FilteredMark mark{
      kOne, kTwo, {{.variable = "pA", .sha256 = kTwo}, {.variable = "jB", .sha256 = kOne}}};
  const std::string marked = with_filtered_mark("pA offline t\n", mark);
  EXPECT_THAT(marked, HasSubstr("\n# filtered-points pA " + kTwo + "\n# filtered-points jB " + kOne + "\n"));
  EXPECT_EQ(with_filtered_mark(marked, mark), marked);
  const FilterList list = parse_filter_list("points.list", marked);
  ASSERT_EQ(list.points.size(), 2U);
  EXPECT_EQ(list.points[1].variable, "jB");
  EXPECT_EQ(list.points[1].sha256, kOne);
  EXPECT_EQ(list.points[1].source, "points.list");
  for (const std::string& wrong : {std::string("pA"), "2 " + kOne, "pA " + kOne + " more", std::string()})
    EXPECT_THAT(list_refusal("# filtered-points " + wrong), HasSubstr("is no mark of filtered points"));
}

TEST(FilterList, RefusesAResultAndTakesTheOriginalAgain) {
  const FilterList list = parse_filter_list("points.list", with_filtered_mark("pA offline\n", {kOne, kTwo}));
  EXPECT_EQ(
      std::string(error_of([&] { refuse_filtered_file(list, "cell.dtx", kTwo); }).what()),
      "cell.dtx: is filtered already, says points.list: a second filter would correct its points twice; "
      "give the original");
  EXPECT_NO_THROW(refuse_filtered_file(list, "cell.dtx", kOne));
}

}  // namespace
}  // namespace cell
