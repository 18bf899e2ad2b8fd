#include "service/acquisition/start_request.hpp"

#include <gtest/gtest.h>

#include "config/config_error.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

TEST(StartRequest, LeavesTheRecipesChoiceOfStiffnessWhereItHasNone) {
  const StartRequest plain{.recipe = "edf-25"};
  EXPECT_FALSE(given_to(plain, edf()).stiffness);
  EXPECT_FALSE(recipe_of(plain, edf()).identification.stiffness);
  EXPECT_FALSE(stiffness_to_store(plain));
}

TEST(StartRequest, HasItsChoiceOfStiffnessInPlanRecipeAndStore) {
  for (const StiffnessChoice choice : {StiffnessChoice::kOn, StiffnessChoice::kOff, StiffnessChoice::kAuto}) {
    const StartRequest request{.recipe = "edf-25", .stiffness = choice};
    const bool is_elastic = choice != StiffnessChoice::kOff;
    EXPECT_EQ(given_to(request, edf()).stiffness, is_elastic);
    EXPECT_EQ(recipe_of(request, edf()).identification.stiffness, is_elastic);
    EXPECT_EQ(stiffness_choice_named(stiffness_to_store(request).value()), choice);
  }
}

TEST(StartRequest, CannotAskForTheStiffnessOfAnArmThatSaysNothingOfIt) {
  Cell rigid = edf();
  rigid.arm.nongeometric_std = {};
  EXPECT_THROW(recipe_of({.recipe = "edf-25", .stiffness = StiffnessChoice::kOn}, rigid), ConfigError);
  EXPECT_EQ(given_to({.recipe = "edf-25", .stiffness = StiffnessChoice::kAuto}, rigid).stiffness, false);
}

}  // namespace
}  // namespace cell
