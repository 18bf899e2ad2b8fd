#include "service/documents/limit_table.hpp"

#include <gmock/gmock.h>

namespace cell {
namespace {

using ::testing::ElementsAre;

DecisionRuleDocument::CriterionFigures mean() {
  return {.name = "held_out_mean",
          .plane = 3,
          .tool = {},
          .unit = "mm",
          .value = 0.0449,
          .side = "upper",
          .limit = 0.05,
          .expanded_uncertainty = 0.01,
          .within_limit = true,
          .proved = false};
}

DecisionRuleDocument::CriterionFigures fit() {
  return {.name = "lack_of_fit",
          .plane = {},
          .tool = {},
          .unit = "1",
          .value = 0.0007557,
          .side = "lower",
          .limit = 0.03,
          .expanded_uncertainty = {},
          .within_limit = false,
          .proved = {}};
}

DecisionRuleDocument rule_of(const char* rule) {
  DecisionRuleDocument document;
  document.rule = rule;
  document.criteria = {mean(), fit()};
  return document;
}

TEST(LimitTable, AFigureIsReadBesideItsLimit) {
  EXPECT_EQ(figure_beside_limit(fit(), 0.03), "0.03");
  EXPECT_EQ(figure_beside_limit(fit(), 0.0007557), "0.001");
  EXPECT_EQ(figure_beside_limit(fit(), 1e-14), "< 0.001");
  EXPECT_EQ(figure_beside_limit(mean(), 0.01), "0.010 mm");
  EXPECT_EQ(figure_beside_limit(mean(), -0.0), "0.000 mm");
  EXPECT_EQ(figure_beside_limit(mean(), -0.0001), "0.000 mm");
  EXPECT_EQ(figure_beside_limit(mean(), {}), "unknown");
}

TEST(LimitTable, OnlyASmallFigureHasTheDecimalsOfASmallLimit) {
  DecisionRuleDocument::CriterionFigures of_plane = fit();
  of_plane.limit = 0.001 / 5;
  EXPECT_EQ(figure_beside_limit(of_plane, of_plane.limit), "0.0002");
  EXPECT_EQ(figure_beside_limit(of_plane, 0.73046), "0.73");
  EXPECT_EQ(figure_beside_limit(of_plane, 0.00015), "0.00015");
  of_plane.limit = 0.1;
  EXPECT_EQ(figure_beside_limit(of_plane, of_plane.limit), "0.10");
  EXPECT_EQ(figure_beside_limit(of_plane, 0.0222), "0.02");
}

TEST(LimitTable, ACountHasNoDecimals) {
  DecisionRuleDocument::CriterionFigures count = fit();
  count.name = "held_out_touches";
  count.limit = 1.0;
  count.value = 40.0;
  EXPECT_EQ(figure_beside_limit(count, count.value), "40");
  count.value = 92.4;
  EXPECT_EQ(figure_beside_limit(count, count.value), "92.4");
}

TEST(LimitTable, WhatRejectsFailsAndComesFirst) {
  EXPECT_THAT(limit_rows(rule_of("simple")),
              ElementsAre(LimitRow{"lack of fit", "FAIL", "0.001", "at least 0.03", ""},
                          LimitRow{"held out mean, plane 3", "pass", "0.045 mm", "0.050 mm", "0.010 mm"}));
}

TEST(LimitTable, APlaneAtAFurtherPlaceIsNamedWithIt) {
  DecisionRuleDocument rule = rule_of("simple");
  rule.criteria = {mean()};
  rule.criteria[0].plane = 8;
  EXPECT_EQ(limit_rows(rule, {{8, "stand"}}).at(0).criterion, "held out mean, plane 8 (stand)");
}

TEST(LimitTable, AGuardedRuleFailsWhatIsNotProven) {
  EXPECT_EQ(decision_text(mean(), "simple"), "pass");
  EXPECT_EQ(decision_text(mean(), "guarded"), "FAIL (not proven)");
  DecisionRuleDocument::CriterionFigures proven = mean();
  proven.proved = true;
  EXPECT_EQ(decision_text(proven, "guarded"), "pass (proven)");
  DecisionRuleDocument::CriterionFigures exact = mean();
  exact.proved.reset();
  EXPECT_EQ(decision_text(exact, "guarded"), "pass");
  exact.within_limit.reset();
  EXPECT_EQ(decision_text(exact, "guarded"), "unknown");
}

TEST(LimitTable, WhatIsSoOrNotIsSaidInAWord) {
  DecisionRuleDocument rule = rule_of("simple");
  rule.criteria = {mean()};
  rule.criteria[0].name = "complete";
  rule.criteria[0].plane.reset();
  rule.criteria[0].value = 0.0;
  rule.criteria[0].expanded_uncertainty.reset();
  rule.criteria[0].within_limit = false;
  EXPECT_THAT(limit_rows(rule), ElementsAre(LimitRow{"complete", "FAIL", "no", "", ""}));
}

}  // namespace
}  // namespace cell
