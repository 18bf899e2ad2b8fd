#include "service/documents/place_search.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib_core/numerics/halton.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "config/moved_cell.hpp"
#include "service/documents/plan.hpp"
#include "service/run/planning_problem.hpp"

namespace cell {
namespace {

/// The i-th place, from 1, of a Halton sequence over the range.
BlockDisplacement place_in(const PlaceRange& range, int i) {
  const Eigen::Vector3d share(calib::van_der_corput(i, 2), calib::van_der_corput(i, 3),
                              calib::van_der_corput(i, 5));
  return {range.min.shift_m + share.cwiseProduct(range.max.shift_m - range.min.shift_m),
          range.min.yaw_rad + calib::van_der_corput(i, 7) * (range.max.yaw_rad - range.min.yaw_rad)};
}

class PlaceSearch {
 public:
  PlaceSearch(const Cell& cell, const Recipe& recipe)
      : cell_(cell),
        recipe_(recipe),
        in_box_(calib::postures_in_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box)) {}

  void plan(PlaceCandidate& candidate, std::optional<int> candidate_count) const {
    const Cell there = with_block_displaced(cell_, candidate.place);
    std::vector<calib::PlanningProblem> problems = planning_problems(there, recipe_);
    for (calib::PlanningProblem& problem : problems)
      problem.candidate_count = candidate_count.value_or(problem.candidate_count);
    const auto outcome = calib::plan_touches(problems);
    candidate.fully_planned = !candidate_count;
    candidate.figures.reset();
    if (const auto* failure = std::get_if<calib::PlanningFailure>(&outcome)) {
      candidate.reason = reason_of(*failure);
    } else {
      judge(there, std::get<calib::TouchPlan>(outcome), candidate);
    }
  }

  /// The figure that places are ranked by; infinite without a plan.
  [[nodiscard]] double error_m(const PlaceCandidate& candidate) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (!candidate.figures) return kNone;
    const bool over_ranges = recipe_.goal.criterion == calib::PlanCriterion::kTipInJointRanges;
    return (over_ranges ? candidate.figures->joint_ranges_rms_m : candidate.figures->workspace_box_rms_m)
        .value_or(kNone);
  }

 private:
  void judge(const Cell& there, const calib::TouchPlan& plan, PlaceCandidate& candidate) const {
    const PlannedIdentification planned = identify_planned(there, recipe_, plan);
    if (!planned.result.uncertainty) {
      candidate.reason = planned.result.message;
      return;
    }
    const calib::UncertaintyBudget& uncertainty = *planned.result.uncertainty;
    const calib::KinematicModel& model = there.arm.model;
    candidate.figures = PlaceFigures{
        .workspace_box_rms_m = predicted_rms_m(calib::region_over_postures(model, in_box_), uncertainty),
        .joint_ranges_rms_m =
            predicted_rms_m(calib::region_over_joint_ranges(model, there.arm.joint_ranges), uncertainty),
        .condition_number = planned.result.iterations.back().condition_number,
        .duration_s = plan.duration_s(),
        .touch_count = static_cast<int>(plan.touches.size())};
  }

  static std::string reason_of(const calib::PlanningFailure& failure) {
    if (failure.kind != calib::PlanningFailure::Kind::kFace) return failure.reason;
    return fmt::format("plane {}: {} of {} touches can be made, most frequent obstruction: {}",
                       failure.face + 1, failure.found, failure.wanted, failure.reason);
  }

  const Cell& cell_;
  const Recipe& recipe_;
  std::vector<calib::JointVector> in_box_;  // where the workspace box is in the room
};

}  // namespace

std::vector<PlaceCandidate> search_places(const Cell& cell, const Recipe& recipe, const PlaceRange& range,
                                          const PlaceSearchOptions& options,
                                          const calib::PlanningProgress& progress) {
  const PlaceSearch search(cell, recipe);
  const int full_count = std::min(options.full_count, options.place_count + 1);
  const auto tell = [&](const std::string& stage, int done) {
    if (progress) progress(stage, static_cast<double>(done) / (options.place_count + 1 + full_count));
  };
  std::vector<PlaceCandidate> candidates{{.present = true}};
  for (int i = 1; i <= options.place_count; ++i) candidates.push_back({.place = place_in(range, i)});
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    tell(fmt::format("place {} of {}", i + 1, candidates.size()), static_cast<int>(i));
    search.plan(candidates[i], options.coarse_candidate_count);
  }
  const auto rank = [&] {
    std::ranges::stable_sort(candidates, {},
                             [&](const PlaceCandidate& candidate) { return search.error_m(candidate); });
  };
  rank();
  for (int i = 0; i < full_count && candidates[static_cast<std::size_t>(i)].figures; ++i) {
    tell(fmt::format("best place {} of {}", i + 1, full_count), options.place_count + 1 + i);
    search.plan(candidates[static_cast<std::size_t>(i)], std::nullopt);
  }
  rank();
  return candidates;
}

}  // namespace cell
