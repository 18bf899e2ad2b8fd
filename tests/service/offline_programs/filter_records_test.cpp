#include "service/offline_programs/filter_records.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

TEST(FilterRecords, KnowPointsByTheirNumbersAndNotByTheirWriting) {
  const std::string digest = points_digest({{"0", {1.0, 0.0, 0.0, 0.0, 0.0, 90.0}}});
  EXPECT_EQ(points_digest({{"0", {1.0 + 1e-9, -0.0, 0.0, 0.0, 0.0, 90.0}}, {"7", SixNumbers{}}}), digest)
      << "six decimals; what is all 0 may be left out";
  EXPECT_NE(points_digest({{"0", {1.000002, 0.0, 0.0, 0.0, 0.0, 90.0}}}), digest);
  EXPECT_NE(points_digest({{"1", {1.0, 0.0, 0.0, 0.0, 0.0, 90.0}}}), digest) << "another element";
}

TEST(FilterRecords, OfTheFolderAreReadAndNameTheVariable) {
  const Folder folder;
  const std::string digest(64, 'c');
  folder.write("old.dtx.filtered", "# a record\n# filtered-points pPick " + digest + "\n");
  folder.write("notes.txt", "no record");
  EXPECT_EQ(filter_record_of("a/old.dtx"), "a/old.dtx.filtered");
  FilterList list = parse_filter_list("points.list", "pPick offline\n");
  add_filter_records(folder.path() / "cell.dtx", list);
  EXPECT_NO_THROW(refuse_filtered_points(list, "cell.dtx", "pPick", std::string(64, 'd')));
  const std::string refusal =
      error_of([&] { refuse_filtered_points(list, "cell.dtx", "pPick", digest); }).what();
  EXPECT_THAT(refusal, HasSubstr("cell.dtx: pPick holds what a filter made, says "));
  EXPECT_THAT(refusal, HasSubstr("old.dtx.filtered: a second filter would correct its points twice; give the "
                                 "original, or mark pPick leave"));
  EXPECT_THAT(
      std::string(error_of([&] { refuse_filtered_points(list, "cell.dtx", "pOther", digest); }).what()),
      HasSubstr("pOther holds what a filter made of pPick"));
}

TEST(FilterRecords, ThatAreBrokenAreNamed) {
  const Folder folder;
  folder.write("cell.dtx.filtered", "# filtered-points pPick cut\n");
  FilterList list;
  EXPECT_THAT(std::string(error_of([&] { add_filter_records(folder.path() / "cell.dtx", list); }).what()),
              HasSubstr("cell.dtx.filtered:1: is no mark of filtered points"));
}

}  // namespace
}  // namespace cell
