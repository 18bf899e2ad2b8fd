#include "service/offline_programs/program_text.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ProgramText, HasLinesAndNamesOfItsOwn) {
  const XmlText xml(
      "move.pgx", new_program("move", "  pA=pB\n  movel(x_p,tGrip,m)\n",
                              "<Parameters xmlns=\"p\"><Parameter name=\"x_p\" type=\"pointRx\" "
                              "xsi:type=\"element\"/></Parameters>\n<Locals><Local name=\"l_n\" type=\"num\" "
                              "xsi:type=\"array\" size=\"1\"/></Locals>\n"));
  const auto programs = read_program_text(xml);
  ASSERT_EQ(programs.size(), 1U);
  EXPECT_EQ(programs[0].name, "move");
  EXPECT_EQ(programs[0].file, "move.pgx");
  EXPECT_THAT(programs[0].parameters, ElementsAre("x_p"));
  EXPECT_EQ(programs[0].own_types.at("x_p"), "pointRx");
  EXPECT_EQ(programs[0].own_types.at("l_n"), "num");
  ASSERT_GE(programs[0].lines.size(), 3U);
  EXPECT_EQ(programs[0].lines[1].text, "  pA=pB");
  EXPECT_EQ(programs[0].lines[1].number, 7);
}

TEST(ProgramText, OfS6IsReadWithoutItsEscapes) {
  const XmlText xml(
      "old.pgx",
      old_program("old", "if a&lt;1 and b&gt;2\r\n  pA=pB\r\nendIf\r\n",
                  "<paramSection><param name=\"x\" type=\"point\" byVal=\"true\"/></paramSection>"
                  "<localSection><local name=\"l\" type=\"point\" size=\"1\"/></localSection>\r\n"));
  const auto programs = read_program_text(xml);
  ASSERT_EQ(programs.size(), 1U);
  EXPECT_THAT(programs[0].parameters, ElementsAre("x"));
  EXPECT_EQ(programs[0].own_types.at("l"), "point");
  const auto& lines = programs[0].lines;
  ASSERT_GE(lines.size(), 4U);
  EXPECT_EQ(lines[2].text, "if a<1 and b>2");
  EXPECT_EQ(lines[2].number, 8);
  EXPECT_EQ(lines[3].number, 9);
}

TEST(ProgramText, RefusesWhatIsNoProgram) {
  const auto refusal = [](const std::string& bytes) {
    return std::string(error_of([&] {
                         const XmlText xml("a.pgx", bytes);
                         read_program_text(xml);
                       }).what());
  };
  EXPECT_THAT(refusal(new_data("")), HasSubstr("is no VAL3 program of s5 to s8; give a .pgx file"));
  EXPECT_THAT(refusal(new_program("a", "x=1\n" + std::string(3000, 'y') + "\n")),
              HasSubstr("a.pgx:6: the line has 3000 bytes, more than the 2048 that are read; divide it"));
}

}  // namespace
}  // namespace cell
