#include "service/cli/comparison_text.hpp"

#include <gmock/gmock.h>

#include <sstream>

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

ComparisonDocument::Combination combination(double e_n, int shares) {
  ComparisonDocument::Combination made{.e_n = e_n, .shares = {}};
  for (int k = 0; k < shares; ++k)
    made.shares.push_back({.parameter = "compliance" + std::to_string(k), .share = -0.4});
  return made;
}

ComparisonDocument slipped() {
  ComparisonDocument document;
  document.earlier = "3";
  document.later = "9";
  document.verdict = {.accepted = false, .reasons = {"the arm has changed"}};
  document.growth_ppm = 12.5;
  document.arm = {
      .changed = true, .p = 1e-5, .chi_square = 90.0, .degrees_of_freedom = 15.0, .combinations = {}};
  document.arm.combinations = {combination(2.5, 2), combination(-0.3, 20), combination(0.2, 1),
                               combination(0.1, 1), combination(0.1, 1),   combination(0.0, 1)};
  return document;
}

TEST(ComparisonText, FitsATerminalAndMarksWhatChanceDoesNotExplain) {
  const std::string text = comparison_text(slipped());
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
  EXPECT_THAT(text, AllOf(HasSubstr("runs 3 and 9: CHANGED"), HasSubstr("the arm has changed"),
                          HasSubstr("!   2.50  -0.4 compliance0 -0.4 compliance1\n"),
                          HasSubstr("   -0.30  -0.4 compliance0"), HasSubstr("compliance2 ...\n"),
                          HasSubstr("and 1 that differ less"), HasSubstr("arm: CHANGED")));
  EXPECT_THAT(text, HasSubstr("stylus: nothing of it was identified"));
}

TEST(ComparisonText, OfAnArmThatIsAsItWasSaysSo) {
  ComparisonDocument document = slipped();
  document.verdict = {.accepted = true, .reasons = {}};
  document.arm.changed = false;
  EXPECT_THAT(comparison_text(document), AllOf(HasSubstr("UNCHANGED"), Not(HasSubstr("CHANGED and"))));
}

}  // namespace
}  // namespace cell
