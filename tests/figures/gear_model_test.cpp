// What the choice of the gears' model costs and brings: how often even gears are taken for eccentric ones,
// and what ripple at the maker's periods makes of the tip.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "calib_core/geometry/units.hpp"
#include "calib_core/identification/face_distances.hpp"
#include "calib_core/identification/model_selection.hpp"
#include "tests/figures/hidden_cell.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

/// An arm with even gears and all else as the cell's files say, one drawn from them.
Truth even_arm(const cell::Cell& cell, const ArtefactKnowledge& truth_of_artefact, UniformChance& chance) {
  Truth truth{apply(cell.arm.model, draw_errors(cell::prior_tolerances(cell), chance)),
              make_artefact(truth_of_artefact).contact_planes};
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    truth.arm.compliance_rad_per_nm[index] =
        cell.arm.nongeometric_std[static_cast<std::size_t>(compliance_position(joint))].value_or(0.0) *
        study::normal(chance);
  }
  return truth;
}

struct Level {
  int draws = 0, by_fitted = 0, by_held_out = 0, taken = 0;
  double of_fitted_p_under_10 = 0.0;
  double optimism =
      0.0;  // decrease of the held-out mean square where only the held-out touches asked, a share

  void add(const NestedTest& fitted, const HeldOutTest& held_out) {
    ++draws;
    const bool fitted_ask = fitted.p < kLargerModelP, held_out_ask = held_out.p < kLargerModelP;
    by_fitted += fitted_ask;
    by_held_out += held_out_ask;
    taken += fitted_ask || held_out_ask;
    of_fitted_p_under_10 += fitted.p < 0.1;
    if (held_out_ask && !fitted_ask)
      optimism += 1.0 - std::pow(held_out.larger_rms_m / held_out.smaller_rms_m, 2);
  }
};

/// The touches of `best` and what both tests say of the harmonics of even gears.
TEST(GearModel, EvenGearsAreTakenForEccentricOnesAsOftenAsTheLevelSays) {
  constexpr int kDraws = 1000;
  const cell::Cell cell = shipped_cell("demo");
  const cell::Recipe& recipe = cell.recipes.at("best");
  const std::vector<Touch> planned = all_planned_touches(cell, recipe);
  const ArtefactKnowledge known = cell::artefact_knowledge(cell);
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  problem.gear_std_rad.setZero();
  problem.gear_lag_std_rad.setZero();
  IdentificationOptions without = recipe.identification, with = recipe.identification;
  without.robust = with.robust = false;
  without.harmonics = Harmonics::kLeaveOut;
  with.harmonics = Harmonics::kEstimate;
  without.measure_noise = with.measure_noise = false;
  Level level;
  int taken = 0;
  for (int seed = 1; seed <= kDraws; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    const DrawnArtefact artefact = draw_artefact(known, chance);
    problem.artefact = make_artefact(artefact.known);
    const Truth truth = even_arm(cell, artefact.truth, chance);
    problem.touches = captured(truth, planned, problem.touch_noise_m, chance);
    const IdentificationResult smaller = identify(problem, without), larger = identify(problem, with);
    if (smaller.status != IdentificationStatus::kConverged) continue;
    const auto fitted = test_nested(smaller.residual_sum, larger.residual_sum);
    const auto held_out = test_held_out(problem, smaller, larger);
    ASSERT_TRUE(fitted && held_out) << seed;
    level.add(*fitted, *held_out);
    const IdentificationResult chosen = identify(problem, recipe.identification);
    taken += std::ranges::any_of(chosen.nongeometric, is_harmonic);
  }
  const double percent = 100.0 / level.draws;
  std::printf(
      "even gears, best, %d draws: harmonics kept in %.1f %% (by identify(); F-test of the fitted touches "
      "%.1f %%, under p 0.1 %.1f %%, held-out touches %.1f %%, either %.1f %%); held-out mean square too "
      "small by %.3f %% in the mean by that choice\n",
      level.draws, percent * taken, percent * level.by_fitted, percent * level.of_fitted_p_under_10,
      percent * level.by_held_out, percent * level.taken, percent * level.optimism);
  EXPECT_GE(level.draws, kDraws * 95 / 100);
  EXPECT_LE(percent * level.by_fitted, 2.0);
  EXPECT_LE(percent * level.by_held_out, 2.0);
  EXPECT_LE(percent * taken, 3.0);
  EXPECT_LE(level.optimism / level.draws, 0.005);
}

