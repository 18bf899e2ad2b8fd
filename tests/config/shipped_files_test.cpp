#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "calib_core/geometry/units.hpp"
#include "config/read_config.hpp"
#include "config/touches_file.hpp"
#include "config/true_tips.hpp"
#include "config/truth.hpp"
#include "folder.hpp"

namespace cell {
namespace {

using calib::metres_from_mm;

Cell shipped(const std::string& name) { return read_cell(kSourceDir / "config/cells" / name / "cell.json"); }

Truth truth_of(const std::string& name) {
  return read_truth(kSourceDir / "config/cells" / name / "truth.json");
}

class EveryShippedCell : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Cells, EveryShippedCell, testing::Values("edf", "demo"),
                         [](const auto& instance) { return instance.param; });

TEST_P(EveryShippedCell, IsReadWithItsRecipes) {
  const Cell cell = shipped(GetParam());
  EXPECT_EQ(cell.name, GetParam());
  EXPECT_EQ(cell.arm.name, "tx90");
  EXPECT_TRUE(cell.recipes.contains("edf-25"));
  EXPECT_TRUE(cell.recipes.contains("edf-37"));
  EXPECT_TRUE(cell.recipes.contains("edf-23"));
  EXPECT_EQ(cell.controller.port, 11000);
  EXPECT_NEAR(cell.touch_noise_m, 20e-6, 1e-12);
  EXPECT_EQ(cell.collision_scene().obstacles.size(), 3U);
  EXPECT_EQ(cell.collision_scene().bodies.size(), cell.arm.bodies.size() + cell.probe.bodies.size());
}

// The poses come from an independent model: tests/data/reference_poses.csv.
TEST_P(EveryShippedCell, PlacesItsArmWhereTheReferencePosesAre) {
  const Cell cell = shipped(GetParam());
  const calib::KinematicModel table3 = calib::apply(cell.arm.model, truth_of("edf").errors);
  std::ifstream file(kSourceDir / "tests/data/reference_poses.csv");
  int count = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#') || line.starts_with("model")) continue;
    std::istringstream cells(line);
    std::string model;
    std::getline(cells, model, ',');
    std::array<double, 9> numbers{};
    for (double& number : numbers) {
      std::string text;
      std::getline(cells, text, ',');
      number = std::stod(text);
    }
    calib::JointVector joints;
    for (int i = 0; i < calib::kJointCount; ++i) {
      joints[i] = calib::radians_from_degrees(numbers[static_cast<std::size_t>(i)]);
    }
    const Eigen::Vector3d reference_m = Eigen::Vector3d(numbers[6], numbers[7], numbers[8]) * 1e-3;
    const Eigen::Vector3d tip_m =
        calib::forward_kinematics(model == "nominal" ? cell.arm.model : table3, joints).translation();
    EXPECT_LT((tip_m - reference_m).norm(), calib::kPositionErrorMaxMetres) << line;
    ++count;
  }
  EXPECT_EQ(count, 40);
}

TEST_P(EveryShippedCell, HidesATruthThatMissesByLessThanItDeclares) {
  const Cell cell = shipped(GetParam());
  const calib::KinematicModel truth = calib::apply(cell.arm.model, truth_of(GetParam()).errors);
  const auto touches = read_touches(kSourceDir / "tests/data/table3-exact.touches.json", cell).touches;
  ASSERT_EQ(touches.size(), 100U);
  double worst_m = 0.0;
  for (const calib::Touch& touch : touches) {
    const Eigen::Vector3d miss_m = calib::forward_kinematics(truth, touch.joints).translation() -
                                   calib::forward_kinematics(cell.arm.model, touch.joints).translation();
    const auto& outward = cell.block.faces[static_cast<std::size_t>(touch.face)].plane.outward;
    worst_m = std::max(worst_m, std::abs(outward.dot(miss_m)));
  }
  EXPECT_LT(worst_m, cell.nominal_position_error_m);
  EXPECT_GT(worst_m, metres_from_mm(3.0));  // a real arm: place errors of several mm
}

