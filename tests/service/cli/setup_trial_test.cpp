#include "service/cli/setup_trial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/setup/made_cell.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

SetupAnswers away_from_the_block(double away_mm) {
  SetupAnswers answers;
  answers.base = BasePlace{{-away_mm, -120.0, 0.0}, {90.0, 0.0, 0.0}};
  answers.keep_out_boxes.clear();
  return answers;
}

TEST(SetupTrial, FindsTouchesOfEachFaceOfACellThatIsGood) { demand_touchable_faces(made_cell({})); }

TEST(SetupTrial, NamesThePlaneThatCannotBeTouchedAndTheAnswerInTheWay) {
  const Cell cell = made_cell(away_from_the_block(2500.0));
  const ConfigError quick = error_of([&] { demand_touchable_faces(cell); });
  EXPECT_EQ(quick.pointer(), "/base");
  EXPECT_THAT(quick.message(), HasSubstr("plane 1: 0 of"));
  const ConfigError planned = error_of([&] { try_recipes(cell, true); });
  EXPECT_EQ(planned.source(), "recipe quick");
  EXPECT_THAT(planned.message(), HasSubstr("no plan can be made"));
}

TEST(SetupTrial, PromisesWhatThePlanOfTheDefaultRecipePromisesAndHalfOfItMore) {
  const RecipeTrial trial = try_recipes(made_cell({}), true);
  ASSERT_EQ(trial.tip_box_max_mm.size(), 1U);
  EXPECT_GT(trial.tip_box_max_mm.at("quick"), 0.3);
  EXPECT_LT(trial.tip_box_max_mm.at("quick"), 0.6);
}

}  // namespace
}  // namespace cell