/// The shipped truth-real, or with eccentric gears.
HiddenArm hidden_arm(const cell::Cell& cell, bool is_eccentric) {
  HiddenArm arm = shipped_arm(cell, "truth-real");
  if (!is_eccentric) return arm;
  arm.name = "eccentric gears";
  constexpr double kEccentricityRad = 50e-6;
  auto& harmonics = arm.truth.harmonics_rad.emplace();
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const double phase_rad = 1.0 + 0.9 * static_cast<double>(joint);
    harmonics[joint] = {kEccentricityRad * std::cos(phase_rad), kEccentricityRad * std::sin(phase_rad)};
  }
  return arm;
}

/// The cell with the periods of the arm's gears in the arm's file.
cell::Cell with_periods(cell::Cell cell, const cell::Truth& truth, double share_of_period) {
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    cell.arm.model.ripple_periods_per_turn[index] = share_of_period * truth.ripple[index].periods_per_turn;
    const auto cosine = static_cast<std::size_t>(ripple_position(joint));
    cell.arm.nongeometric_std[cosine] = cell.arm.nongeometric_std[cosine + 1] =
        cell.arm.gears.ripple_rad[joint] / std::sqrt(2.0);
  }
  return cell;
}

struct TipErrors {
  std::vector<double> box_m, ranges_m, box_ratio, held_out_um;
  int taken = 0, harmonics_taken = 0;

  void report(const char* arm, const char* model) const {
    std::printf(
        "%s, best, %zu seeds, %s: tip over the box %.3f mm (%.2f of the predicted), over the joint ranges "
        "%.3f mm, held-out rms %.1f um, ripple taken in %d, harmonics in %d\n",
        arm, box_m.size(), model, mm_from_metres(median(box_m)), median(box_ratio),
        mm_from_metres(median(ranges_m)), median(held_out_um), taken, harmonics_taken);
  }
};

TipErrors errors_of(const cell::Cell& cell, const cell::Recipe& recipe, const std::vector<Touch>& planned,
                    const HiddenArm& arm) {
  constexpr int kPostureCount = 200, kSeeds = 100;
  const std::vector<JointVector> in_box =
      postures_in_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box, std::nullopt, kPostureCount);
  const std::vector<JointVector> in_ranges = postures_in(cell.arm.joint_ranges, kPostureCount);
  const TipPostures box = derive_at_postures(cell.arm.model, in_box);
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  TipErrors errors;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    HiddenCell hidden(cell, arm, chance);
    make_run(hidden, planned, recipe, problem);
    const IdentificationResult result = identify(problem, recipe.identification);
    if (result.status != IdentificationStatus::kConverged) {
      ADD_FAILURE() << "seed " << seed << ": " << result.message;
      continue;
    }
    const double box_m =
        tip_error_rms_m(result.calibrated, in_box, hidden.tips_m(in_box, hidden.mean_rise_k()));
    errors.box_m.push_back(box_m);
    errors.box_ratio.push_back(box_m / box.region().rms_m(result.uncertainty->covariance()).value());
    errors.ranges_m.push_back(
        tip_error_rms_m(result.calibrated, in_ranges, hidden.tips_m(in_ranges, hidden.mean_rise_k())));
    double squares = 0.0;
    int count = 0;
    for (const FaceDistances& face : result.distances) {
      if (face.role != TouchRole::kHeldOut) continue;
      squares += face.touch_count * std::pow(face.calibrated_rms_m, 2);
      count += face.touch_count;
    }
    errors.held_out_um.push_back(1e6 * std::sqrt(squares / count));
    errors.taken += std::ranges::any_of(result.nongeometric, is_ripple);
    errors.harmonics_taken += std::ranges::any_of(result.nongeometric, is_harmonic);
  }
  return errors;
}

/// Ripple tried with periods that are right, and with periods a tenth too large, which no touch follows.
TEST(GearModel, RippleAtTheMakersPeriodsMakesTheTipBetterAndAtWrongOnesIsLeftOut) {
  const cell::Cell shipped = shipped_cell("demo");
  const cell::Recipe& recipe = shipped.recipes.at("best");
  const std::vector<Touch> planned = all_planned_touches(shipped, recipe);
  for (const bool is_eccentric : {false, true}) {
    const HiddenArm arm = hidden_arm(shipped, is_eccentric);
    const TipErrors without = errors_of(shipped, recipe, planned, arm);
    const TipErrors with = errors_of(with_periods(shipped, arm.truth, 1.0), recipe, planned, arm);
    const TipErrors wrong = errors_of(with_periods(shipped, arm.truth, 1.1), recipe, planned, arm);
    without.report(arm.name.c_str(), "no periods");
    with.report(arm.name.c_str(), "the maker's periods");
    wrong.report(arm.name.c_str(), "periods a tenth too large");
    EXPECT_EQ(without.taken, 0);
    EXPECT_LE(median(with.box_m), median(without.box_m));
    EXPECT_LE(median(with.held_out_um), median(without.held_out_um));
  }
}

}  // namespace
}  // namespace calib::figures
