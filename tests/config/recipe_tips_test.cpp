// The tips of a star stylus that a recipe touches with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "copied_config.hpp"
#include "probe_with_star.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class RecipeTips : public CopiedConfig {
 protected:
  RecipeTips() {
    edit(kProbe, [](json& probe) {
      add_tips(probe,
               {star_tip("left", {40, 0, -20}, {1, 0, 0}), star_tip("back", {0, -40, -20}, {0, -1, 0})});
    });
    with_tips({"back", "left"});
  }
  void with_tips(const json& names) const {
    edit(kRecipe, [&](json& recipe) {
      recipe["schema"] = "touchcal/recipe/5";
      recipe["tips"] = names;
    });
  }
  [[nodiscard]] std::vector<int> tips() const { return read().recipes.at("edf-25").tips; }
  [[nodiscard]] ConfigError error() const {
    return error_of([&] { static_cast<void>(read()); });
  }
};

TEST_F(RecipeTips, AreInTheOrderOfTheRecipe) {
  EXPECT_THAT(tips(), ElementsAre(1, 0));
  with_tips({"left"});
  EXPECT_THAT(tips(), ElementsAre(0));
  edit(kRecipe, [](json& recipe) { recipe.erase("tips"); });
  EXPECT_TRUE(tips().empty());
}

TEST_F(RecipeTips, AreTipsOfTheProbeEachOnce) {
  with_tips({"left", "up"});
  EXPECT_EQ(error().pointer(), "/tips/1");
  EXPECT_THAT(error().message(), HasSubstr("has no tip \"up\"; give one of \"tips\" in its file"));
  with_tips({"first"});
  EXPECT_THAT(error().message(), HasSubstr("has no tip \"first\""));
  with_tips({"left", "left"});
  EXPECT_THAT(error().message(), HasSubstr("is there twice"));
  with_tips(json::array());
  EXPECT_EQ(error().pointer(), "/tips");
}

TEST_F(RecipeTips, AreOfAProbeThatHasSome) {
  edit(kProbe, [](json& probe) { probe.erase("tips"); });
  EXPECT_EQ(error().pointer(), "/tips");
  EXPECT_THAT(error().source(), testing::EndsWith(kRecipe));
  EXPECT_THAT(error().message(), HasSubstr("has no tips but the first; leave this out"));
}

TEST_F(RecipeTips, HaveNoPlaneCoefficients) {
  edit(kRecipe, [](json& recipe) {
    recipe["identification"]["formulation"] = "plane_coefficients";
    recipe["touches"]["planes"] = {1, 2};
  });
  EXPECT_EQ(error().pointer(), "/tips");
  EXPECT_THAT(error().message(), HasSubstr("stands beside the formulation"));
}

TEST_F(RecipeTips, AreThoseOfTheFifthSchema) {
  edit(kRecipe, [](json& recipe) { recipe["schema"] = "touchcal/recipe/4"; });
  EXPECT_EQ(error().pointer(), "/tips");
  EXPECT_THAT(error().message(), HasSubstr(R"(raise "schema" to 5)"));
}

}  // namespace
}  // namespace cell
