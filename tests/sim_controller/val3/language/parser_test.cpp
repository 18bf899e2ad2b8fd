// A program's lines: what they are, how their blocks are linked, and what a controller refuses.
#include "sim_controller/val3/language/parser.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>

#include "sim_controller/val3/language/lexer.hpp"
#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct ParsedProgram {
  std::vector<Line> lines;
  Findings findings;
};

ParsedProgram parsed(const std::string& code, int first_line = 1) {
  ParsedProgram result;
  result.lines = parse(code, "p.pgx", first_line, result.findings);
  return result;
}

/// Between begin and end, from line 2.
ParsedProgram parsed_lines(std::initializer_list<const char*> lines) {
  std::string code = "begin\n";
  for (const char* line : lines) code += std::string(line) + "\n";
  return parsed(code + "end\n");
}

/// "4 unpaired-block"
std::vector<std::string> rules_of(const ParsedProgram& program) {
  std::vector<std::string> result;
  for (const Finding& finding : program.findings)
    result.push_back(std::to_string(finding.at.line) + " " + finding.rule);
  return result;
}

std::vector<Line::Kind> kinds_of(const ParsedProgram& program) {
  std::vector<Line::Kind> result;
  for (const Line& line : program.lines) result.push_back(line.kind);
  return result;
}

using LineKind = Line::Kind;

TEST(Parser, ReadsEveryKindOfLine) {
  const ParsedProgram program =
      parsed_lines({"  // a comment", "", "a=1", "a=b=c+1", "cls()", "call doIt(a,2)", "call lib:doIt()",
                    "taskCreate \"t\",10,run(a)", "taskCreateSync \"s\",0.004,over,lib:run(a,b)",
                    "lib:libLoad(\"x\")", "a[0].b=lib:c", "?a+1", "return", "{1}"});
  EXPECT_THAT(rules_of(program), ElementsAre("15 no-effect"));
  EXPECT_THAT(
      kinds_of(program),
      ElementsAre(LineKind::kAssign, LineKind::kAssign, LineKind::kInstruction, LineKind::kCall,
                  LineKind::kCall, LineKind::kTaskCreate, LineKind::kTaskCreateSync, LineKind::kInstruction,
                  LineKind::kAssign, LineKind::kInstruction, LineKind::kReturn, LineKind::kEnd));
  EXPECT_EQ(program.lines[0].line, 4);
  EXPECT_EQ(program.lines[1].expressions.size(), 3U);
  EXPECT_EQ(program.lines[3].program, "doIt");
  EXPECT_EQ(program.lines[3].expressions.size(), 2U);
  EXPECT_EQ(program.lines[4].alias, "lib");
  EXPECT_EQ(program.lines[5].program, "run");
  EXPECT_EQ(program.lines[5].expressions.size(), 3U);
  EXPECT_EQ(program.lines[6].alias, "lib");
  EXPECT_EQ(program.lines[6].expressions.size(), 5U);
  EXPECT_EQ(program.lines[7].expressions[0].alias, "lib");
  EXPECT_EQ(program.lines[9].expressions[0].text, "put");
}

TEST(Parser, LinksTheBranchesOfAnIf) {
  const ParsedProgram program = parsed_lines({"if a", "b=1", "elseIf c", "b=2", "else", "b=3", "endIf"});
  ASSERT_THAT(rules_of(program), IsEmpty());
  const auto& lines = program.lines;
  EXPECT_EQ(lines[0].next, 2U);
  EXPECT_EQ(lines[2].next, 4U);
  EXPECT_EQ(lines[4].next, 6U);
  EXPECT_EQ(lines[6].next, 6U);
  for (const std::size_t i : {0U, 2U, 4U, 6U}) {
    EXPECT_EQ(lines[i].open, 0U) << i;
    EXPECT_EQ(lines[i].close, 6U) << i;
  }
}

