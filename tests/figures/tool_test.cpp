// How well a tool is known from its drawing, and from eight touches with its own tip.
#include <gtest/gtest.h>

#include <cstdio>

#include "calib_core/geometry/units.hpp"
#include "calib_core/proof/detection_planning.hpp"
#include "calib_core/proof/tool_centre.hpp"
#include "config/identification_problem.hpp"
#include "config/mounted_tool.hpp"
#include "service/run/verification.hpp"
#include "tests/figures/hidden_cell.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr int kToolSeeds = 100;
constexpr const char* kTool = "gripper";
constexpr int kBoxPostureCount = 200;

/// The calibration of a seed's cell; nothing when it did not converge.
std::optional<CalibrationRecord> calibrated(const cell::Cell& cell, const cell::Recipe& recipe,
                                            const std::vector<Touch>& planned, HiddenCell& hidden) {
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  make_run(hidden, planned, recipe, problem);
  const IdentificationResult result = identify(problem, recipe.identification);
  if (result.status != IdentificationStatus::kConverged || !result.uncertainty) return std::nullopt;
  return CalibrationRecord(problem, recipe.identification, result);
}

std::vector<Touch> planned_for(const cell::Cell& mounted, const cell::Recipe& recipe,
                               const CalibrationRecord& record, const ToolTip& tip) {
  PlanningProblem problem =
      cell::planning_problem(mounted, cell::verification_recipe(mounted, recipe, cell::RunKind::kTool));
  problem.candidate_count = kDetectionCandidates;
  const auto plan = plan_tool(problem, record, tip);
  if (const auto* failure = std::get_if<PlanningFailure>(&plan))
    throw std::runtime_error("no plan: " + failure->reason);
  std::vector<Touch> touches;
  for (const PlannedTouch& planned : std::get<TouchPlan>(plan).touches)
    touches.push_back({.face = planned.face, .joints = planned.joints, .role = planned.role});
  return touches;
}

double off_m(const KinematicModel& arm, const Eigen::Vector3d& centre_m,
             const std::vector<JointVector>& postures, const std::vector<Eigen::Vector3d>& true_m) {
  const PreparedModel model = prepare(arm);
  double squares = 0.0;
  for (std::size_t i = 0; i < postures.size(); ++i)
    squares += (forward_chain(model, postures[i]).block_from_frame[kJointCount] * centre_m - true_m[i])
                   .squaredNorm();
  return std::sqrt(squares / static_cast<double>(postures.size()));
}

/// Wanted (use-and-plant.md, section 1): 0.067 mm where the drawing leaves 0.24.
TEST(ToolFigures, ATouchedToolIsKnownBetterThanADrawnOne) {
  const cell::Cell cell = shipped_cell("demo");
  const cell::Recipe& recipe = cell.recipes.at("best");
  const std::vector<Touch> planned = all_planned_touches(cell, recipe);
  const cell::Cell mounted = cell::with_tool_mounted(cell, kTool);
  const HiddenArm arm = shipped_arm(cell, "truth-real");
  HiddenArm with_tool = arm;
  with_tool.truth = cell::with_tip_mounted(arm.truth, cell.tool_tips.at(kTool));
  const ToolTip tip = cell::tip_of(cell, kTool, 0.0);
  const std::vector<JointVector> postures = postures_in_box(
      mounted.arm.model, mounted.arm.joint_ranges, cell.workspace_box, std::nullopt, kBoxPostureCount);
  std::vector<Touch> touches;
  std::vector<double> drawn_m, touched_m, promised_m;
  int passed = 0;
  for (int seed = 1; seed <= kToolSeeds; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed)), same(static_cast<std::uint64_t>(seed));
    HiddenCell hidden(cell, arm, chance);
    HiddenCell behind(mounted, with_tool, same);
    const auto record = calibrated(cell, recipe, planned, hidden);
    ASSERT_TRUE(record) << seed;
    if (touches.empty()) touches = planned_for(mounted, recipe, *record, tip);
    const auto outcome = find_tool_centre(*record, tip, behind.touch(touches), postures);
    ASSERT_TRUE(std::holds_alternative<ToolVerdict>(outcome)) << std::get<ToolRefusal>(outcome).message;
    const auto& verdict = std::get<ToolVerdict>(outcome);
    const auto true_m = behind.tips_m(postures, hidden.mean_rise_k());
    drawn_m.push_back(off_m(record->calibrated(), tip.drawn_m, postures, true_m));
    touched_m.push_back(
        off_m(apply(record->calibrated(), verdict.arm_errors), verdict.centre_m, postures, true_m));
    promised_m.push_back(verdict.rms_over_postures_m.value());
    passed += verdict.passed ? 1 : 0;
  }
  std::printf(
      "tool, %d seeds, best, truth-real: its tip over the box %.3f mm by the drawing, %.3f mm by %d touches "
      "(promised %.3f); %d passed\n",
      kToolSeeds, mm_from_metres(median(drawn_m)), mm_from_metres(median(touched_m)), kToolTouchCount,
      mm_from_metres(median(promised_m)), passed);
  EXPECT_LT(median(touched_m), 0.5 * median(drawn_m));
  EXPECT_LT(median(touched_m), 1.25 * median(promised_m));
  EXPECT_GT(passed, 9 * kToolSeeds / 10);
}

}  // namespace
}  // namespace calib::figures
