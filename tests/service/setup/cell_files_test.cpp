#include "service/setup/cell_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/estimation/block_registration.hpp"
#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "service/setup/park_posture.hpp"
#include "tests/service/setup/made_cell.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Cell& demo_cell() {
  static const Cell cell = read_cell(kSourceDir / "config/cells/demo/cell.json");
  return cell;
}

TEST(CellFiles, OfTheDefaultsAreTheShippedDemo) {
  const Cell made = made_cell({});
  const Cell& demo = demo_cell();
  ASSERT_EQ(made.block.faces.size(), demo.block.faces.size());
  for (std::size_t i = 0; i < made.block.faces.size(); ++i) {
    const calib::Face &ours = made.block.faces[i], &theirs = demo.block.faces[i];
    EXPECT_LT((ours.plane.outward - theirs.plane.outward).norm(), 1e-12) << i;
    EXPECT_NEAR(ours.plane.offset_m, theirs.plane.offset_m, 1e-12) << i;
    EXPECT_LT((ours.center_m - theirs.center_m).norm(), 1e-12) << i;
    EXPECT_LT((ours.half_extent_m - theirs.half_extent_m).norm(), 1e-12) << i;
  }
  EXPECT_EQ(made.block.lengths.size(), demo.block.lengths.size());
  ASSERT_EQ(made.probe.bodies.size(), demo.probe.bodies.size());
  for (std::size_t i = 0; i < made.probe.bodies.size(); ++i)
    EXPECT_LT((made.probe.bodies[i].from_m - demo.probe.bodies[i].from_m).norm(), 1e-12) << i;
  EXPECT_LT((made.park_joints - demo.park_joints).norm(), 1e-9);
  EXPECT_LT((calib::forward_kinematics(made.arm.model, made.park_joints).matrix() -
             calib::forward_kinematics(demo.arm.model, demo.park_joints).matrix())
                .norm(),
            1e-12);
}

TEST(CellFiles, PutTheArmWhereItsBaseIsAndGravityDown) {
  SetupAnswers answers;
  answers.base = BasePlace{{-700.0, -300.0, 50.0}, {90.0, 0.0, 20.0}};
  const Cell made = made_cell(answers);
  const Eigen::Isometry3d pose = calib::block_pose_of(made.arm.model);
  EXPECT_LT((pose.translation() - Eigen::Vector3d(-0.7, -0.3, 0.05)).norm(), 1e-12);
  EXPECT_LT((pose.linear().col(2) - Eigen::Vector3d(0.0, -1.0, 0.0)).norm(), 1e-12) << "it stands upright";
  EXPECT_LT((made.arm.model.down_in_frame_1 - Eigen::Vector3d(0.0, 0.0, -1.0)).norm(), 1e-12);
  answers.base->rotation_deg = {-90.0, 0.0, 0.0};
  EXPECT_LT((made_cell(answers).arm.model.down_in_frame_1 - Eigen::Vector3d(0.0, 0.0, 1.0)).norm(), 1e-12)
      << "it hangs from the ceiling";
}

TEST(CellFiles, AreReadForEveryShippedArmAndManyBlocks) {
  for (const char* arm : {"tx90", "tx60", "three-parallel"}) {
    SetupAnswers answers;
    answers.arm.file = arm;
    answers.block.size_mm = {200.0, 100.0, 120.0};
    answers.block.sides = {{"-z", "a"}, {"-x", "b"}, {"-y", "c"}, {"+z", "d"}, {"+x", "e"}};
    answers.block.ground_plate = false;
    answers.block.temperature_c = std::nullopt;
    answers.probe.overtravel_mm = 1.0;
    answers.probe.speed_mm_s = 1.0;
    answers.tools = {{"gripper", {0.0, 0.0, 250.0}, {0.0, 0.0, 0.0}}};
    const Cell made = made_cell(answers);
    EXPECT_EQ(made.block.lengths.size(), 2U) << arm;
    EXPECT_EQ(made.tools.count("gripper"), 1U) << arm;
    EXPECT_FALSE(made.block.temperature_c) << arm;
  }
}

