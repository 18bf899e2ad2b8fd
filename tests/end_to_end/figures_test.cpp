// The figures that the README promises, over many seeds: the simulator's contact function without its
// sockets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "config/identification_problem.hpp"
#include "service/run/planning_problem.hpp"
#include "service/run/run.hpp"
#include "service/run/touch_command.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/controller.hpp"
#include "sim_controller/motion.hpp"
#include "tests/end_to_end/held_out.hpp"
#include "tests/end_to_end/shipped_cell.hpp"
#include "tests/sim_controller/whole_path.hpp"

namespace touchcal::testing {
namespace {

constexpr int kSeedCount = 100;
/// The mean of ten held-out touches of declared noise scatters by 8 um (6 of them are the ten touches' own),
/// so one run in a thousand is beyond kHeldOutMeanMaxMetres on some plane by chance, and is rejected.
constexpr int kSeedsBeyondMax = 1;

constexpr int kPostureCount = 500;
/// Bound on the identified arm's tip error, anywhere in the joint ranges, after touches without noise.
constexpr double kTipErrorMaxMetres = 0.05e-3;

constexpr double kMicrometres = 1e-6;

calib::TouchPlan plan_of(const cell::Cell& cell) {
  const calib::PlanningProblem problem = cell::planning_problem(cell, cell.recipes.at(kRecipe));
  return std::get<calib::TouchPlan>(calib::plan_touches(problem));
}

class Figures : public ::testing::TestWithParam<const char*> {
 protected:
  Figures()
      : cell_(shipped_cell(GetParam())),
        plant_(sim::make_plant(cell_, shipped_truth(GetParam()))),
        plan_(plan_of(cell_)),
        problem_(cell::identification_problem(cell_, cell_.recipes.at(kRecipe))) {
    // As in a run, the touches before a touch aim it.
    const calib::PlanningProblem planning = cell::planning_problem(cell_, cell_.recipes.at(kRecipe));
    calib::OnlineArmEstimate aim(planning);
    for (const calib::PlannedTouch& planned : plan_.touches) {
      auto made = calib::aim_touch(planning, aim, planned);
      if (std::holds_alternative<std::string>(made)) made = calib::nominal_touch(planning, planned);
      const calib::PlannedTouch& touch = std::get<calib::AimedTouch>(made).touch;
      const sim::TouchMotion motion = sim::touch_motion(cell::touch_command(cell_, touch, {}));
      searches_.push_back(sim::straight_line(plant_, motion.approach, motion.search_end).path);
      const auto trip = sim::testing::find_trip(plant_, searches_.back(), 0.0);
      if (trip) aim.add({.face = planned.face, .joints = sim::posture(searches_.back(), *trip)});
    }
  }

  /// Every planned touch made by the true arm, its joints as the wire carries them.
  calib::IdentificationResult calibrate(double noise_m, std::uint64_t seed) const {
    std::mt19937_64 chance(seed);
    calib::IdentificationProblem problem = problem_;
    for (std::size_t i = 0; i < plan_.touches.size(); ++i) {
      const auto trip = sim::testing::find_trip(plant_, searches_[i], noise_m * sim::gaussian(chance));
      if (!trip) throw std::runtime_error("touch " + std::to_string(i + 1) + " met nothing");
      const auto captured = cell::to_wire(sim::posture(searches_[i], *trip));
      problem.touches.push_back({plan_.touches[i].face, cell::from_wire(captured), plan_.touches[i].role});
    }
    return calib::identify(problem, cell_.recipes.at(kRecipe).identification);
  }

  cell::Cell cell_;
  sim::Plant plant_;
  calib::TouchPlan plan_;
  calib::IdentificationProblem problem_;
  std::vector<sim::Path> searches_;
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

/// The mean of the held-out touches of each plane against its reference, as the paper's Table VII has it.
class PlaneMeans {
 public:
  void add(const calib::IdentificationResult& result) {
    for (const calib::FaceDistances& face : result.distances) {
      if (face.role != calib::TouchRole::kHeldOut) continue;
      OfPlane& plane = planes_[face.face];
      plane.off_m.push_back(std::abs(face.calibrated_mean_m));
      plane.removed.push_back(1.0 - std::abs(face.calibrated_mean_m / face.nominal_mean_m));
    }
  }
  void print() const {
    for (const auto& [face, plane] : planes_) {
      std::printf(
          "  plane %d: mean off by %.1f um (median) to %.1f um (worst); %.2f %% (median) to %.2f %% (worst) "
          "of "
          "the nominal mean's error removed\n",
          face + 1, median(plane.off_m) / kMicrometres, std::ranges::max(plane.off_m) / kMicrometres,
          100.0 * median(plane.removed), 100.0 * std::ranges::min(plane.removed));
    }
  }