TEST(EdfCell, HasThePapersPlanesAndNoBall) {
  const Cell cell = shipped("edf");
  ASSERT_EQ(cell.block.faces.size(), 4U);
  const std::array<double, 4> offsets_mm{75.0, 75.0, 150.0, 75.0};
  const std::array<Eigen::Vector3d, 4> outward{-Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitX(),
                                               -Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  for (std::size_t i = 0; i < offsets_mm.size(); ++i) {
    EXPECT_EQ(cell.block.faces[i].plane.offset_m, metres_from_mm(offsets_mm[i]));
    EXPECT_EQ(cell.block.faces[i].plane.outward, outward[i]);
  }
  EXPECT_TRUE(cell.probe.tip_is_contact_point);
  EXPECT_EQ(cell.probe.stylus.radius_m, 0.0);
  EXPECT_EQ(cell.arm.model.links[7].theta_rad, -0.256);
  EXPECT_NEAR(cell.stylus_tilt_max_rad, calib::radians_from_degrees(45.0), 1e-12);
}

TEST(EdfCell, TouchesOfTheTable3ArmLieOnItsFaces) {
  const Cell cell = shipped("edf");
  const calib::KinematicModel truth = calib::apply(cell.arm.model, truth_of("edf").errors);
  const TouchesFile file = read_touches(kSourceDir / "tests/data/table3-exact.touches.json", cell);
  EXPECT_THAT(file.warnings, testing::IsEmpty());
  constexpr double kWrittenDigitsMetres = 1e-9;  // the file gives joints to 1e-9 degree
  for (const calib::Touch& touch : file.touches) {
    const Eigen::Vector3d tip_m = calib::forward_kinematics(truth, touch.joints).translation();
    const calib::Face& face = cell.block.faces[static_cast<std::size_t>(touch.face)];
    EXPECT_NEAR(signed_distance_m(contact_plane(face, cell.probe.stylus), tip_m), 0.0, kWrittenDigitsMetres);
  }
}

TEST(EdfCell, TruthIsTable3) {
  const Truth truth = truth_of("edf");
  EXPECT_EQ((truth.errors.array() != 0.0).count(), 23);
  EXPECT_EQ(truth.errors[*calib::error_parameter_index("theta0")], 0.005);
  EXPECT_EQ(truth.errors[*calib::error_parameter_index("r0")], metres_from_mm(-8.3836));
  EXPECT_EQ(truth.errors[*calib::error_parameter_index("r7")], metres_from_mm(3.751));
}

TEST(DemoCell, TouchesThePlateAsAFifthFaceWithABall) {
  const Cell cell = shipped("demo");
  ASSERT_EQ(cell.block.faces.size(), 5U);
  EXPECT_EQ(cell.block.faces[4].plane.offset_m, 0.0);
  EXPECT_EQ(cell.probe.stylus.radius_m, metres_from_mm(3.0));
  ASSERT_EQ(cell.block.lengths.size(), 2U);
  EXPECT_EQ(cell.block.lengths[0].faces, (std::array{2, 4}));
  const calib::Face& plate = cell.block.faces[4];
  EXPECT_GT(plate.center_m.x() - plate.half_extent_m.x(),
            cell.block.solids[0].max_m.x());  // beside the block
}

TEST(StarCell, IsTheDemoCellWithFourMoreTipsOfWhichItsRecipeTouchesWithTwo) {
  const Cell cell = shipped("star"), demo = shipped("demo");
  EXPECT_EQ(cell.default_recipe, "star");
  const Recipe& recipe = cell.recipes.at("star");
  const Recipe& best = demo.recipes.at("best");
  ASSERT_EQ(recipe.tips.size(), 2U);
  EXPECT_EQ(cell.probe.tips[static_cast<std::size_t>(recipe.tips[0])].name, "left");
  EXPECT_EQ(cell.probe.tips[static_cast<std::size_t>(recipe.tips[1])].name, "back");
  EXPECT_EQ(recipe.faces, best.faces);
  EXPECT_EQ(recipe.goal.fit_count, best.goal.fit_count);
  EXPECT_EQ(recipe.reference_every, best.reference_every);
  EXPECT_EQ(cell.arm.model.links[7].r_m, demo.arm.model.links[7].r_m);
  EXPECT_EQ(cell.probe.stylus.radius_m, demo.probe.stylus.radius_m);
  EXPECT_TRUE(demo.probe.tips.empty());
}

TEST(StarCell, HasItsTipsFarFromEachOtherAndHidesWhereTheyAre) {
  const Cell cell = shipped("star");
  ASSERT_EQ(cell.probe.tips.size(), 4U);
  const Truth truth = truth_of("star");
  EXPECT_EQ(truth.errors, truth_of("demo").errors);
  const std::vector<ProbeTip> tips = true_tips(truth, cell.probe);
  for (std::size_t i = 0; i < tips.size(); ++i) {
    const ProbeTip& drawn = cell.probe.tips[i];
    EXPECT_NEAR(drawn.center_m.head<2>().norm(), metres_from_mm(30.0), 1e-12) << drawn.name;
    EXPECT_NEAR(drawn.direction.dot(drawn.center_m), metres_from_mm(30.0), 1e-12) << drawn.name;
    const double off_m = (tips[i].center_m - drawn.center_m).norm();
    EXPECT_GT(off_m, metres_from_mm(0.3)) << drawn.name;
    EXPECT_LT(off_m, metres_from_mm(0.4)) << drawn.name;
    EXPECT_LT(off_m, drawn.within_m) << drawn.name;
    EXPECT_LT(std::abs(tips[i].radius_m - drawn.radius_m), drawn.std_radius_m) << drawn.name;
    EXPECT_NE(tips[i].radius_m, drawn.radius_m) << drawn.name;
  }
}

class DemoTruth : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Both, DemoTruth, testing::Values("truth.json", "truth-real.json"));

