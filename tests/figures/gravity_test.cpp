// An arm whose joints 2 and 3 droop by up to 0.3 mrad, calibrated from 100 touches planned for the demo
// cell's block: a rigid model has to notice, one with two compliances has to be right.
#include "calib_core/kinematics/gravity.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr double kDroopRad = 0.3e-3;
constexpr int kTouchCount = 100;
constexpr int kPostureCount = 500;
constexpr double kNoticedP = 0.001;
constexpr int kSeedsWrongMax = 1;
/// Where touches hardly show a compliance it is held, and a part of the droop stays in the residuals.
constexpr int kSeedsWrongOnPlanMax = 2;
constexpr double kTipErrorMedianMaxMetres = 0.25e-3;

/// The arm with both joints just as soft that their largest droop over the touches is kDroopRad.
KinematicModel drooping(KinematicModel arm, const std::vector<Touch>& touches) {
  for (const int joint : {1, 2}) {
    double torque_max_nm = 0.0;
    for (const Touch& touch : touches) {
      const Chain chain = forward_chain(arm, touch.joints);
      torque_max_nm = std::max(torque_max_nm, std::abs(gravity_torques_nm(arm, chain)[joint]));
    }
    arm.compliance_rad_per_nm[static_cast<std::size_t>(joint)] = kDroopRad / torque_max_nm;
  }
  return arm;
}

struct Tally {
  int noticed_rigid = 0, noticed_compliant = 0;
  std::vector<double> rigid_m, compliant_m, predicted_m;  // tip over the joint ranges

  void report(const char* name) const {
    std::printf(
        "gravity, %.1f mrad, %s, %d seeds: lack of fit in %d (rigid) and %d (compliant); tip error over "
        "the joint ranges, median: rigid %.3f mm, compliant %.3f mm (predicted %.3f)\n",
        1e3 * kDroopRad, name, kSeedCount, noticed_rigid, noticed_compliant, mm_from_metres(median(rigid_m)),
        mm_from_metres(median(compliant_m)), mm_from_metres(median(predicted_m)));
  }
};

/// `touches` gives the nominal arm's for a seed's chance.
template <class Touches>
Tally calibrate(const cell::Cell& cell, const Touches& touches) {
  const cell::Recipe& recipe = cell.recipes.at("edf-25");
  const std::vector<JointVector> postures = postures_in(cell.arm.joint_ranges, kPostureCount);
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  IdentificationOptions compliant = recipe.identification;
  compliant.stiffness = true;
  Tally tally;
  for (int seed = 1; seed <= kSeedCount; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    const std::vector<Touch> aimed = touches(chance);
    const DrawnArtefact drawn = draw_artefact(cell::artefact_knowledge(cell), chance);
    const KinematicModel rigid_truth = apply(cell.arm.model, draw_errors(cell.arm.std_errors, chance));
    const Truth truth{drooping(rigid_truth, aimed), make_artefact(drawn.truth).contact_planes};
    problem.artefact = make_artefact(drawn.known);
    problem.touches = captured(truth, aimed, cell.touch_noise_m, chance);
    const IdentificationResult rigid = identify(problem, recipe.identification);
    const IdentificationResult soft = identify(problem, compliant);
    if (rigid.lack_of_fit.value().p < kNoticedP) ++tally.noticed_rigid;
    if (soft.lack_of_fit.value().p < kNoticedP) ++tally.noticed_compliant;
    tally.rigid_m.push_back(tip_error_rms_m(rigid.calibrated, truth.arm, postures));
    tally.compliant_m.push_back(tip_error_rms_m(soft.calibrated, truth.arm, postures));
    tally.predicted_m.push_back(
        region_over_postures(soft.calibrated, postures).rms_m(soft.uncertainty->covariance()).value());
  }
  return tally;
}

TEST(Gravity, IsNoticedByARigidModelAndTakenUpByACompliantOne) {
  const cell::Cell cell = shipped_cell("demo");
  for (const int face_count : {4, 5}) {
    const Tally tally = calibrate(cell, [&](UniformChance& chance) {
      return even_touches(cell, face_count, kTouchCount / face_count, chance);
    });
    EXPECT_GE(tally.noticed_rigid, kSeedCount - kSeedsWrongMax);
    EXPECT_LE(tally.noticed_compliant, kSeedsWrongMax);
    EXPECT_LE(median(tally.compliant_m), kTipErrorMedianMaxMetres);
    tally.report(face_count == 4 ? "even touches on 4 faces" : "even touches on 5 faces");
  }
}

// The planner keeps to postures of a few kinds, in which kinematic errors do what the droop does: most often
// there is nothing to notice.
TEST(Gravity, IsTakenUpByACompliantModelWhereItHidesInPlannedTouches) {
  const cell::Cell cell = shipped_cell("demo");
  const std::vector<Touch> planned = planned_touches(cell, cell.recipes.at("edf-25"));
  ASSERT_EQ(planned.size(), static_cast<std::size_t>(kTouchCount));
  const Tally tally = calibrate(cell, [&](UniformChance&) { return planned; });
  EXPECT_LE(tally.noticed_compliant, kSeedsWrongOnPlanMax);
  EXPECT_LE(median(tally.compliant_m), kTipErrorMedianMaxMetres);
  EXPECT_GT(median(tally.rigid_m), median(tally.compliant_m));
  tally.report("the plan's touches");
}

}  // namespace
}  // namespace calib::figures
