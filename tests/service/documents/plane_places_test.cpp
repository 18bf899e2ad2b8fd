// What documents say of a block that stands at several places in a run.
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

}  // namespace
}  // namespace cell
