// What touches say of a ruler that is wrong by less than the scale guard sees: a ball wrong by 50 um, a block
// of which a temperature wrong by 20 K was given. Arms within the maker's tolerances, the plans of the cell
// `demo`, a hundred seeds each.
#include <gtest/gtest.h>

#include <cstdio>

#include "calib_core/geometry/units.hpp"
#include "calib_core/observability/observation_matrix.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr double kBallWrongMetres = 50e-6;
constexpr double kBlockWrongKelvins = 20.0;

struct WrongRuler {
  const char* name;
  void (*happen)(ArtefactKnowledge& truth);
};

const WrongRuler kBall{"ball wrong by 50 um",
                       [](ArtefactKnowledge& truth) { truth.stylus.radius_m += kBallWrongMetres; }};
const WrongRuler kBlock{"block given 20 K wrong",
                        [](ArtefactKnowledge& truth) { truth.warmer_than_20_c_k += kBlockWrongKelvins; }};

struct Power {
  int alarms = 0;
  double significance = 0.0, contradicted = 0.0;  // medians, standard deviations
  double over_promise = 0.0;  // median of the tip's error over the predicted, in the workspace box
};

Power power_of(const WrongRuler& wrong, const std::string& recipe_name, double noise_m) {
  const cell::Cell cell = rigid_cell("demo");
  const cell::Recipe& recipe = cell.recipes.at(recipe_name);
  const std::vector<Touch> planned = planned_touches(cell, recipe);
  const std::vector<JointVector> box =
      postures_in_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box, {}, 100);
  const TipRegion region = region_over_postures(cell.arm.model, box);
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  Power power;
  std::vector<double> significances, contradictions, ratios;
  for (int seed = 1; seed <= kSeedCount; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    DrawnArtefact drawn = draw_artefact(cell::artefact_knowledge(cell), chance);
    wrong.happen(drawn.truth);
    const Truth truth{apply(cell.arm.model, draw_errors(cell.arm.std_errors, chance)),
                      make_artefact(drawn.truth).contact_planes};
    problem.artefact = make_artefact(drawn.known);
    problem.touches = captured(truth, planned, noise_m, chance);
    const IdentificationResult result = identify(problem, recipe.identification);
    EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    if (result.status != IdentificationStatus::kConverged) continue;
    power.alarms += result.scale->warning.empty() ? 0 : 1;
    significances.push_back(result.scale->significance.value_or(0.0));
    contradictions.push_back(result.scale->contradicted.value_or(0.0));
    ratios.push_back(tip_error_rms_m(result.calibrated, truth.arm, box) /
                     region.rms_m(result.uncertainty->covariance()).value());
  }
  power.significance = median(significances);
  power.contradicted = median(contradictions);
  power.over_promise = median(ratios);
  std::printf(
      "ruler, %s, %s, touches of %.0f um: %d alarms in %d seeds; scale %.1f, artefact %.1f standard "
      "deviations; "
      "tip in the box %.2f of the promise (medians)\n",
      wrong.name, recipe_name.c_str(), noise_m / kMicrometres, power.alarms, kSeedCount, power.significance,
      power.contradicted, power.over_promise);
  return power;
}

// The figure is better where touches are better, as the measured noise counts and not the declared one.
TEST(RulerPower, AgainstABallWrongByHalfATenthGrowsWithTheMeasuredNoise) {
  for (const char* recipe : {"quick", "best"}) {
    const Power declared = power_of(kBall, recipe, 20e-6);
    const Power better = power_of(kBall, recipe, 5e-6);
    EXPECT_GT(better.contradicted, declared.contradicted) << recipe;
    EXPECT_GE(better.alarms, declared.alarms) << recipe;
  }
}

// An arm whose lengths are all larger by a share touches a block that is larger by it at the same joints: no
// touch can tell, whatever its noise. Only the maker's tolerances speak, and what the temperature's deviation
// says must cover it.
TEST(RulerPower, AgainstAWrongTemperatureIsThatOfTheMakersTolerances) {
  const cell::Cell cell = rigid_cell("demo");
  constexpr double kShare = 2.36e-5 * kBlockWrongKelvins;
  KinematicModel larger = cell.arm.model;
  for (LinkParameters& link : larger.links) {
    link.d_m *= 1.0 + kShare;
    link.r_m *= 1.0 + kShare;
  }
  std::vector<ContactSurface> planes = make_artefact(cell::artefact_knowledge(cell)).contact_planes;
  const std::vector<Touch> touches =
      moved_onto_planes(cell.arm.model, planes, planned_touches(cell, cell.recipes.at("quick")));
  for (ContactSurface& plane : planes) plane.offset_m *= 1.0 + kShare;  // the ball too: 1.4 um
  EXPECT_LT(signed_distances_m(larger, planes, touches).cwiseAbs().maxCoeff(), 1e-12);
  const Power coarse = power_of(kBlock, "best", 20e-6);
  const Power fine = power_of(kBlock, "best", 5e-6);
  EXPECT_LT(coarse.alarms, kSeedCount / 4);
  EXPECT_LT(fine.alarms, kSeedCount / 4) << "better touches do not help";
}

}  // namespace
}  // namespace calib::figures
