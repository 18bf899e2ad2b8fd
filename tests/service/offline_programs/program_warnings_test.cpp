#include "service/offline_programs/program_warnings.hpp"

#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Points pA (three elements) and pTaught, a trsf trUp of 20 mm; corrections of 0.5 mm.
const FilteredData& data_of_the_cell() {
  static const FilteredData data =
      filtered(new_data(variable("pA", "pointRx",
                                 value("key=\"0\" x=\"500\" fatherId=\"world[0]\"") +
                                     value("key=\"1\" x=\"530\" fatherId=\"world[0]\"") +
                                     value("key=\"2\" x=\"600\" fatherId=\"world[0]\""),
                                 "3") +
                        variable("pTaught", "pointRx", value("key=\"0\" fatherId=\"world[0]\"")) +
                        variable("pMade", "pointRx", value("key=\"0\" fatherId=\"world[0]\"")) +
                        variable("jA", "jointRx", value("key=\"0\" j5=\"90\"")) +
                        variable("trUp", "trsf", value("key=\"0\" z=\"-20\""))),
               "pA offline\npTaught taught\npMade leave\njA offline\n", shifted_by({0, 0.5, 0}));
  return data;
}

ProgramWarnings warnings_of(const std::string& code, const std::string& declared = "") {
  return program_warnings({{"move.pgx", new_program("move", code, declared)}}, data_of_the_cell());
}

/// "word of point: error" of each warning.
std::vector<std::string> told(const ProgramWarnings& warnings) {
  std::vector<std::string> result;
  for (const ProgramWarning& warning : warnings.warnings)
    result.push_back(std::string(word_of(warning.kind)) + " of " + warning.point + ": " + warning.error);
  return result;
}

constexpr const char* kFar = "as far as it goes: 3.7 um a mm";

TEST(ProgramWarnings, TellTheErrorOfAPointThatIsMovedOnByAConstant) {
  const ProgramWarnings found =
      warnings_of("  // appro(pA,trUp)\n  movej(appro(pA[1],{0,0,-50,0,0,0}),tGrip,m)\n");
  EXPECT_THAT(told(found), ElementsAre("appro of pA: 185 um, at 50 mm from the filtered point"));
  EXPECT_EQ(found.warnings[0].file, "move.pgx");
  EXPECT_EQ(found.warnings[0].line, 6);
  EXPECT_EQ(found.warnings[0].code, "movej(appro(pA[1],{0,0,-50,0,0,0}),tGrip,m)");
  EXPECT_EQ(found.warnings[0].error_um, 185.0);
  EXPECT_THAT(found.warnings[0].remedy, HasSubstr("store the point that is meant"));
  EXPECT_THAT(told(warnings_of("x=appro(pA[i],trUp)\n")),
              ElementsAre("appro of pA: 75 um, at 20 mm from the filtered point, as trUp[0] is stored"));
  EXPECT_THAT(
      told(warnings_of("x=appro(pA[i],{0,0,0,0,0,90})\n")),
      ElementsAre("appro of pA: 0 um, at 0 mm from the filtered point; of its turn there is no figure"));
  EXPECT_THAT(told(warnings_of("x=compose(pA,fPallet,{300,0,0,0,0,0})\n")),
              ElementsAre("compose of pA: 1110 um, at 300 mm from the filtered point"));
}

TEST(ProgramWarnings, GiveNoFigureWhereTheDistanceIsNotConstant) {
  EXPECT_THAT(told(warnings_of("x=appro(pA,{0,0,-nDist,0,0,0})\n")),
              ElementsAre("appro of pA: " + std::string(kFar)));
  EXPECT_THAT(told(warnings_of("x=appro(pA,trMade)\n")), ElementsAre("appro of pA: " + std::string(kFar)));
  EXPECT_THAT(told(warnings_of("x=compose(pA,fPallet,{0,0,0,0,0,90})\n")),
              ElementsAre("compose of pA: " + std::string(kFar)));
  EXPECT_THAT(told(warnings_of("pA.trsf.x=pA[i+1].trsf.x+5\n")),
              ElementsAre(".trsf of pA: " + std::string(kFar), ".trsf of pA: " + std::string(kFar)));
  EXPECT_FALSE(warnings_of("pA.trsf.x=5\n").warnings[0].error_um);
}

