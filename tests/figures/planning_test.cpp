// What planned touches are worth: predicted, simulated, and against touches nobody chose.
#include <gtest/gtest.h>

#include <cstdio>

#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "service/run/tip_prediction.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr int kRandomDraws = 15;
constexpr int kTruthCount = 200;
constexpr int kPostureCount = 200;
constexpr double kAgreement = 1.15;  // simulated over predicted, and the other way round

struct Predicted {
  double condition_number = 0.0;
  double in_box_m = 0.0;
  double in_joint_ranges_m = 0.0;
};

/// Of touches on a cell as it is written down.
Predicted predict(const cell::Cell& cell, const cell::Recipe& recipe, const std::vector<Touch>& touches) {
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  problem.touches = touches;
  IdentificationOptions options = recipe.identification;
  options.measure_noise = false;  // touches of the nominal arm have none
  const IdentificationResult result = identify(problem, options);
  if (result.status != IdentificationStatus::kConverged) throw std::runtime_error(result.message);
  const cell::TipRegions regions(cell);
  return {result.iterations.back().condition_number,
          cell::predicted_rms_m(regions.tip().workspace_box, *result.uncertainty).value(),
          cell::predicted_rms_m(regions.tip().joint_ranges, *result.uncertainty).value()};
}

void print(const char* what, const Predicted& figures) {
  std::printf(
      "%s: condition number %.1f, tip predicted to %.4f mm rms in the workspace box, %.4f over the joint "
      "ranges\n",
      what, figures.condition_number, mm_from_metres(figures.in_box_m),
      mm_from_metres(figures.in_joint_ranges_m));
}

/// Real arms are in real_arm_test.
const cell::Cell& demo() {
  static const cell::Cell cell = rigid_cell("demo");
  return cell;
}

const std::vector<Touch>& quick_touches() {
  static const std::vector<Touch> touches = planned_touches(demo(), demo().recipes.at("quick"));
  return touches;
}

TEST(FiguresOfPlanning, QuickIsAccurateEnoughOnTheDemonstrationCell) {
  const cell::Recipe& recipe = demo().recipes.at("quick");
  ASSERT_EQ(quick_touches().size(), 40u);
  const Predicted figures = predict(demo(), recipe, quick_touches());
  print("quick, demo", figures);
  EXPECT_LE(figures.in_box_m, 0.08e-3);
  EXPECT_LE(figures.in_joint_ranges_m, 0.16e-3);
}

TEST(FiguresOfPlanning, BestIsAccurateEnoughOnTheDemonstrationCell) {
  const cell::Recipe& recipe = demo().recipes.at("best");
  const std::vector<Touch> touches = planned_touches(demo(), recipe);
  ASSERT_EQ(touches.size(), 100u);
  const Predicted figures = predict(demo(), recipe, touches);
  print("best, demo", figures);
  EXPECT_LE(figures.in_box_m, 0.05e-3);
  EXPECT_LE(figures.in_joint_ranges_m, 0.11e-3);
  EXPECT_LT(figures.condition_number, 60.0);
}

TEST(FiguresOfPlanning, TwentyFiveAFaceOnThePapersCellHaveASmallConditionNumber) {
  const cell::Cell cell = rigid_cell("edf");
  const cell::Recipe& recipe = cell.recipes.at("edf-25");
  const std::vector<Touch> touches = planned_touches(cell, recipe);
  ASSERT_EQ(touches.size(), 100u);
  const Predicted figures = predict(cell, recipe, touches);
  print("edf-25, edf", figures);
  EXPECT_LT(figures.condition_number, 130.0);
}

/// Touches that can be made, evenly drawn, as many on each face.
std::vector<Touch> random_touches(const PlanningProblem& problem, int per_face, UniformChance& chance) {
  constexpr int kAttemptsMax = 100'000;
  std::vector<Touch> touches;
  for (const TouchRequest& request : problem.requests) {
    const TouchTarget around = find_target(problem, request.face);
    int found = 0;
    for (int attempt = 0; found < per_face; ++attempt) {
      if (attempt == kAttemptsMax) throw std::logic_error("too few touches can be made on the face");
      const TouchPose pose =
          sample_touch_pose(problem, problem.faces[static_cast<std::size_t>(request.face)], chance);
      const auto postures = inverse_kinematics(problem.nominal, problem.joint_ranges, pose.block_from_tip);
      if (postures.empty()) continue;
      const auto pick = static_cast<std::size_t>(chance() * static_cast<double>(postures.size()));
      if (!std::holds_alternative<PlannedTouch>(make_touch(problem, around, pose, postures[pick]))) continue;
      touches.push_back({.face = request.face, .joints = postures[pick]});
      ++found;
    }
  }
  return touches;
}