TEST(Parser, LinksLoops) {
  const ParsedProgram program =
      parsed_lines({"while a", "do", "for i[0]=1 to 10 step -2", "cls()", "endFor", "until b", "endWhile"});
  ASSERT_THAT(rules_of(program), IsEmpty());
  const auto& lines = program.lines;
  EXPECT_EQ(lines[0].close, 6U);
  EXPECT_EQ(lines[1].close, 5U);
  EXPECT_EQ(lines[2].next, 4U);
  EXPECT_EQ(lines[4].open, 2U);
  EXPECT_EQ(lines[5].open, 1U);
  EXPECT_EQ(lines[6].open, 0U);
  EXPECT_EQ(lines[2].expressions.size(), 4U);
}

TEST(Parser, LinksTheCasesOfASwitch) {
  const ParsedProgram program = parsed_lines(
      {"switch a", "case 1", "break", "case 2,3", "cls()", "break", "default", "break", "endSwitch"});
  ASSERT_THAT(rules_of(program), IsEmpty());
  const auto& lines = program.lines;
  EXPECT_EQ(lines[0].next, 1U);
  EXPECT_EQ(lines[1].next, 3U);
  EXPECT_EQ(lines[2].next, 3U);
  EXPECT_EQ(lines[3].next, 6U);
  EXPECT_EQ(lines[6].next, 8U);
  for (const std::size_t i : {0U, 1U, 2U, 3U, 5U, 6U, 7U, 8U}) {
    EXPECT_EQ(lines[i].close, 8U) << i;
    EXPECT_EQ(lines[i].open, 0U) << i;
  }
  EXPECT_EQ(lines[3].expressions.size(), 2U);
}

TEST(Parser, TellsOfBlocksThatAreNotPaired) {
  EXPECT_THAT(rules_of(parsed_lines({"if a", "b=1"})), ElementsAre("2 unpaired-block"));
  EXPECT_THAT(rules_of(parsed_lines({"endIf", "b=1", "endWhile", "else", "case 1"})),
              ElementsAre("2 unpaired-block", "4 unpaired-block", "5 unpaired-block", "6 unpaired-block"));
  EXPECT_THAT(rules_of(parsed_lines({"while a", "if b", "endWhile"})), ElementsAre("3 unpaired-block"));
  EXPECT_THAT(rules_of(parsed_lines({"if a", "else", "elseIf b", "endIf"})), ElementsAre("4 unpaired-block"));
}

TEST(Parser, TellsOfSwitchesThatAControllerRefuses) {
  EXPECT_THAT(rules_of(parsed_lines({"switch a", "case 1", "b=1", "case 2", "b=2", "endSwitch"})),
              ElementsAre("3 case-without-break", "5 case-without-break"));
  EXPECT_THAT(rules_of(parsed_lines({"break"})), ElementsAre("2 break-outside-case"));
  EXPECT_THAT(rules_of(parsed_lines({"switch a", "case 1", "if b", "break", "endIf", "break", "endSwitch"})),
              ElementsAre("5 break-outside-case"));
  EXPECT_THAT(rules_of(parsed_lines({"switch a", "default", "break", "case 1", "break", "endSwitch"})),
              ElementsAre("5 case-after-default"));
  EXPECT_THAT(rules_of(parsed_lines({"switch a", "b=1", "case 1", "break", "b=2", "endSwitch"})),
              ElementsAre("3 line-outside-case", "6 line-outside-case"));
}

TEST(Parser, KeepsTheLinesAroundABrokenOne) {
  const ParsedProgram program = parsed_lines({"a=1", "a=(", "if (b", "c=1", "endIf", "do", "until )", "a=2"});
  EXPECT_THAT(rules_of(program), ElementsAre("3 syntax", "4 missing-bracket", "8 syntax"));
  EXPECT_THAT(kinds_of(program), ElementsAre(LineKind::kAssign, LineKind::kAssign, LineKind::kDo,
                                             LineKind::kUntil, LineKind::kAssign, LineKind::kEnd));
  EXPECT_EQ(program.lines[2].close, 3U);
  EXPECT_EQ(program.lines[3].expressions.size(), 1U);
}

