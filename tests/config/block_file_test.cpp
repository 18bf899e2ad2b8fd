#include "config/block_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "config/truth.hpp"
#include "tests/config/cell_with_ball.hpp"

/// Blocks with a sphere among their faces; what else a block's file has is in read_config_test.
namespace cell {
namespace {

using nlohmann::json;
using testing::EndsWith;
using testing::HasSubstr;

class BlockWithBall : public testing::Test {
 protected:
  [[nodiscard]] Block read(const json& block) const {
    return read_block(folder_.write("block.json", block.dump()));
  }
  Folder folder_;
};

TEST_F(BlockWithBall, HasASphereAsAFaceAndItsBallAsASolid) {
  json ball = ball_face();
  ball["place"] = "known";
  ball["std_center_mm"] = 0.4;
  const Block block = read(block_with(ball));
  ASSERT_EQ(block.faces.size(), 6u);
  EXPECT_FALSE(block.faces[4].cap);
  const calib::Face& face = block.faces[5];
  ASSERT_TRUE(face.cap);
  EXPECT_TRUE(face.cap->center_m.isApprox(Eigen::Vector3d(0.14, -0.18, 0.11)));
  EXPECT_DOUBLE_EQ(face.cap->half_angle_rad, calib::radians_from_degrees(100.0));
  EXPECT_NEAR(surface_of(face).radius_m(), 0.025, 1e-15);
  EXPECT_TRUE(face.center_m.isApprox(Eigen::Vector3d(0.14, -0.205, 0.11)));
  const calib::FaceUncertainty& known = block.face_uncertainties[5];
  EXPECT_DOUBLE_EQ(known.std_center_m, 0.4e-3);
  EXPECT_DOUBLE_EQ(known.std_offset_m, 1e-6);
  EXPECT_FALSE(known.estimated);
  ASSERT_EQ(block.solids.size(), 4u);
  EXPECT_EQ(block.solids[2].name, "post");
  EXPECT_EQ(block.solids[3].name, "ball of plane 6");
  EXPECT_EQ(block.solids[3].min_m, face.cap->center_m);
  EXPECT_EQ(block.solids[3].max_m, face.cap->center_m);
  EXPECT_NEAR(block.solids[3].round_m, 0.025, 1e-15);
  EXPECT_TRUE(read(block_with(ball_face())).face_uncertainties[5].estimated);
}

TEST_F(BlockWithBall, MayCallAFlatAPlane) {
  json block = block_with(ball_face());
  block["faces"][0]["shape"] = "plane";
  EXPECT_FALSE(read(block).faces[0].cap);
}

/// `value` put at `at` must be refused at `pointer` with `said`.
struct SpoiledBall {
  const char* at;
  json value;
  const char* pointer;
  const char* said;
};

void PrintTo(const SpoiledBall& spoiled, std::ostream* stream) { *stream << spoiled.at << spoiled.value; }

class SpoiledBlock : public BlockWithBall, public testing::WithParamInterface<SpoiledBall> {};

TEST_P(SpoiledBlock, IsRefusedWithFilePointerAndRemedy) {
  json block = block_with(ball_face());
  block[json::json_pointer(GetParam().at)] = GetParam().value;
  const ConfigError error = error_of([&] { static_cast<void>(read(block)); });
  EXPECT_THAT(error.source(), EndsWith("block.json"));
  EXPECT_EQ(error.pointer(), GetParam().pointer);
  EXPECT_THAT(error.message(), HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    Sphere, SpoiledBlock,
    testing::Values(
        SpoiledBall{"/schema", "touchcal/block/1", "/faces/5/shape", "raise \"schema\" to 2"},
        SpoiledBall{"/faces/5/shape", "cone", "/faces/5/shape", "can be touched"},
        SpoiledBall{"/faces/5/shape", "plane", "/faces/5/cap_axis", "unknown key"},
        SpoiledBall{"/faces/0/shape", "sphere", "/faces/0/edge_u", "unknown key"},
        SpoiledBall{"/faces/5/radius_mm", 0, "/faces/5/radius_mm", "a number over 0"},
        SpoiledBall{"/faces/5/std_radius_mm", -1, "/faces/5/std_radius_mm", "at least 0"},
        SpoiledBall{"/faces/5/std_center_mm", 3, "/faces/5/std_center_mm", "give 0 to 1"},
        SpoiledBall{"/faces/5/center_mm", json({1, 2}), "/faces/5/center_mm", "wants 3 numbers"},
        SpoiledBall{"/faces/5/cap_axis", json({0, -1, 0.1}), "/faces/5/cap_axis", "give a unit vector"},
        SpoiledBall{"/faces/5/cap_half_angle_deg", 181, "/faces/5/cap_half_angle_deg", "180"},
        SpoiledBall{
            "/faces/5/cap_half_angle_deg", 20, "/faces/5/cap_half_angle_deg",
            "touched from one side only, a sphere whose centre is estimated cannot be told from the arm; "
            "give at least 30, or \"place\": \"known\" with std_center_mm"},
        SpoiledBall{"/faces/5/offset_mm", 5, "/faces/5/offset_mm", "unknown key"},
        SpoiledBall{"/faces/5/place", "guessed", "/faces/5/place", "\"known\" or \"estimated\""},
        SpoiledBall{"/lengths/0/planes", json({3, 6}), "/lengths/0/planes/1", "is a sphere"}));

// Plane 5 is estimated, so that no pair of faces shows it: 150.05 mm from 5 to 3, and 150 mm by way of 6.
TEST_F(BlockWithBall, WithLengthsThatDoNotCloseIsRefused) {
  json block = json_of(kSourceDir / "config/cells/demo/block.json");
  block["faces"][4]["place"] = "estimated";
  json step = block["faces"][2];
  step["plane"] = 6;
  step["offset_mm"] = 50;
  step["center_mm"] = {140, -50, 0};
  step["place"] = "estimated";
  block["faces"].push_back(step);
  const auto length = [](int a, int b, double value_mm) {
    return json{{"planes", {a, b}}, {"value_mm", value_mm}, {"std_mm", 0.005}};
  };
  block["lengths"] = {length(1, 4, 150), length(5, 6, 50), length(6, 3, 100), length(3, 5, 150.01)};
  EXPECT_EQ(read(block).lengths.size(), 4u);
  block["lengths"][3]["value_mm"] = 150.05;
  const ConfigError error = error_of([&] { static_cast<void>(read(block)); });
  EXPECT_THAT(error.pointer(), testing::MatchesRegex("/lengths/[123]/value_mm"));
  EXPECT_THAT(error.message(), HasSubstr("is 0.05 mm from what all other lengths and offsets give together"));
  EXPECT_THAT(error.message(), HasSubstr("correct it, the others or their standard deviations"));
}

TEST_F(BlockWithBall, TakesNoRecipeWithPlaneCoefficientsThatTouchesTheSphere) {
  const std::filesystem::path file = write_demo_with(block_with(ball_face()), folder_);
  json cell = json_of(file);
  json recipe = json_of(kSourceDir / "config/recipes/edf-25.json");
  recipe["identification"]["formulation"] = "plane_coefficients";
  recipe["touches"]["planes"] = json({1, 2, 3, 6});
  cell["recipes"] = {folder_.write("recipe.json", recipe.dump()).string()};
  folder_.write("cell.json", cell.dump());
  const ConfigError error = error_of([&] { static_cast<void>(read_cell(file)); });
  EXPECT_THAT(error.source(), EndsWith("recipe.json"));
  EXPECT_EQ(error.pointer(), "/identification/formulation");
  EXPECT_THAT(error.message(), HasSubstr("plane 6 of the block is a sphere"));
}

TEST_F(BlockWithBall, StandsInTheSimulatorWhereTheTruthHasIt) {
  const Block block = read(block_with(ball_face()));
  Truth truth;
  truth.face_offsets_m = {0.0, 0.0, 0.0, 0.0, 0.0, 1e-5};
  truth.sphere_shifts_m = {Eigen::Vector3d(1e-3, -2e-3, 3e-3)};
  truth.warming.block_warmer_k = 2.0;
  const calib::Box ball = true_solids(truth, block).at(3);
  const double growth = 1.0 + 2.0 * block.thermal_expansion_per_k.value();
  EXPECT_TRUE(ball.min_m.isApprox(growth * Eigen::Vector3d(0.141, -0.182, 0.113), 1e-12));
  EXPECT_EQ(ball.min_m, ball.max_m);
  EXPECT_NEAR(ball.round_m, growth * 0.02501, 1e-15);
  truth.sphere_shifts_m.emplace_back(Eigen::Vector3d::Zero());
  const ConfigError error = error_of([&] { static_cast<void>(true_solids(truth, block)); });
  EXPECT_EQ(error.pointer(), "/block/sphere_shifts_mm");
  EXPECT_THAT(error.message(), HasSubstr("the block has 1 spheres; give one a sphere"));
}

}  // namespace
}  // namespace cell
