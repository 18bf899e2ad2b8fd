#include "service/offline_programs/program_tokens.hpp"

#include <gmock/gmock.h>

#include <string>

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> texts_of(std::string_view line) {
  std::vector<std::string> texts;
  for (const ProgramToken& token : program_tokens(line)) texts.emplace_back(token.text);
  return texts;
}

TEST(ProgramTokens, AreWordsNumbersTextsAndSigns) {
  EXPECT_THAT(
      texts_of("  pA[2].trsf.x=-1.5*.2 != \"a (b\"\r"),
      ElementsAre("pA", "[", "2", "]", ".", "trsf", ".", "x", "=", "-", "1.5", "*", ".2", "!=", "a (b"));
  EXPECT_EQ(program_tokens("x=12.25").back().number, 12.25);
  EXPECT_EQ(program_tokens("put(\"x\")")[2].kind, ProgramToken::Kind::kText);
  EXPECT_THAT(texts_of("$delete(\"open"), ElementsAre("$delete", "(", "open"));
}

TEST(ProgramTokens, AreNoneOfAComment) {
  EXPECT_THAT(texts_of("  // pA=appro(pA,trA)"), IsEmpty());
  EXPECT_THAT(texts_of("   "), IsEmpty());
  EXPECT_THAT(texts_of("s=\"http://x\""), ElementsAre("s", "=", "http://x"));
}

TEST(ProgramTokens, AreListedByTheBracketsAroundThem) {
  const std::string line = "movel(appro(pA[i,2],{0,0,-1,0,0,0}),tGrip,mSlow)";
  const auto tokens = program_tokens(line);
  const auto arguments = listed_in(tokens, 1);
  ASSERT_EQ(arguments.size(), 3U);
  EXPECT_EQ(tokens[arguments[1].first].text, "tGrip");
  EXPECT_EQ(tokens[arguments[0].second].text, ",");
  EXPECT_THAT(listed_in(program_tokens("herej()"), 1), IsEmpty());
  EXPECT_EQ(closing_of(program_tokens("f(a[1"), 1), 5U) << "a bracket that nothing closes ends with the line";
  EXPECT_EQ(listed_in(program_tokens("f(a,b[1"), 1).size(), 2U);
}

TEST(ProgramTokens, TellOwnNamesFromFieldsAndLibraries) {
  const auto tokens = program_tokens("a=b.c+lib:d");
  EXPECT_TRUE(is_own_name(tokens, 0));
  EXPECT_FALSE(is_own_name(tokens, 1));
  EXPECT_TRUE(is_own_name(tokens, 2));
  EXPECT_FALSE(is_own_name(tokens, 4));
  EXPECT_FALSE(is_own_name(tokens, 6));
  EXPECT_FALSE(is_own_name(tokens, 8));
  EXPECT_FALSE(is_own_name(tokens, 9));
}

}  // namespace
}  // namespace cell