TEST(Parser, WantsOneBeginAndOneEnd) {
  EXPECT_THAT(rules_of(parsed("")), ElementsAre("1 missing-begin"));
  EXPECT_THAT(rules_of(parsed("\n a=1\nend\n")), ElementsAre("2 missing-begin"));
  EXPECT_THAT(rules_of(parsed("begin\na=1\n")), ElementsAre("3 missing-end"));
  EXPECT_THAT(rules_of(parsed("begin\nend\n\n// done\na=1\n")), ElementsAre("5 code-behind-end"));
  EXPECT_THAT(rules_of(parsed("\r\n  begin\r\n  a=1\r\n  end\r\n")), IsEmpty());
  EXPECT_THAT(kinds_of(parsed("begin\na=1\n")), ElementsAre(LineKind::kAssign, LineKind::kEnd));
}

TEST(Parser, CountsLinesFromWhereTheCodeBegins) {
  const ParsedProgram program = parsed("\nbegin\n\ta=\n  b=1\nend", 7);
  ASSERT_EQ(program.findings.size(), 1U);
  EXPECT_EQ(program.findings[0].at.file, "p.pgx");
  EXPECT_EQ(program.findings[0].at.line, 9);
  EXPECT_EQ(program.findings[0].at.column, 4);
  EXPECT_EQ(program.lines[0].line, 10);
  EXPECT_EQ(program.lines[0].column, 3);
  EXPECT_EQ(program.lines[1].line, 11);
}

TEST(Parser, RefusesWhatIsNoLine) {
  EXPECT_THAT(rules_of(parsed_lines({"a", "a==1", "a+1", "1=a", "f()=2", "a=b+c=d"})),
              ElementsAre("2 no-effect", "3 no-effect", "4 no-effect", "5 assignment-target",
                          "6 assignment-target", "7 assignment-in-expression"));
  EXPECT_THAT(rules_of(parsed_lines({"return 1", "call f", "call f()+1", "for 1=1 to 2", "endFor",
                                     "for i to 2", "endFor", "for i=1 step 2", "endFor"})),
              ElementsAre("2 trailing-characters", "3 syntax", "4 trailing-characters", "5 assignment-target",
                          "7 syntax", "9 syntax"));
}

TEST(Parser, KnowsAKeywordInAnotherCaseAndTellsOfIt) {
  EXPECT_THAT(rules_of(parsed_lines({"If a", "b=1", "endif"})),
              ElementsAre("2 keyword-case", "4 keyword-case"));
  EXPECT_THAT(rules_of(parsed_lines({"End=1", "Case[0]=2"})), IsEmpty());
}

TEST(Parser, NotesALineThatIsSwitchedOff) {
  const ParsedProgram program = parsed_lines({"  ; a=(", "a=1"});
  ASSERT_THAT(rules_of(program), ElementsAre("2 disabled-line"));
  EXPECT_EQ(program.findings[0].severity, Severity::kNote);
  EXPECT_THAT(kinds_of(program), ElementsAre(LineKind::kAssign, LineKind::kEnd));
}

TEST(Parser, RefusesALineThatIsTooLongAndAProgramThatIsNone) {
  EXPECT_THAT(rules_of(parsed("begin\na=" + std::string(kLineBytesMax, '1') + "\nend")),
              ElementsAre("2 line-too-long"));
  std::string garbage = "begin\n";
  for (int i = 0; i < 1000; ++i) garbage += "#\n";
  const ParsedProgram program = parsed(garbage);
  EXPECT_EQ(program.findings.size(), kFindingsPerProgramMax + 1);
  EXPECT_EQ(program.findings.back().rule, syntax_rules::kTooManyFindings);
}

TEST(Parser, ReadsBlocksOfAnyDepth) {
  std::string code = "begin\n";
  for (int i = 0; i < 50'000; ++i) code += "if a\n";
  for (int i = 0; i < 50'000; ++i) code += "endIf\n";
  const ParsedProgram program = parsed(code + "end");
  EXPECT_THAT(rules_of(program), IsEmpty());
  EXPECT_EQ(program.lines[0].close, 99'999U);
}

}  // namespace
}  // namespace val3
