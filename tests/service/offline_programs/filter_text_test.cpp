#include "service/offline_programs/filter_text.hpp"

#include <gmock/gmock.h>

#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(FilterText, TellsWhatAPersonHasToKnow) {
  const std::string data = new_data(variable("pA", "pointRx",
                                             value("key=\"0\" x=\"1\" fatherId=\"world[0]\"") +
                                                 value("key=\"1\" x=\"2\" z=\"4\" fatherId=\"world[0]\"") +
                                                 value("key=\"2\" x=\"3\" z=\"4\" fatherId=\"world[0]\""),
                                             "4"));
  const FilteredData found = filtered(data, "pA offline", [](const OfflineTarget& target) {
    Correction correction = shifted_by({0, 0, 0.5})(target);
    if (target.name == "pA[1]") correction.status = CorrectionStatus::kWarned;
    if (target.name == "pA[2]") correction.status = CorrectionStatus::kRefused;
    if (target.name != "pA[0]") correction.reason = "the wrist is nearly straight";
    return correction;
  });
  const std::string text =
      filter_text(found, program_warnings({{"move.pgx", new_program("move", "x=appro(pA,{0,0,10,0,0,0})\n")},
                                           {"half.pgx", "<Programs"}},
                                          found));
  EXPECT_THAT(text, HasSubstr("pA                         2         1         1       0.500 mm\n"));
  EXPECT_THAT(text, HasSubstr("line 5: pA[0] has z now, which was left out as 0\n"));
  EXPECT_THAT(text, HasSubstr("line 6: pA[1] corrected, with a warning: the wrist is nearly straight\n"));
  EXPECT_THAT(text, HasSubstr("line 7: pA[2] refused and left as it was: the wrist is nearly straight\n"));
  EXPECT_THAT(text, HasSubstr("move.pgx:5: appro of pA: 38 um, at 10 mm from the filtered point\n"
                              "    x=appro(pA,{0,0,10,0,0,0})\n    remedy: store the point"));
  EXPECT_THAT(text, HasSubstr("not read: half.pgx:1: is no whole XML"));
  EXPECT_THAT(text, HasSubstr("pA: 1 of 4 elements have no value in the file"));
  EXPECT_THAT(text,
              HasSubstr("original " + found.mark.original_sha256 + "\nresult   " + found.mark.result_sha256));
}

TEST(FilterText, HasNoTitleOfWhatIsNotThere) {
  const FilteredData found = filtered(
      new_data(variable("pA", "pointRx", value("key=\"0\" x=\"1\" y=\"1\" z=\"1\" fatherId=\"world[0]\""))),
      "pA offline", shifted_by({1, 1, 1}));
  const std::string text = filter_text(found, {});
  EXPECT_THAT(text, Not(HasSubstr("values")));
  EXPECT_THAT(text, Not(HasSubstr("programs")));
  EXPECT_THAT(text, Not(HasSubstr("notes")));
}

}  // namespace
}  // namespace cell
