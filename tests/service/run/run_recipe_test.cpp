#include "service/run/run_recipe.hpp"

#include <gtest/gtest.h>

#include "config/config_error.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

bool stiffness_of(const std::optional<std::string>& stored, const Cell& cell = edf()) {
  return recipe_of({.recipe = "edf-25", .stiffness = stored}, cell).identification.stiffness;
}

TEST(RecipeOfARun, HasTheChoiceThatTheRunWasStartedWith) {
  ASSERT_FALSE(edf().recipes.at("edf-25").identification.stiffness);
  EXPECT_FALSE(stiffness_of(std::nullopt));
  EXPECT_FALSE(stiffness_of("off"));
  EXPECT_TRUE(stiffness_of("on"));
  EXPECT_TRUE(stiffness_of("auto"));
}

TEST(RecipeOfARun, IsRefusedWhenTheArmNoLongerHasACompliance) {
  Cell rigid = edf();
  rigid.arm.nongeometric_std = {};
  EXPECT_FALSE(stiffness_of("auto", rigid));
  EXPECT_THROW(stiffness_of("on", rigid), ConfigError);
}

}  // namespace
}  // namespace cell
