#include "config/bore_face.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "calib_core/geometry/units.hpp"
#include "config/block_file.hpp"
#include "config/truth.hpp"
#include "tests/config/cell_with_bore.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::EndsWith;
using testing::HasSubstr;

class BlockWithBore : public testing::Test {
 protected:
  [[nodiscard]] Block read(const json& block) const {
    return read_block(folder_.write("block.json", block.dump()));
  }
  Folder folder_;
};

TEST_F(BlockWithBore, HasTheWallAsAFaceAndAHoleInItsSolid) {
  json bore = bore_of_ring();
  bore["place"] = "known";
  bore["std_axis_mm"] = 0.3;
  bore["wall_half_angle_deg"] = 60;
  const Block block = read(block_with_ring(bore));
  ASSERT_EQ(block.faces.size(), 6u);
  EXPECT_TRUE(block.faces[4].is_flat());
  const calib::Face& face = block.faces[5];
  ASSERT_TRUE(face.bore);
  EXPECT_TRUE(face.bore->center_m.isApprox(Eigen::Vector3d(0.14, -0.038, 0.11)));
  EXPECT_EQ(face.bore->axis, Eigen::Vector3d(0, -1, 0));
  EXPECT_DOUBLE_EQ(face.bore->mouth_m, 0.022);
  EXPECT_DOUBLE_EQ(face.bore->half_angle_rad, calib::radians_from_degrees(60.0));
  EXPECT_DOUBLE_EQ(face.half_extent_m.x(), 0.020);
  EXPECT_DOUBLE_EQ(surface_of(face).radius_m(), 0.042);
  EXPECT_EQ(face.plane.outward, Eigen::Vector3d(-1, 0, 0));
  const calib::FaceUncertainty& known = block.face_uncertainties[5];
  EXPECT_DOUBLE_EQ(known.std_center_m, 0.3e-3);
  EXPECT_DOUBLE_EQ(known.std_offset_m, 1e-6);
  EXPECT_DOUBLE_EQ(known.std_tilt_rad, 0.005);
  EXPECT_FALSE(known.estimated);
  ASSERT_EQ(block.solids.size(), 3u);
  ASSERT_EQ(block.solids[2].holes.size(), 1u);
  EXPECT_TRUE(block.solids[0].holes.empty());
  EXPECT_EQ(block.solids[2].holes[0].center_m, face.bore->center_m);
  EXPECT_DOUBLE_EQ(block.solids[2].holes[0].radius_m, 0.042);
  EXPECT_TRUE(read(block_with_ring(bore_of_ring())).face_uncertainties[5].estimated);
}

/// `value` put at `at` (null: taken away) must be refused at `pointer` with `said`.
struct SpoiledBore {
  const char* at;
  json value;
  const char* pointer;
  const char* said;
};

void PrintTo(const SpoiledBore& spoiled, std::ostream* stream) { *stream << spoiled.at << spoiled.value; }

class SpoiledBoreBlock : public BlockWithBore, public testing::WithParamInterface<SpoiledBore> {};

