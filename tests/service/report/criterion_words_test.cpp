#include "service/report/internal/criterion_words.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(CriterionWords, InEnglishARowIsThatOfTheTableOfLimits) {
  DecisionRuleDocument rule{.rule = "simple"};
  rule.criteria = {{.name = "held_out_mean", .plane = 3, .unit = "mm", .value = 0.25, .limit = 0.125},
                   {.name = "complete", .unit = "1", .value = 0.0, .limit = 1.0},
                   {.name = "held_out_touches", .unit = "1", .value = 4.0, .side = "lower", .limit = 8.0},
                   {.name = "tool_box_rms", .tool = "gripper", .unit = "mm", .limit = 0.5}};
  const std::vector<LimitRow> rows = limit_rows(rule, {{3, "stand"}});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(criterion_words(english(), rule.criteria[i], {{3, "stand"}}), rows[i].criterion);
    EXPECT_EQ(value_words(english(), rule.criteria[i]), rows[i].value);
    EXPECT_EQ(limit_words(english(), rule.criteria[i]), rows[i].limit);
  }
}

TEST(CriterionWords, AReasonSaysWhatIsMissed) {
  const Words& french = *words_in("fr");
  CriterionFigures mean{.name = "held_out_mean",
                        .plane = 3,
                        .unit = "mm",
                        .value = 0.25,
                        .side = "upper",
                        .limit = 0.125,
                        .expanded_uncertainty = 0.05,
                        .within_limit = false};
  EXPECT_EQ(reason_words(french, mean, {}),
            "moyenne de vérification, plan 3 : 0,250 mm, la limite est 0,125 mm");
  mean.value = 0.1;
  mean.within_limit = true;
  EXPECT_EQ(reason_words(french, mean, {}),
            "moyenne de vérification, plan 3 : 0,100 mm ± 0,050 mm, pas sûrement dans la limite de 0,125 mm");
  EXPECT_EQ(reason_words(french, {.name = "converged", .value = 0.0, .limit = 1.0}, {}),
            "identification convergée : non");
}

}  // namespace
}  // namespace cell