TEST_P(DemoTruth, IsARealArmWithAllErrors) {
  const Truth truth = read_truth(kSourceDir / "config/cells/demo" / GetParam());
  for (std::size_t i = 0; i < calib::kErrorParameterCount; ++i) {
    const calib::ErrorParameter& parameter = calib::error_parameters()[i];
    const double error = std::abs(truth.errors[static_cast<Eigen::Index>(i)]);
    EXPECT_GT(error, 0.0) << parameter.name();
    const bool is_place = parameter.group() == calib::ParameterGroup::kBlockPose;
    const double error_max = !parameter.is_length() ? 0.005 : metres_from_mm(is_place ? 6.0 : 0.3);
    EXPECT_LE(error, error_max) << parameter.name();
  }
}

TEST(Recipes, CountTouchesAndOrderColumnsAsThePaper) {
  const Cell cell = shipped("edf");
  const std::map<std::string, int> fit_counts{{"edf-25", 25}, {"edf-37", 37}, {"edf-23", 25}};
  std::vector<int> tried_last;
  for (const char* name : {"r2", "alpha6", "d6", "theta6", "r6", "theta7"}) {
    tried_last.push_back(*calib::error_parameter_index(name));
  }
  for (const auto& [name, fit_count] : fit_counts) {
    const Recipe& recipe = cell.recipes.at(name);
    EXPECT_EQ(recipe.faces, (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(recipe.fit_per_face, fit_count);
    EXPECT_EQ(recipe.held_out_per_face, 10);
    EXPECT_EQ(recipe.identification.identifiability.tried_last, tried_last);
  }
  EXPECT_THAT(
      cell.recipes.at("edf-23").identification.identifiability.excluded,
      testing::ElementsAre(calib::error_parameter_index("alpha4"), calib::error_parameter_index("alpha5")));
}

TEST(Recipes, SpreadTheirTouchesOverAllPlanesOfTheCell) {
  for (const auto& [cell_name, faces] : {std::pair("edf", 4), std::pair("demo", 5)}) {
    const Cell cell = shipped(cell_name);
    for (const auto& [name, fit_count] : {std::pair("quick", 40), std::pair("best", 100)}) {
      const Recipe& recipe = cell.recipes.at(name);
      EXPECT_EQ(std::ssize(recipe.faces), faces);
      EXPECT_EQ(recipe.fit_per_face, 0);
      EXPECT_EQ(recipe.goal.fit_count, fit_count);
      EXPECT_EQ(recipe.goal.criterion, calib::PlanCriterion::kTipInBox);
      EXPECT_EQ(recipe.held_out_per_face, 10);
    }
  }
}

}  // namespace
}  // namespace cell
