// What documents say of a block that stands at several places in a run, and of several tips that touch it.
#include "service/documents/plane_places.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/documents/cell_view.hpp"
#include "service/documents/result_view.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;

constexpr double kStandMetres = 0.3;
constexpr double kTurnRad = 0.5;

/// The paper's cell with a stand, to which the recipe brings the block.
Cell cell_with_stand() {
  Cell cell = edf();
  BlockPlace stand{.name = "stand", .std = calib::PlaceDeviation{}};
  stand.first_from_place =
      Eigen::Translation3d(0.0, -kStandMetres, 0.0) * Eigen::AngleAxisd(kTurnRad, Eigen::Vector3d::UnitY());
  cell.block.places = {stand, {.name = "shelf"}};
  cell.recipes.at("edf-25").places = {0};
  return cell;
}

TEST(CellDocument, SaysWhereElseTheBlockCanStand) {
  const json block = json::parse(cell_document(cell_with_stand(), std::nullopt)).at("block");
  const json& stand = block.at("places").at(0);
  EXPECT_EQ(stand.at("name"), "stand");
  EXPECT_EQ(stand.at("is_known"), true);
  EXPECT_EQ(block.at("places").at(1).at("is_known"), false);
  EXPECT_NEAR(stand.at("shift_mm").at(1).get<double>(), -1e3 * kStandMetres, 1e-9);
  EXPECT_NEAR(stand.at("turn_deg").at(1).get<double>(), kTurnRad / calib::kRadiansPerDegree, 1e-9);
  EXPECT_EQ(block.at("places").at(1).at("turn_deg"), json({0.0, 0.0, 0.0}));
  EXPECT_EQ(json::parse(cell_document(edf(), std::nullopt)).at("block").at("places"), json::array());
}

TEST(RecipesDocument, SaysWhereTheBlockIsBrought) {
  const Cell cell = cell_with_stand();
  for (const json& recipe : json::parse(recipes_document(cell)).at("recipes")) {
    const bool moves = recipe.at("name") == "edf-25";
    EXPECT_EQ(recipe.at("places"), moves ? json({"stand"}) : json::array());
    if (!moves) continue;
    EXPECT_GT(recipe.at("planes").back(), cell.block.faces.size()) << "they are numbered on";
  }
}

/// The same with a star stylus, of which the recipe takes the second further tip, then the first.
Cell cell_with_star() {
  Cell cell = cell_with_stand();
  cell.probe.tips = {{.name = "left", .center_m = {0.04, 0.0, -0.03}, .radius_m = 1.5e-3}, {.name = "right"}};
  cell.recipes.at("edf-25").tips = {1, 0};
  return cell;
}

TEST(CellDocument, SaysWhichFurtherTipsTheProbeHas) {
  const json tips = json::parse(cell_document(cell_with_star(), std::nullopt)).at("probe").at("tips");
  ASSERT_EQ(tips.size(), 2u);
  EXPECT_EQ(tips[0].at("name"), "left");
  EXPECT_NEAR(tips[0].at("center_mm").at(2).get<double>(), -30.0, 1e-9);
  EXPECT_NEAR(tips[0].at("radius_mm").get<double>(), 1.5, 1e-9);
  EXPECT_EQ(json::parse(cell_document(edf(), std::nullopt)).at("probe").at("tips"), json::array());
}

TEST(RecipesDocument, SaysWhichFurtherTipsTouch) {
  for (const json& recipe : json::parse(recipes_document(cell_with_star())).at("recipes"))
    EXPECT_EQ(recipe.at("tips"), recipe.at("name") == "edf-25" ? json({"right", "left"}) : json::array());
}

TEST(PlaneDistances, OfAFurtherTipHaveItsNameBesideThatOfThePlace) {
  const Cell cell = cell_with_star();
  const auto count = static_cast<int>(cell.block.faces.size());
  const auto touched = [](int face) {
    return calib::FaceDistances{.face = face, .role = calib::TouchRole::kFit};
  };
  const auto planes =
      planes_of(cell, cell.recipes.at("edf-25"), {touched(1), touched(1 + count), touched(1 + 5 * count)},
                calib::TouchRole::kFit);
  ASSERT_EQ(planes.size(), 3u);
  EXPECT_FALSE(planes[0].tip);
  EXPECT_EQ(planes[1].tip, "right");
  EXPECT_FALSE(planes[1].place);
  EXPECT_EQ(planes[2].tip, "left");
  EXPECT_EQ(planes[2].place, "stand");
  EXPECT_EQ(planes[2].reference_mm, planes[0].reference_mm) << "the same face of the block";
}

TEST(PlaneDistances, OfAFurtherPlaceHaveItsName) {
  const Cell cell = cell_with_stand();
  const auto moved = static_cast<int>(cell.block.faces.size()) + 1;
  const std::vector<calib::FaceDistances> distances{{.face = 1, .role = calib::TouchRole::kFit},
                                                    {.face = moved, .role = calib::TouchRole::kFit}};
  const auto planes = planes_of(cell, cell.recipes.at("edf-25"), distances, calib::TouchRole::kFit);
  ASSERT_EQ(planes.size(), 2u);
  EXPECT_FALSE(planes[0].place);
  EXPECT_EQ(planes[1].place, "stand");
  EXPECT_EQ(planes[1].plane, moved + 1);
  EXPECT_EQ(planes[1].reference_mm, planes[0].reference_mm) << "the same face of the block";
}

TEST(PlanePlaces, AreThoseOfAllRolesAndOnlyOfFurtherPlaces) {
  ResultDocument result;
  result.planes = {{.plane = 2}, {.plane = 8, .place = "stand"}};
  result.planes_held_out = {{.plane = 9, .place = "stand"}};
  const PlanePlaces places = plane_places_of(result);
  EXPECT_EQ(places, (PlanePlaces{{8, "stand"}, {9, "stand"}}));
  EXPECT_EQ(plane_text(2, places), "2");
  EXPECT_EQ(plane_text(8, places), "8 (stand)");
}

TEST(PlanePlaces, SayWithWhichFurtherTipAPlaneIsTouched) {
  ResultDocument result;
  result.planes = {{.plane = 7, .tip = "left"}, {.plane = 20, .place = "stand", .tip = "left"}};
  const PlanePlaces places = plane_places_of(result);
  EXPECT_EQ(plane_text(7, places), "7 (tip left)");
  EXPECT_EQ(plane_text(20, places), "20 (stand, tip left)");
  EXPECT_EQ(where_in_row(std::nullopt, "left"), "  tip left");
  EXPECT_EQ(where_in_row("stand", "left"), "  at stand, tip left");
  EXPECT_EQ(where_in_row(std::nullopt, std::nullopt), "");
}

}  // namespace
}  // namespace cell
