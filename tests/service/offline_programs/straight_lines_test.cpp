#include "service/offline_programs/straight_lines.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Straight lines of a program, or its arcs, as "line: error; remedy". Points pA at x = 0, 30, 130 mm of a
/// frame; pTaught.
std::vector<std::string> lines_of(const std::string& code,
                                  ProgramWarningKind kind = ProgramWarningKind::kStraightLine) {
  const FilteredData data =
      filtered(new_data(variable("fA", "frame", value("key=\"0\" y=\"7\" fatherId=\"world[0]\"")) +
                        variable("pA", "pointRx",
                                 value("key=\"0\" fatherId=\"fA[0]\"") +
                                     value("key=\"1\" x=\"30\" fatherId=\"fA[0]\"") +
                                     value("key=\"2\" x=\"130\" fatherId=\"fA[0]\""),
                                 "3") +
                        variable("pTaught", "pointRx", value("key=\"0\" fatherId=\"world[0]\"")) +
                        variable("trUp", "trsf", value("key=\"0\" z=\"-80\""))),
               "pA offline\npTaught taught\n", shifted_by({1, 0, 0}));
  std::vector<std::string> result;
  for (const ProgramWarning& warning :
       program_warnings({{"move.pgx", new_program("move", code)}}, data).warnings)
    if (warning.kind == kind) {
      result.push_back(std::to_string(warning.line) + ": " + warning.error + "; " + warning.remedy);
    }
  return result;
}

TEST(StraightLines, AreToldWhenTheyAreLongBetweenFilteredPoints) {
  EXPECT_THAT(
      lines_of("movej(pA[0],t,m)\nmovel(pA[1],t,m)\nmovel(pA[2],t,m)\n"),
      ElementsAre("7: 100 mm long: its middle is 0.015 mm off the line (0.065 mm of one line in twenty); "
                  "store and filter 1 point between its ends, one every 50 mm at least"));
  EXPECT_THAT(lines_of("movej(pA[0],t,m)\nmovej(pA[2],t,m)\n"), IsEmpty()) << "no straight line";
}

TEST(StraightLines, BeginWhereApproMeansThatTheyDo) {
  EXPECT_THAT(
      lines_of("movej(appro(pA[1],trUp),t,m)\nmovel(pA[1],t,m)\nmovel(appro(pA[1],{0,0,-20,0,0,0}),t,m)\n"),
      ElementsAre(HasSubstr("6: 80 mm long")));
}

TEST(StraightLines, OfWhichTheStartOrTheEndIsNotKnownAreToldWithoutAFigure) {
  const auto unknown = AllOf(HasSubstr("its length is not known here: where it is longer than 50 mm"),
                             HasSubstr("; store and filter a point every 50 mm"));
  EXPECT_THAT(lines_of("movel(pA[1],t,m)\n"), ElementsAre(unknown));
  EXPECT_THAT(lines_of("movej(pA[0],t,m)\nmovel(pA[i],t,m)\n"), ElementsAre(unknown));
  EXPECT_THAT(lines_of("movej(pA[0],t,m)\nif bFast\nmovel(pA[1],t,m)\nendIf\n"), ElementsAre(unknown));
  EXPECT_THAT(lines_of("movej(pA[0],t,m)\ncall elsewhere()\nmovel(pA[1],t,m)\n"), ElementsAre(unknown));
}

TEST(StraightLines, BetweenAFilteredAndAnotherPointAreNotToldNorThoseThatTouchNone) {
  EXPECT_THAT(lines_of("movej(pTaught,t,m)\nmovel(pA[2],t,m)\n"), IsEmpty());
  EXPECT_THAT(lines_of("movej(jHome,t,m)\nmovel(pTaught,t,m)\nmovel()\n"), IsEmpty());
}

TEST(StraightLines, TellEachArcOfFilteredPointsByItsLongerChord) {
  const auto arcs_of = [](const std::string& code) { return lines_of(code, ProgramWarningKind::kArc); };
  EXPECT_THAT(
      arcs_of("movej(pA[0],t,m)\nmovec(pA[1],pA[2],t,m)\n"),
      ElementsAre(AllOf(HasSubstr("6: of its points those that are filtered are corrected, the arc itself "
                                  "is not"),
                        HasSubstr("100 mm apart, between which it is 0.015 mm off (0.065 mm of one arc in "
                                  "twenty); divide it into arcs with filtered points at most 50 mm apart"))));
  EXPECT_THAT(arcs_of("movej(pA[1],t,m)\nmovec(pA[0],pA[1],t,m)\nmovel(pA[0],t,m)\n"),
              ElementsAre(AllOf(HasSubstr("6: "), HasSubstr("; none at this length"))));
  EXPECT_THAT(arcs_of("movej(pTaught,t,m)\nmovec(pTaught,pA[1],t,m)\n"),
              ElementsAre(HasSubstr("6: of its points")))
      << "a circle of corrected points and of others";
  EXPECT_THAT(arcs_of("movec(pA[i],pA[1],t,m)\n"),
              ElementsAre(HasSubstr("how far apart they are is not known")));
  EXPECT_THAT(arcs_of("movej(pTaught,t,m)\nmovec(pTaught,pTaught,t,m)\n"), IsEmpty());
  EXPECT_THAT(lines_of("movej(pA[0],t,m)\nmovec(pA[1],pA[2],t,m)\n"), IsEmpty()) << "told once";
}

}  // namespace
}  // namespace cell