 private:
  struct OfPlane {
    std::vector<double> off_m, removed;
  };
  std::map<int, OfPlane> planes_;
};

TEST_P(Figures, HeldOutTouchesOfAHundredSeedsShowWhatIsPromised) {
  const double noise_m = cell_.touch_noise_m;
  std::vector<double> means_m, rms_parts, worst_plane_parts, removed, removed_on_worst_plane;
  PlaneMeans plane_means;
  double condition_max = 0.0;
  std::size_t iterations_max = 0;
  for (int seed = 1; seed <= kSeedCount; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const calib::IdentificationResult result = calibrate(noise_m, static_cast<std::uint64_t>(seed));
    ASSERT_EQ(result.status, calib::IdentificationStatus::kConverged) << result.message;
    EXPECT_EQ(result.identifiable.columns.size(), static_cast<std::size_t>(kRank));
    const HeldOut figures = held_out(result);
    EXPECT_EQ(figures.touch_count, kPlaneCount * kHeldOutPerPlane);
    EXPECT_GE(figures.rms_removed, kRmsRemovedMin);
    means_m.push_back(figures.mean_max_m);
    plane_means.add(result);
    rms_parts.push_back(figures.rms_m / noise_m);
    worst_plane_parts.push_back(figures.plane_rms_max_m / noise_m);
    removed.push_back(figures.rms_removed);
    removed_on_worst_plane.push_back(figures.rms_removed_min);
    condition_max = std::max(condition_max, result.iterations.back().condition_number);
    iterations_max = std::max(iterations_max, result.iterations.size());
  }
  const auto beyond =
      std::ranges::count_if(means_m, [](double mean_m) { return mean_m > kHeldOutMeanMaxMetres; });
  EXPECT_LE(beyond, kSeedsBeyondMax);
  // Forty touches of declared noise scatter by 11 % themselves.
  EXPECT_LE(std::ranges::count_if(rms_parts, [](double part) { return part > kHeldOutRmsMaxPart; }),
            kSeedsBeyondMax);
  EXPECT_LE(median(rms_parts), kHeldOutRmsMedianMaxPart);
  // On the worst plane only the noise is left. It alone is more than 1 % of what Table III misses plane 3 by
  // (some 1.4 mm rms where the held-out touches are).
  EXPECT_LE(median(worst_plane_parts), kHeldOutRmsMaxPart);
  EXPECT_LT(condition_max, kConditionNumberMax);
  EXPECT_LE(iterations_max, static_cast<std::size_t>(kIterationsMax));
  std::printf(
      "cell %s, %d seeds: held-out rms %.3f (median) to %.3f (worst) x noise; largest plane mean %.1f um "
      "(median) "
      "to %.1f um (worst), %td of them beyond %.0f um; rms removed %.2f %% (median) to %.2f %% (worst), on "
      "the "
      "worst plane %.2f %% to %.2f %%; condition number up to %.1f, %zu iterations at most\n",
      GetParam(), kSeedCount, median(rms_parts), std::ranges::max(rms_parts), median(means_m) / kMicrometres,
      std::ranges::max(means_m) / kMicrometres, beyond, kHeldOutMeanMaxMetres / kMicrometres,
      100.0 * median(removed), 100.0 * std::ranges::min(removed), 100.0 * median(removed_on_worst_plane),
      100.0 * std::ranges::min(removed_on_worst_plane), condition_max, iterations_max);
  plane_means.print();
}

TEST_P(Figures, WithoutNoiseTheIdentifiedArmIsTheTrueOneInItsWholeRange) {
  const calib::IdentificationResult result = calibrate(0.0, 1);
  ASSERT_EQ(result.status, calib::IdentificationStatus::kConverged) << result.message;
  std::mt19937_64 chance(500);
  const auto uniform = [&chance] { return static_cast<double>(chance() >> 11) * 0x1p-53; };
  const calib::JointRanges& ranges = cell_.arm.joint_ranges;
  double worst_m = 0.0;
  double worst_nominal_m = 0.0;
  for (int i = 0; i < kPostureCount; ++i) {
    calib::JointVector joints;
    for (int j = 0; j < calib::kJointCount; ++j) {
      joints[j] = ranges.lower[j] + uniform() * (ranges.upper[j] - ranges.lower[j]);
    }
    const auto tip_m = [&joints](const calib::KinematicModel& model) {
      return calib::forward_chain(model, joints).tip_in_block_m();
    };
    worst_m = std::max(worst_m, (tip_m(result.calibrated) - tip_m(plant_.truth)).norm());
    worst_nominal_m = std::max(worst_nominal_m, (tip_m(cell_.arm.model) - tip_m(plant_.truth)).norm());
  }
  EXPECT_LE(worst_m, kTipErrorMaxMetres);
  EXPECT_GT(worst_nominal_m, 100.0 * kTipErrorMaxMetres) << "the truth hides nothing";
  std::printf("cell %s, no noise: tip within %.2f um of the truth's (nominal: %.2f mm) at %d postures\n",
              GetParam(), worst_m / kMicrometres, calib::mm_from_metres(worst_nominal_m), kPostureCount);
}

INSTANTIATE_TEST_SUITE_P(Cells, Figures, ::testing::Values("edf", "demo"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace touchcal::testing
