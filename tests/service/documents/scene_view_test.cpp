#include "service/documents/scene_view.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "service/documents/cell_view.hpp"
#include "service/documents/result_view.hpp"
#include "tests/config/cell_with_bore.hpp"

namespace cell {
namespace {

using nlohmann::json;

TEST(SceneView, JointsAreUnknownUntilTheControllerToldThem) {
  const json unknown = json::parse(joints_document(std::nullopt, {.instance_id = "i"}));
  EXPECT_TRUE(unknown.at("joints_deg").is_null());
  EXPECT_TRUE(unknown.at("data_age_ms").is_null());
  cs8::State told;
  told.joints = {1'500'000, -2'000'000, 0, 4, 5, 6};
  const json known =
      json::parse(joints_document(told, {.sequence = 7, .instance_id = "i", .data_age_ms = 12}));
  EXPECT_EQ(known.at("joints_deg"), json::parse("[1.5,-2.0,0.0,4e-6,5e-6,6e-6]"));
  EXPECT_EQ(known.at("data_age_ms"), 12);
  EXPECT_EQ(known.at("sequence"), 7);
}

TEST(CellView, TellsASphereFromAPlane) {
  const Folder folder;
  const Cell cell = read_cell(write_demo_with(block_with(ball_face()), folder));
  const json document = json::parse(cell_document(cell, std::nullopt));
  const json& faces = document.at("block").at("faces");
  EXPECT_EQ(faces.at(0).at("shape"), "plane");
  EXPECT_FALSE(faces.at(0).contains("sphere"));
  EXPECT_EQ(faces.at(5).at("plane"), 6);
  EXPECT_EQ(faces.at(5).at("shape"), "sphere");
  const json& sphere = faces.at(5).at("sphere");
  EXPECT_NEAR(sphere.at("radius_mm").get<double>(), 25.0, 1e-9);
  EXPECT_NEAR(sphere.at("cap_half_angle_deg").get<double>(), 100.0, 1e-9);
  EXPECT_NEAR(sphere.at("center_mm").at(1).get<double>(), -180.0, 1e-9);
  const json& ball = document.at("scene").at("solids").at(3);  // the cube around it
  EXPECT_NEAR(ball.at("min_mm").at(0).get<double>(), 115.0, 1e-9);
  EXPECT_NEAR(ball.at("max_mm").at(1).get<double>(), -155.0, 1e-9);
}

TEST(CellView, TellsABoreAndTheHoleOfItsSolid) {
  const Folder folder;
  const Cell cell = read_cell(write_demo_with(block_with_ring(bore_of_ring()), folder));
  const json document = json::parse(cell_document(cell, std::nullopt));
  const json& face = document.at("block").at("faces").at(5);
  EXPECT_EQ(face.at("shape"), "bore");
  const json& bore = face.at("bore");
  EXPECT_NEAR(bore.at("mouth_mm").at(1).get<double>(), -60.0, 1e-9);
  EXPECT_EQ(bore.at("axis"), json({0.0, -1.0, 0.0}));
  EXPECT_NEAR(bore.at("radius_mm").get<double>(), 42.0, 1e-9);
  EXPECT_NEAR(bore.at("depth_mm").at(0).get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(bore.at("depth_mm").at(1).get<double>(), 42.0, 1e-9);
  EXPECT_NEAR(bore.at("wall_half_angle_deg").get<double>(), 180.0, 1e-9);
  const json& solids = document.at("scene").at("solids");
  EXPECT_TRUE(solids.at(0).at("holes").empty());
  const json& hole = solids.at(2).at("holes").at(0);
  EXPECT_NEAR(hole.at("center_mm").at(0).get<double>(), 140.0, 1e-9);
  EXPECT_EQ(hole.at("axis"), json({0.0, -1.0, 0.0}));
  EXPECT_NEAR(hole.at("radius_mm").get<double>(), 42.0, 1e-9);
}

TEST(ResultView, CountsDistancesFromABoreFromItsAxisAlongItsNormal) {
  const Folder folder;
  const Cell cell = read_cell(write_demo_with(block_with_ring(bore_of_ring()), folder));
  const std::vector<calib::FaceDistances> distances{
      {.face = 5, .touch_count = 3, .nominal_mean_m = 1e-3, .calibrated_mean_m = 2e-6}};
  const PlaneDistances bore = planes_of(cell, {}, distances, calib::TouchRole::kFit).at(0);
  EXPECT_NEAR(bore.reference_mm.value(), -42.0, 1e-9);
  EXPECT_NEAR(bore.nominal_mean_mm.value(), -41.0, 1e-9);
  EXPECT_NEAR(bore.calibrated_mean_mm.value(), -41.998, 1e-9);
}

TEST(ResultView, CountsDistancesFromASphereFromItsCentre) {
  const Folder folder;
  const Cell cell = read_cell(write_demo_with(block_with(ball_face()), folder));
  const std::vector<calib::FaceDistances> distances{
      {.face = 5, .touch_count = 3, .nominal_mean_m = 1e-3, .calibrated_mean_m = 2e-6}};
  const PlaneDistances ball = planes_of(cell, {}, distances, calib::TouchRole::kFit).at(0);
  EXPECT_EQ(ball.plane, 6);
  EXPECT_NEAR(ball.reference_mm.value(), 25.0, 1e-9);
  EXPECT_NEAR(ball.nominal_mean_mm.value(), 26.0, 1e-9);
  EXPECT_NEAR(ball.calibrated_mean_mm.value(), 25.002, 1e-9);
}

}  // namespace
}  // namespace cell
