#include "config/touched_places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.hpp"
#include "config/identification_problem.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

json stand() {
  return {{"name", "stand"},  {"position_mm", {0, -300, 0}}, {"rotation_deg", {0, 0, 0}},
          {"place", "known"}, {"std_position_mm", 0.01},     {"std_rotation_rad", 3e-5}};
}
json shelf() {
  return {{"name", "shelf"},
          {"position_mm", {300, 0, 0}},
          {"rotation_deg", {0, 0, 5}},
          {"place", "estimated"},
          {"within_mm", 3}};
}

class TouchedPlaces : public CopiedConfig {
 protected:
  TouchedPlaces() {
    edit(kBlock, [](json& block) {
      block["schema"] = "touchcal/block/4";
      block["places"] = {stand(), shelf()};
    });
    edit(kRecipe, [](json& recipe) {
      recipe["schema"] = "touchcal/recipe/4";
      recipe["places"] = {"shelf", "stand"};
    });
  }
  std::string refusal_of(const std::string& file, const std::function<void(json&)>& change) {
    edit(file, change);
    try {
      static_cast<void>(read());
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(TouchedPlaces, TheFacesAreNumberedOnInTheOrderOfTheRecipe) {
  const Cell cell = read();
  const Recipe& recipe = cell.recipes.at("edf-25");
  EXPECT_THAT(recipe.places, ElementsAre(1, 0));
  EXPECT_EQ(place_count(recipe), 3);
  EXPECT_EQ(place_name(cell.block, recipe, 0), "first");
  EXPECT_EQ(place_name(cell.block, recipe, 1), "shelf");
  EXPECT_EQ(place_name(cell.block, recipe, 2), "stand");
  EXPECT_EQ(place_of_face(cell.block, recipe, 4), 0);
  EXPECT_EQ(place_of_face(cell.block, recipe, 5), 1);
  EXPECT_EQ(further_place_name(cell.block, recipe, 12), "stand");
  EXPECT_FALSE(further_place_name(cell.block, recipe, 3));
  EXPECT_EQ(faces_of_places(cell.block, recipe).size(), 15u);
  EXPECT_TRUE(is_found_by_touches(cell.block, recipe, 1));
  EXPECT_DOUBLE_EQ(found_within_m(cell.block, recipe, 1), 0.003);
  EXPECT_FALSE(is_found_by_touches(cell.block, recipe, 2));
}

TEST_F(TouchedPlaces, TheFacesAreNumberedOnForEachTipAtEachPlace) {
  Cell cell = read();
  Recipe recipe = cell.recipes.at("edf-25");
  for (const char* name : {"left", "back"})
    cell.probe.tips.push_back({.name = name, .center_m = {0.03, 0.0, -0.045}, .radius_m = 0.002});
  recipe.tips = {1};
  EXPECT_EQ(tip_count(recipe), 2);
  EXPECT_EQ(faces_per_place(cell.block, recipe), 10);
  EXPECT_EQ(place_of_face(cell.block, recipe, 9), 0);
  EXPECT_EQ(tip_of_face(cell.block, recipe, 9), 1);
  EXPECT_EQ(place_of_face(cell.block, recipe, 12), 1);
  EXPECT_EQ(tip_of_face(cell.block, recipe, 12), 0);
  EXPECT_EQ(further_tip_name(cell, recipe, 15), "back");
  EXPECT_EQ(further_place_name(cell.block, recipe, 15), "shelf");
  EXPECT_FALSE(further_tip_name(cell, recipe, 12));
  EXPECT_EQ(faces_of_places(cell.block, recipe).size(), 30u);
  EXPECT_EQ(&face_of_block(cell.block, 17), &cell.block.faces[2]);
  recipe.faces = {0, 2, 4};
  EXPECT_THAT(faces_at_place(cell.block, recipe, 0), ElementsAre(0, 2, 4, 5, 7, 9));
  EXPECT_THAT(faces_at_place(cell.block, recipe, 1), ElementsAre(10, 12, 15, 17));
  const calib::ArtefactKnowledge knowledge = artefact_knowledge(cell, recipe);
  ASSERT_EQ(knowledge.tips.size(), 1u);
  EXPECT_EQ(knowledge.tips[0].name, "back");
}

TEST_F(TouchedPlaces, ThePlateStaysWhereItIs) {
  const Cell cell = read();
  Recipe recipe = cell.recipes.at("edf-25");
  recipe.faces = {0, 2, 4};
  EXPECT_THAT(faces_at_place(cell.block, recipe, 0), ElementsAre(0, 2, 4));
  EXPECT_THAT(faces_at_place(cell.block, recipe, 1), ElementsAre(5, 7));
  EXPECT_THAT(touched_faces(cell.block, recipe), ElementsAre(0, 2, 4, 5, 7, 10, 12));
}

TEST_F(TouchedPlaces, APlaceIsTheSameFromEachOther) {
  const Cell cell = read();
  const Recipe& recipe = cell.recipes.at("edf-25");
  const auto from_first = artefact_places(cell.block, recipe, 0);
  const auto from_stand = artefact_places(cell.block, recipe, 2);
  ASSERT_EQ(from_first.size(), 3u);
  EXPECT_TRUE(from_stand[2].pose.isApprox(Eigen::Isometry3d::Identity()));
  for (std::size_t place = 0; place < 3; ++place)
    EXPECT_TRUE(from_first[place].pose.isApprox(from_first[2].pose * from_stand[place].pose, 1e-12)) << place;
  EXPECT_EQ(from_first[0].std->std_position_m, 0.0);
  EXPECT_FALSE(from_first[1].std);
  EXPECT_DOUBLE_EQ(from_first[2].std->std_turn_rad, 3e-5);
}

TEST_F(TouchedPlaces, TheStepIsAsWarmAsTheBlock) {
  edit(kBlock, [](json& block) {
    block["temperature_c"] = 25;
    block["places"][1]["thermal_expansion_per_k"] = 0;
  });
  const Cell cell = read();
  const auto places = artefact_places(cell.block, cell.recipes.at("edf-25"));
  const double expansion = cell.block.thermal_expansion_per_k.value();
  EXPECT_NEAR(places[2].pose.translation().y(), -0.3 * (1.0 + 5.0 * expansion), 1e-15);
  EXPECT_NEAR(places[2].growth_m_per_k.y(), -0.3 * expansion, 1e-15);
  EXPECT_DOUBLE_EQ(places[1].pose.translation().x(), 0.3);
  EXPECT_TRUE(places[1].growth_m_per_k.isZero());
}

TEST_F(TouchedPlaces, ARecipeWithoutPlacesIsAsBefore) {
  edit(kRecipe, [](json& recipe) { recipe.erase("places"); });
  const Cell cell = read();
  const Recipe& recipe = cell.recipes.at("edf-25");
  EXPECT_TRUE(artefact_places(cell.block, recipe).empty());
  EXPECT_EQ(identification_problem(cell, recipe).artefact.contact_planes.size(), 5u);
}

TEST_F(TouchedPlaces, RefusesABlockWithTwoPlacesOfOneName) {
  EXPECT_THAT(refusal_of(kBlock, [](json& block) { block["places"][1]["name"] = "stand"; }),
              HasSubstr("is there twice"));
  EXPECT_THAT(refusal_of(kBlock, [](json& block) { block["places"][0]["std_position_mm"] = 0; }),
              HasSubstr("/places/0/std_position_mm"));
}

TEST_F(TouchedPlaces, RefusesPlacesInABlockOfAnEarlierSchema) {
  EXPECT_THAT(refusal_of(kBlock, [](json& block) { block["schema"] = "touchcal/block/3"; }),
              HasSubstr(R"(raise "schema" to 4)"));
}

TEST_F(TouchedPlaces, RefusesARecipeThatNamesNoPlaceOfTheBlock) {
  const auto with = [](json places) { return [=](json& recipe) { recipe["places"] = places; }; };
  EXPECT_THAT(refusal_of(kRecipe, with({"roof"})), HasSubstr("has no place \"roof\""));
  EXPECT_THAT(refusal_of(kRecipe, with({"stand", "stand"})), HasSubstr("is there twice"));
  EXPECT_THAT(refusal_of(kRecipe,
                         [](json& recipe) {
                           recipe["places"] = {"stand"};
                           recipe["touches"]["planes"] = {5};
                         }),
              HasSubstr("none of the recipe's planes moves there"));
  EXPECT_THAT(refusal_of(kRecipe,
                         [](json& recipe) {
                           recipe["touches"]["planes"] = {1, 2};
                           recipe["identification"]["formulation"] = "plane_coefficients";
                         }),
              HasSubstr("stands beside the formulation"));
  EXPECT_THAT(refusal_of(kRecipe, [](json& recipe) { recipe["schema"] = "touchcal/recipe/3"; }),
              HasSubstr(R"(raise "schema" to 4)"));
}

}  // namespace
}  // namespace cell
