// A block that is touched at two places, with a certified step between them or with none: how good is the
// arm, and how well is its scale known? A hundred seeds each of an arm that bends, warms up and has gears.
#include <gtest/gtest.h>

#include <cstdio>

#include "calib_core/geometry/units.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "config/identification_problem.hpp"
#include "config/touched_places.hpp"
#include "tests/figures/hidden_cell.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr int kTipPostureCount = 200;
/// What a certified step is to bring. The scale is wanted to 33 ppm.
constexpr double kBoxMaxMetres = 26e-6, kRangesMaxMetres = 52e-6, kScaleMax = 38e-6;

struct Figures {
  std::vector<double> box_m, ranges_m, predicted_box_m, predicted_ranges_m, scale;

  void report(const char* what) const {
    std::printf(
        "places, %s, %zu seeds: tip over the box %.3f mm (predicted %.3f), over the joint ranges %.3f mm "
        "(predicted %.3f), scale known to %.0f ppm\n",
        what, box_m.size(), mm_from_metres(median(box_m)), mm_from_metres(median(predicted_box_m)),
        mm_from_metres(median(ranges_m)), mm_from_metres(median(predicted_ranges_m)), 1e6 * median(scale));
  }
};

/// What a recipe makes of truth-real, with the true steps drawn around the block's file.
Figures calibrate(const cell::Cell& cell, const cell::Recipe& recipe) {
  const std::vector<Touch> planned = all_planned_touches(cell, recipe);
  const HiddenArm arm = shipped_arm(cell, "truth");
  const std::vector<JointVector> in_box = postures_in_box(cell.arm.model, cell.arm.joint_ranges,
                                                          cell.workspace_box, std::nullopt, kTipPostureCount);
  const std::vector<JointVector> in_ranges = postures_in(cell.arm.joint_ranges, kTipPostureCount);
  const TipRegion box = region_over_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box);
  const TipRegion ranges = region_over_joint_ranges(cell.arm.model, cell.arm.joint_ranges);
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  Figures figures;
  for (int seed = 1; seed <= kSeedCount; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    HiddenCell hidden(cell, arm, chance);
    hidden.stand_at_places(cell, recipe, chance);
    make_run(hidden, planned, recipe, problem);
    const IdentificationResult result = identify(problem, recipe.identification);
    if (result.status != IdentificationStatus::kConverged) {
      ADD_FAILURE() << "seed " << seed << ": " << result.message;
      continue;
    }
    figures.box_m.push_back(
        tip_error_rms_m(result.calibrated, in_box, hidden.tips_m(in_box, hidden.mean_rise_k())));
    figures.ranges_m.push_back(
        tip_error_rms_m(result.calibrated, in_ranges, hidden.tips_m(in_ranges, hidden.mean_rise_k())));
    const ArmMatrix covariance = result.uncertainty->covariance();
    figures.predicted_box_m.push_back(box.rms_m(covariance).value());
    figures.predicted_ranges_m.push_back(ranges.rms_m(covariance).value());
    figures.scale.push_back(result.scale->std_relative);
  }
  return figures;
}

class PlacesFigures : public ::testing::Test {
 protected:
  cell::Cell cell_ = shipped_cell("stand");
  const cell::Recipe& two_places_ = cell_.recipes.at("two-places");
};

TEST_F(PlacesFigures, ACertifiedStepIsTheRuler) {
  const Figures one = calibrate(cell_, cell_.recipes.at("best"));
  one.report("100 touches at one place");
  const Figures two = calibrate(cell_, two_places_);
  two.report("100 touches at two places, step known to 10 um and 30 urad");
  EXPECT_LE(median(two.box_m), kBoxMaxMetres);
  EXPECT_LE(median(two.ranges_m), kRangesMaxMetres);
  EXPECT_LE(median(two.scale), kScaleMax);
}

TEST_F(PlacesFigures, AStepThatTheTouchesFindDoesNoHarm) {
  cell::BlockPlace& stand = cell_.block.places.at(0);
  stand.std.reset();
  stand.within_m = 0.003;
  calibrate(cell_, two_places_).report("100 touches at two places, step found by the touches");
}

}  // namespace
}  // namespace calib::figures