TEST(ProgramWarnings, TellOfFramesAndPlacesThatAreReadAtRunTime) {
  EXPECT_THAT(
      told(warnings_of("n=setFrame(pTaught,pA[1],pA[2],fNew)\n")),
      ElementsAre(HasSubstr("setFrame of pA: the frame moves with the corrections of its points, by up to "
                            "0.500 mm")));
  EXPECT_THAT(told(warnings_of("n=distance(here(tGrip,world),pA)\n")),
              ElementsAre(HasSubstr("here of pA: ")));
  EXPECT_THAT(warnings_of("pTaught=here(tGrip,world)\n").warnings, IsEmpty());
}

TEST(ProgramWarnings, SayNothingOfWhatIsNotFiltered) {
  EXPECT_THAT(warnings_of("x=appro(pTaught,trUp)\nx=appro(lib:pA,trUp)\nx=pB.pA\nmovej(jA,tGrip,m)\n"
                          "put(\"appro(pA,trUp)\")\nx=appro(pTaught,pA)\n")
                  .warnings,
              IsEmpty());
  EXPECT_THAT(
      warnings_of("x=appro(pA,trUp)\n", "<Locals><Local name=\"pA\" type=\"pointRx\" size=\"1\"/></Locals>\n")
          .warnings,
      IsEmpty())
      << "a local hides the global of its name";
}

TEST(ProgramWarnings, FollowAPointThroughAssignmentsAndCalls) {
  const std::string parameter =
      "<Parameters xmlns=\"p\"><Parameter name=\"x_n\" type=\"num\"/><Parameter name=\"x_p\" "
      "type=\"pointRx\"/>"
      "</Parameters>\n";
  const std::string local =
      "<Locals><Local name=\"l_p\" type=\"pointRx\" size=\"1\"/>"
      "<Local name=\"l_n\" type=\"num\" size=\"1\"/></Locals>\n";
  const ProgramWarnings found = program_warnings(
      {{"pick.pgx", new_program("pick", "  y=appro(x_p,{0,0,10,0,0,0})\n  y=appro(x_n,trUp)\n", parameter)},
       {"start.pgx", old_program("start", "l_p=pA[3]\r\nl_n=pA.config\r\ncall pick(l_n,l_p)\r\npMade=l_p\r\n",
                                 "<localSection><local name=\"l_p\" type=\"point\"/><local name=\"l_n\" "
                                 "type=\"num\"/></localSection>")},
       {"use.pgx", new_program("use", "y=appro(pMade,trUp)\n", local)}},
      data_of_the_cell());
  EXPECT_THAT(told(found), ElementsAre("appro of pA: 38 um, at 10 mm from the filtered point",
                                       HasSubstr("appro of pA: 75 um")));
  EXPECT_EQ(found.warnings[0].file, "pick.pgx");
  EXPECT_EQ(found.warnings[1].file, "use.pgx");
}

TEST(ProgramWarnings, TellOfAFileThatCannotBeReadAndReadTheOthers) {
  const ProgramWarnings found =
      program_warnings({{"half.pgx", "<Programs>"}, {"move.pgx", new_program("move", "x=appro(pA,trUp)\n")}},
                       data_of_the_cell());
  EXPECT_THAT(found.unread, ElementsAre(HasSubstr("half.pgx:1: is no whole XML")));
  EXPECT_EQ(found.warnings.size(), 1U);
}

TEST(ProgramWarnings, AreAtMostAsManyAsAnybodyReads) {
  std::string code;
  for (std::size_t i = 0; i <= kProgramWarningsMax; ++i) code += "x=appro(pA,trUp)\n";
  const ProgramWarnings found = warnings_of(code);
  EXPECT_TRUE(found.is_cut);
  EXPECT_EQ(found.warnings.size(), kProgramWarningsMax);
  EXPECT_FALSE(warnings_of("x=appro(pA,trUp)\n").is_cut);
}

TEST(ProgramWarnings, ShowCodeOfAnyEncodingInAscii) {
  const ProgramWarnings found = warnings_of("put(\"caf\xE9\"+x(appro(pA,trUp)))\n");
  ASSERT_EQ(found.warnings.size(), 1U);
  EXPECT_EQ(found.warnings[0].code, "put(\"caf?\"+x(appro(pA,trUp)))");
}

}  // namespace
}  // namespace cell