TEST(CellFiles, HaveTipsOfToolsAndFurtherPlacesWithARecipeOfTheirOwn) {
  SetupAnswers answers;
  answers.tools = {{"gripper", {0.0, 0.0, 250.0}, {0.0, 0.0, 0.0}, ToolTipAnswers{.radius_mm = 4.0}}};
  answers.block.places = {{.name = "stand", .position_mm = {-300.0, -300.0, 200.0}}};
  const Cell made = made_cell(answers);
  EXPECT_EQ(made.tool_tips.at("gripper").radius_m, 0.004);
  EXPECT_EQ(made.block.places.at(0).name, "stand");
  ASSERT_TRUE(made.recipes.contains("places"));
  EXPECT_EQ(made.recipes.at("places").places, std::vector<int>{0});
}

TEST(CellFiles, TouchThePlateOnTheSideAwayFromTheArm) {
  SetupAnswers answers;
  answers.base = BasePlace{{100.0, -120.0, 700.0}, {90.0, 0.0, 90.0}};
  EXPECT_LT(made_cell(answers).block.faces.back().center_m.z(), -0.08);
}

TEST(CellFiles, ThatTheReaderRefusesNameTheirFile) {
  SetupAnswers answers;
  answers.park_joints_deg = std::vector<double>{0.0, 0.0, 170.0, 0.0, 0.0, 0.0};
  try {
    made_cell(answers);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.source(), "cell.json");
    EXPECT_EQ(error.pointer(), "/park_joints_deg");
  }
}

TEST(SceneRemarks, TellOfAParkPostureInTheWayAndABlockOutOfReach) {
  SetupAnswers answers;
  EXPECT_THAT(scene_remarks(setup_scene(answers, arm_to_set_up("tx90"))), IsEmpty());
  answers.keep_out_boxes.push_back({"press", {-700.0, -900.0, 0.0}, {-400.0, -100.0, 400.0}});
  answers.base = BasePlace{{-625.0, -120.0, 149.0}, {90.0, 0.0, 0.0}};
  const auto in_the_way = scene_remarks(setup_scene(answers, arm_to_set_up("tx90")));
  ASSERT_FALSE(in_the_way.empty());
  EXPECT_THAT(in_the_way.front(), HasSubstr("press"));
  answers.keep_out_boxes.clear();
  answers.base = BasePlace{{-3000.0, -120.0, 0.0}, {90.0, 0.0, 0.0}};
  const auto out_of_reach = scene_remarks(setup_scene(answers, arm_to_set_up("tx90")));
  ASSERT_FALSE(out_of_reach.empty());
  EXPECT_THAT(out_of_reach.front(), HasSubstr("plane 1 is 3001 mm from the base"));
}

TEST(ParkPostureOfACell, ThatClashesIsRefusedWithBothBodiesAndTheRemedy) {
  SetupAnswers answers;
  answers.park_joints_deg = std::vector<double>{0.0, 60.0, 90.0, 0.0, 30.0, 0.0};
  const Cell scene = setup_scene(answers, arm_to_set_up("tx90"));
  const auto clash = park_clash(scene);
  ASSERT_TRUE(clash);
  const ConfigError error = error_of([&] { demand_clear_park(answers, scene); });
  EXPECT_EQ(error.pointer(), "/park_joints_deg");
  EXPECT_THAT(error.message(),
              AllOf(HasSubstr(clash->body), HasSubstr(clash->other), HasSubstr("give another")));
  demand_clear_park({}, setup_scene({}, arm_to_set_up("tx90")));
}

TEST(ParkPostureOfACell, ThatNothingIsClearInIsRefusedWithWhatIsInTheWay) {
  SetupAnswers answers;
  answers.base = BasePlace{{-600.0, -150.0, 0.0}, {90.0, 0.0, 0.0}};
  answers.keep_out_boxes = {{"oven", {-3000.0, -3000.0, -3000.0}, {3000.0, 3000.0, 3000.0}}};
  const Cell scene = setup_scene(answers, arm_to_set_up("tx90"));
  const ConfigError error = error_of([&] { demand_clear_park(answers, scene); });
  EXPECT_THAT(error.message(), AllOf(HasSubstr("too near oven in 100 %"), HasSubstr("holder_radius_mm")));
}

}  // namespace
}  // namespace cell
