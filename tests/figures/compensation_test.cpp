// What correcting targets brings on the arms that the shipped cell hides: the figures of
// calib_core/README.md.
#include "calib_core/compensation/compensation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr int kBoxTargets = 1'000;
constexpr std::size_t kFlangeFrame = 6;
/// Of use-and-plant: 1.77 mm in the median without a correction.
constexpr double kUncorrectedMedianMm = 1.8, kUncorrectedWithinMm = 0.2;
constexpr double kCorrectedMaxUm = 0.1;

/// Where the tool of an arm is, in its own world: the place of the whole arm does not count.
Eigen::Vector3d tool_in_world_m(const KinematicModel& arm, const JointVector& joints,
                                const Eigen::Isometry3d& frame6_from_tool) {
  const Eigen::Isometry3d block_from_world = frame_transform(arm.links[0]) * frame_transform(arm.links[1]);
  return block_from_world.inverse() *
         (forward_chain(arm, joints).block_from_frame[kFlangeFrame] * frame6_from_tool.translation());
}

struct BoxFigures {
  std::vector<double> uncorrected_mm, corrected_um;
  int refused = 0, warned = 0;
};

/// Of the demonstration's gripper in its workspace box, when the true errors are known.
BoxFigures correct_in_box(const std::string& truth_name) {
  const std::filesystem::path folder = std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/demo";
  const cell::Cell cell = cell::read_cell(folder / "cell.json");
  const KinematicModel truth = cell::true_model(cell::read_truth(folder / truth_name), cell.arm);
  const Eigen::Isometry3d& gripper = cell.tools.at("gripper");
  const Compensation compensation(
      {.nominal = cell.arm.model, .calibrated = truth, .joint_ranges = cell.arm.joint_ranges});
  BoxFigures figures;
  for (const JointVector& joints :
       postures_in_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box, gripper, kBoxTargets)) {
    const Eigen::Vector3d wanted_m = tool_in_world_m(cell.arm.model, joints, gripper);
    figures.uncorrected_mm.push_back(
        mm_from_metres((tool_in_world_m(truth, joints, gripper) - wanted_m).norm()));
    const CompensatedTarget target = compensation.at_joints(drawn_tool(gripper), joints);
    figures.warned += target.status == CompensationStatus::kWarned ? 1 : 0;
    if (target.status == CompensationStatus::kRefused) {
      ++figures.refused;
      continue;
    }
    figures.corrected_um.push_back(
        um_from_metres((tool_in_world_m(truth, *target.joints, gripper) - wanted_m).norm()));
  }
  std::printf(
      "%-15s %zu targets: uncorrected %.2f mm median, %.2f at 95 %%; %zu corrected, at most %.5f um; "
      "%d warned, %d refused\n",
      truth_name.c_str(), figures.uncorrected_mm.size(), quantile(figures.uncorrected_mm, 0.5),
      quantile(figures.uncorrected_mm, 0.95), figures.corrected_um.size(),
      quantile(figures.corrected_um, 1.0), figures.warned, figures.refused);
  return figures;
}

TEST(CompensatedTargets, InTheBoxOfTheArmThatDroopsAreOffByTwoMillimetresBeforeAndByNothingAfter) {
  const BoxFigures figures = correct_in_box("truth-real.json");
  ASSERT_EQ(figures.uncorrected_mm.size(), static_cast<std::size_t>(kBoxTargets));
  EXPECT_NEAR(quantile(figures.uncorrected_mm, 0.5), kUncorrectedMedianMm, kUncorrectedWithinMm);
  EXPECT_LT(quantile(figures.corrected_um, 1.0), kCorrectedMaxUm);
  EXPECT_LT(figures.refused, kBoxTargets / 5);
}

TEST(CompensatedTargets, InTheBoxOfARigidArmAreExactToo) {
  const BoxFigures figures = correct_in_box("truth.json");
  EXPECT_LT(quantile(figures.corrected_um, 1.0), kCorrectedMaxUm);
  EXPECT_GT(quantile(figures.uncorrected_mm, 0.5), 0.5);
}

}  // namespace
}  // namespace calib::figures