TEST(FiguresOfPlanning, QuickHasHalfTheTipErrorOfAsManyRandomTouches) {
  const cell::Recipe& recipe = demo().recipes.at("quick");
  const PlanningProblem problem = cell::planning_problem(demo(), recipe);
  const auto per_face = static_cast<int>(quick_touches().size() / problem.requests.size());
  UniformChance chance(23);
  std::vector<double> in_box_m, in_joint_ranges_m;
  for (int draw = 0; draw < kRandomDraws; ++draw) {
    const Predicted random = predict(demo(), recipe, random_touches(problem, per_face, chance));
    in_box_m.push_back(random.in_box_m);
    in_joint_ranges_m.push_back(random.in_joint_ranges_m);
  }
  const Predicted quick = predict(demo(), recipe, quick_touches());
  const double box_part = quick.in_box_m / median(in_box_m);
  const double ranges_part = quick.in_joint_ranges_m / median(in_joint_ranges_m);
  std::printf(
      "40 random touches, median of %d draws: tip %.4f mm rms in the box, %.4f over the joint ranges; quick "
      "has %.2f and %.2f of it\n",
      kRandomDraws, mm_from_metres(median(in_box_m)), mm_from_metres(median(in_joint_ranges_m)), box_part,
      ranges_part);
  EXPECT_LE(box_part, 0.5);
  EXPECT_LE(ranges_part, 0.5);
}

/// An arm drawn from the tolerances that misses no touch by more than the cell allows for.
KinematicModel draw_arm(const cell::Cell& cell, const ErrorTolerances& tolerances,
                        const std::vector<Touch>& touches, UniformChance& chance) {
  constexpr int kAttemptsMax = 1000;
  const std::vector<ContactSurface> planes = make_artefact(cell::artefact_knowledge(cell)).contact_planes;
  for (int attempt = 0; attempt < kAttemptsMax; ++attempt) {
    const KinematicModel arm = apply(cell.arm.model, draw_errors(tolerances, chance));
    if (signed_distances_m(arm, planes, touches).lpNorm<Eigen::Infinity>() <= cell.nominal_position_error_m)
      return arm;
  }
  throw std::logic_error("the tolerances hardly ever give an arm as good as the cell says");
}

/// Calibrations by the touches of `quick`, arm and artefact drawn anew each time: the tip's mean square error
/// over some postures.
class SimulatedError {
 public:
  explicit SimulatedError(std::vector<JointVector> postures) : postures_(std::move(postures)) {}

  void add(const KinematicModel& calibrated, const KinematicModel& truth) {
    errors_m_.push_back(tip_error_rms_m(calibrated, truth, postures_));
  }
  void compare(const char* where, double predicted_m) const {
    const double simulated_m = root_mean_square(errors_m_);
    std::printf("quick, %zu simulated calibrations: tip %.4f mm rms %s, predicted %.4f (%+.1f %%)\n",
                errors_m_.size(), mm_from_metres(simulated_m), where, mm_from_metres(predicted_m),
                100.0 * (simulated_m / predicted_m - 1.0));
    EXPECT_LE(simulated_m / predicted_m, kAgreement) << where;
    EXPECT_GE(simulated_m / predicted_m, 1.0 / kAgreement) << where;
  }

 private:
  std::vector<JointVector> postures_;
  std::vector<double> errors_m_;
};

TEST(FiguresOfPlanning, WhatIsPredictedOfQuickIsWhatSimulatedRunsGive) {
  const cell::Recipe& recipe = demo().recipes.at("quick");
  const JointRanges& ranges = demo().arm.joint_ranges;
  const Predicted predicted = predict(demo(), recipe, quick_touches());
  SimulatedError in_box(
      postures_in_box(demo().arm.model, ranges, demo().workspace_box, std::nullopt, kPostureCount));
  SimulatedError in_ranges(postures_in(ranges, kPostureCount));
  const ArtefactKnowledge known = cell::artefact_knowledge(demo());
  IdentificationProblem problem = cell::identification_problem(demo(), recipe);
  UniformChance chance(29);
  for (int draw = 0; draw < kTruthCount; ++draw) {
    const KinematicModel truth = draw_arm(demo(), problem.tolerances, quick_touches(), chance);
    const DrawnArtefact drawn = draw_artefact(known, chance);
    problem.artefact = make_artefact(drawn.known);
    problem.touches = captured({truth, make_artefact(drawn.truth).contact_planes}, quick_touches(),
                               demo().touch_noise_m, chance);
    const IdentificationResult result = identify(problem, recipe.identification);
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    in_box.add(result.calibrated, truth);
    in_ranges.add(result.calibrated, truth);
  }
  in_box.compare("in the workspace box", predicted.in_box_m);
  in_ranges.compare("over the joint ranges", predicted.in_joint_ranges_m);
}

}  // namespace
}  // namespace calib::figures
