// Examples of manual 6, pages 48 to 55.
#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

/// What a string expression gives; "error N" where its line fails.
std::string text_of(const std::string& expression) {
  SmallProject project;
  with_variables(project).program("start", "s[0]=" + expression + "\nwait(false)");
  Running run(project);
  run.ticks(4);
  const int status = run.machine().task_status("small~");
  return status == 1 ? run.text("s", 0) : "error " + std::to_string(status);
}

TEST(Texts, AreAsTheManualsExamples) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"toString(\".4\",3.14159265)", "3.1416"},
      {"toString(\"8\",3.14159265)", "       3"},
      {"toString(\"8.4\",2.70001)", "  2.7   "},
      {"toString(\"\",3.9)", "4"},
      {"toString(\".3\",2.5)", "2.5  "},
      {"left(\"hello world\",5)", "hello"},
      {"left(\"ab\",9)", "ab"},
      {"right(\"hello world\",5)", "world"},
      {"mid(\"hello wild world\",4,6)", "wild"},
      {"insert(\"hello world\",\"wild \",6)", "hello wild world"},
      {"insert(\"ab\",\"c\",9)", "abc"},
      {"delete(\"hello wild world\",5,6)", "hello world"},
      {"delete(\"ab\",1,9)", "ab"},
      {"replace(\"hello ? world\",\"wild\",1,6)", "hello wild world"},
      {"chr(65)", "A"},
      {"chr(233)", "\xC3\xA9"},
      {"chr(0)", ""},
      {"\"a\"+\"b\"", "ab"},
      {"left(\"a\",-1)", "error 70"},
      {"toString(\"x\",1)", "error 70"},
  };
  for (const auto& [expression, text] : cases) EXPECT_EQ(text_of(expression), text) << expression;
}

TEST(Texts, AreCutAt128BytesAndNotInACharacter) {
  const std::string hundred(100, 'a');
  EXPECT_EQ(text_of("\"" + hundred + "\"+\"" + hundred + "\"").size(), 128U);
  const std::string odd = text_of("\"" + std::string(127, 'a') + "\"+chr(233)");
  EXPECT_EQ(odd.size(), 127U);
}

TEST(Texts, CountCharactersAndFindThem) {
  expect_values({{"len(\"hello world\")", 11},
                 {"len(chr(233)+\"a\")", 2},
                 {"find(\"hello world\",\"wo\")", 6},
                 {"find(\"a\",\"b\")", -1},
                 {"find(chr(233)+\"a\",\"a\")", 1},
                 {"asc(\"A\",0)", 65},
                 {"asc(chr(233)+\"B\",1)", 66},
                 {"asc(chr(233),0)", 233},
                 {"asc(\"A\",3)", -1},
                 {"asc(\"A\",-1)", -1}});
}

TEST(Texts, ANumberIsReadFromTheFrontAndTheNextOneIsLeft) {
  const std::vector<std::tuple<std::string, double, bool, std::string>> cases{
      {"10 20", 10, true, "20"},      {"10 end", 10, true, ""}, {"a10 20", 7, false, "a10 20"},
      {"+5.5mm -2", 5.5, true, "-2"}, {"-.5", -0.5, true, ""},  {"", 7, false, ""}};
  for (const auto& [text, number, ok, rest] : cases) {
    SmallProject project;
    with_variables(project).program("start", "n=7\ns[1]=toNum(\"" + text + "\",n,b)");
    Running run(project);
    run.ticks(2);
    EXPECT_EQ(run.number("n"), number) << text;
    EXPECT_EQ(run.truth("b"), ok) << text;
    EXPECT_EQ(run.text("s", 1), rest) << text;
  }
}

TEST(Texts, TakeAColumnOfThePageForEachCharacter) {
  expect_values({{"getDisplayLen(\"abc\")", 3},
                 {"getDisplayLen(\"D\xC3\xA9"
                  "but \xE2\x82\xAC\")",
                  7},
                 {"getDisplayLen(\"\")", 0}});
}

TEST(Texts, GoToAScreenAsToThePage) {
  SmallProject project;
  project.data("scr", "screen", "").number("n", 2);
  project.program(
      "start",
      "userPage(scr,true)\ncls(scr)\nsetTextMode(scr,1)\nput(scr,\"a\")\nn=getDisplayLen(scr,\"abc\")");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.number("n"), 3) << run.log();
}

}  // namespace
}  // namespace val3