TEST_P(SpoiledBoreBlock, IsRefusedWithFilePointerAndRemedy) {
  json block = block_with_ring(bore_of_ring());
  const json::json_pointer at(GetParam().at);
  if (GetParam().value.is_null()) {
    block[at.parent_pointer()].erase(at.back());
  } else {
    block[at] = GetParam().value;
  }
  const ConfigError error = error_of([&] { static_cast<void>(read(block)); });
  EXPECT_THAT(error.source(), EndsWith("block.json"));
  EXPECT_EQ(error.pointer(), GetParam().pointer);
  EXPECT_THAT(error.message(), HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    Bore, SpoiledBoreBlock,
    testing::Values(
        SpoiledBore{"/schema", "touchcal/block/1", "/faces/5/shape", "raise \"schema\" to 2"},
        SpoiledBore{"/faces/5/shape", "cone", "/faces/5/shape", "\"plane\", \"sphere\" and \"bore\""},
        SpoiledBore{"/faces/5/edge_u", json({1, 0, 0}), "/faces/5/edge_u", "unknown key"},
        SpoiledBore{"/faces/5/solid", nullptr, "/faces/5", "solid"},
        SpoiledBore{"/faces/5/mouth_mm", nullptr, "/faces/5", "mouth_mm"},
        SpoiledBore{"/faces/5/axis", nullptr, "/faces/5", "axis"},
        SpoiledBore{"/faces/5/radius_mm", nullptr, "/faces/5", "radius_mm"},
        SpoiledBore{"/faces/5/depth_mm", nullptr, "/faces/5", "depth_mm"},
        SpoiledBore{"/faces/5/wall_middle", nullptr, "/faces/5", "wall_middle"},
        SpoiledBore{"/faces/5/wall_half_angle_deg", nullptr, "/faces/5", "wall_half_angle_deg"},
        SpoiledBore{"/faces/5/place", nullptr, "/faces/5", "place"},
        SpoiledBore{"/faces/5/std_tilt_rad", nullptr, "/faces/5", "give \"std_tilt_rad\" over 0"},
        SpoiledBore{"/faces/5/std_tilt_rad", 0.1, "/faces/5/std_tilt_rad", "give 0 to 0.02"},
        SpoiledBore{"/faces/5/std_axis_mm", 3, "/faces/5/std_axis_mm", "give 0 to 1"},
        SpoiledBore{"/faces/5/radius_mm", 0, "/faces/5/radius_mm", "a number over 0"},
        SpoiledBore{"/faces/5/radius_mm", 51, "/faces/5/radius_mm", "out of the solid \"ring\""},
        SpoiledBore{"/faces/5/depth_mm", json({2, 61}), "/faces/5/depth_mm", "out of the solid \"ring\""},
        SpoiledBore{"/faces/5/depth_mm", json({20, 20}), "/faces/5/depth_mm", "is no range of depths"},
        SpoiledBore{"/faces/5/depth_mm", json({-1, 20}), "/faces/5/depth_mm", "at least 0"},
        SpoiledBore{"/faces/5/axis", json({0, -1, 0.1}), "/faces/5/axis", "give a unit vector"},
        SpoiledBore{"/faces/5/axis", json({0, 1, 0}), "/faces/5/mouth_mm", "that axis points out of"},
        SpoiledBore{"/faces/5/mouth_mm", json({140, -50, 110}), "/faces/5/mouth_mm", "is not on the side"},
        SpoiledBore{"/faces/5/wall_middle", json({0.6, -0.8, 0}), "/faces/5/wall_middle",
                    "is not perpendicular to axis"},
        SpoiledBore{"/faces/5/wall_half_angle_deg", 181, "/faces/5/wall_half_angle_deg", "180"},
        SpoiledBore{"/faces/5/wall_half_angle_deg", 20, "/faces/5/wall_half_angle_deg",
                    "give at least 30, or \"place\": \"known\" with std_axis_mm"},
        SpoiledBore{"/faces/5/solid", "rings", "/faces/5/solid", "is no box among \"solids\""},
        SpoiledBore{"/faces/5/place", "guessed", "/faces/5/place", "\"known\" or \"estimated\""},
        SpoiledBore{"/lengths/0/planes", json({3, 6}), "/lengths/0/planes/1", "is a bore"}));

// Down through the ring the bore opens on the plate.
TEST_F(BlockWithBore, IsRefusedWhereAFaceMayBeTouchedOverTheHole) {
  json bore = bore_of_ring();
  bore["solid"] = "block";
  bore["mouth_mm"] = {0, -150, 0};
  const ConfigError error = error_of([&] { static_cast<void>(read(block_with_ring(bore))); });
  EXPECT_EQ(error.pointer(), "/faces/5/mouth_mm");
  EXPECT_THAT(error.message(), HasSubstr("opens in what may be touched of plane 3"));
  json block = block_with_ring(bore);
  block["faces"][2]["center_mm"] = {0, -150, -60};
  block["faces"][2]["half_extent_mm"] = {75, 15};
  EXPECT_EQ(read(block).solids[0].holes.size(), 1u);
}

TEST_F(BlockWithBore, StandsInTheSimulatorWhereTheTruthHasIt) {
  const Block block = read(block_with_ring(bore_of_ring()));
  Truth truth;
  truth.face_offsets_m = {0.0, 0.0, 0.0, 0.0, 0.0, 1e-5};  // more material
  truth.bore_shifts_m = {Eigen::Vector3d(1e-3, 0, 3e-3)};
  truth.bore_turns_rad = {Eigen::Vector3d(0.01, 0, 0)};
  truth.warming.block_warmer_k = 2.0;
  const calib::Hole hole = true_solids(truth, block).at(2).holes.at(0);
  const double growth = 1.0 + 2.0 * block.thermal_expansion_per_k.value();
  EXPECT_TRUE(hole.center_m.isApprox(growth * Eigen::Vector3d(0.141, -0.038, 0.113), 1e-12));
  EXPECT_NEAR(hole.radius_m, growth * 0.04199, 1e-15);
  EXPECT_TRUE(hole.axis.isApprox(Eigen::Vector3d(0, -std::cos(0.01), -std::sin(0.01)), 1e-12));
  truth.bore_turns_rad.emplace_back(Eigen::Vector3d::Zero());
  const ConfigError error = error_of([&] { static_cast<void>(true_solids(truth, block)); });
  EXPECT_EQ(error.pointer(), "/block/bore_turns_rad");
  EXPECT_THAT(error.message(), HasSubstr("the block has 1 bores; give one a bore"));
}

TEST_F(BlockWithBore, IsReadFromATruthFile) {
  const json file{{"schema", "touchcal/truth/2"},
                  {"name", "ring"},
                  {"errors", json::object()},
                  {"block",
                   {{"offsets_mm", {0, 0, 0, 0, 0, 0}},
                    {"bore_shifts_mm", {{1, 0, -2}}},
                    {"bore_turns_rad", {{0.001, 0, 0}}}}}};
  const Truth truth = read_truth(folder_.write("truth.json", file.dump()));
  ASSERT_EQ(truth.bore_shifts_m.size(), 1u);
  EXPECT_TRUE(truth.bore_shifts_m[0].isApprox(Eigen::Vector3d(1e-3, 0, -2e-3)));
  EXPECT_EQ(truth.bore_turns_rad.at(0).x(), 0.001);
  json spoiled = file;
  spoiled["block"]["bore_turns_rad"][0][1] = 0.2;
  const ConfigError error =
      error_of([&] { static_cast<void>(read_truth(folder_.write("truth.json", spoiled.dump()))); });
  EXPECT_EQ(error.pointer(), "/block/bore_turns_rad/0");
}

TEST_F(BlockWithBore, TakesNoRecipeWithPlaneCoefficientsThatTouchesIt) {
  const std::filesystem::path file = write_demo_with(block_with_ring(bore_of_ring()), folder_);
  json cell = json_of(file);
  json recipe = json_of(kSourceDir / "config/recipes/edf-25.json");
  recipe["identification"]["formulation"] = "plane_coefficients";
  recipe["touches"]["planes"] = json({1, 2, 3, 6});
  cell["recipes"] = {folder_.write("recipe.json", recipe.dump()).string()};
  folder_.write("cell.json", cell.dump());
  const ConfigError error = error_of([&] { static_cast<void>(read_cell(file)); });
  EXPECT_EQ(error.pointer(), "/identification/formulation");
  EXPECT_THAT(error.message(), HasSubstr("plane 6 of the block is a bore"));
}

}  // namespace
}  // namespace cell
