#include "service/place_search.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib_core/estimation/block_registration.hpp"
#include "calib_core/numerics/halton.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "service/acquisition/planning.hpp"
#include "service/plan.hpp"

namespace cell {
namespace {

/// The smallest box along the new axes that holds the box.
calib::Box moved(const Eigen::Isometry3d& new_from_old, const calib::Box& box) {
  const Eigen::Vector3d middle_m = new_from_old * (0.5 * (box.min_m + box.max_m));
  const Eigen::Vector3d half_m = new_from_old.linear().cwiseAbs() * (0.5 * (box.max_m - box.min_m));
  return {box.name, middle_m - half_m, middle_m + half_m};
}

/// A box that is turned, in pieces of about this size, each held by a box along the new axes: so much less is
/// taken for forbidden than by one box around all of it.
constexpr double kPieceMetres = 0.2;

std::vector<calib::Box> moved_in_pieces(const Eigen::Isometry3d& new_from_old, const calib::Box& box) {
  constexpr double kAlongAxes = 1e-9;
  const Eigen::Matrix3d turn = new_from_old.linear().cwiseAbs();
  if ((turn.rowwise().maxCoeff().array() > 1.0 - kAlongAxes).all()) return {moved(new_from_old, box)};
  const Eigen::Vector3d extent_m = box.max_m - box.min_m;
  const int count_x = static_cast<int>(std::ceil(extent_m.x() / kPieceMetres));
  const int count_z = static_cast<int>(std::ceil(extent_m.z() / kPieceMetres));
  const Eigen::Vector3d piece_m(extent_m.x() / count_x, extent_m.y(), extent_m.z() / count_z);
  std::vector<calib::Box> pieces;
  for (int x = 0; x < count_x; ++x) {
    for (int z = 0; z < count_z; ++z) {
      const Eigen::Vector3d min_m = box.min_m + Eigen::Vector3d(x * piece_m.x(), 0.0, z * piece_m.z());
      pieces.push_back(moved(new_from_old, {box.name, min_m, min_m + piece_m}));
    }
  }
  return pieces;
}

/// The i-th place, counted from 1, of a sequence that fills the range evenly.
BlockPlace place_in(const PlaceRange& range, int i) {
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

  void plan(PlaceFinding& finding, std::optional<int> candidate_count) const {
    const Cell there = with_block_at(cell_, finding.place);
    calib::PlanningProblem problem = planning_problem(there, recipe_);
    if (candidate_count) problem.candidate_count = *candidate_count;
    const auto outcome = calib::plan_touches(problem);
    finding.fully_planned = !candidate_count;
    finding.figures.reset();
    if (const auto* failure = std::get_if<calib::PlanningFailure>(&outcome)) {
      finding.reason = reason_of(*failure);
    } else {
      judge(there, std::get<calib::TouchPlan>(outcome), finding);
    }
  }

  /// The figure that places are ranked by; infinite without one.
  [[nodiscard]] double error_m(const PlaceFinding& finding) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (!finding.figures) return kNone;
    const bool over_ranges = recipe_.goal.criterion == calib::PlanCriterion::kTipInJointRanges;
    return (over_ranges ? finding.figures->joint_ranges_rms_m : finding.figures->workspace_box_rms_m)
        .value_or(kNone);
  }

 private:
  void judge(const Cell& there, const calib::TouchPlan& plan, PlaceFinding& finding) const {
    const PlannedIdentification planned = identify_planned(there, recipe_, plan);
    if (!planned.result.uncertainty) {
      finding.reason = planned.result.message;
      return;
    }
    const calib::UncertaintyBudget& uncertainty = *planned.result.uncertainty;
    const calib::KinematicModel& model = there.arm.model;
    finding.figures = PlaceFigures{
        .workspace_box_rms_m = predicted_rms_m(calib::region_over_postures(model, in_box_), uncertainty),
        .joint_ranges_rms_m =
            predicted_rms_m(calib::region_over_joint_ranges(model, there.arm.joint_ranges), uncertainty),
        .condition_number = planned.result.iterations.back().condition_number,
        .duration_s = plan.duration_s(),
        .touch_count = static_cast<int>(plan.touches.size())};
  }

  static std::string reason_of(const calib::PlanningFailure& failure) {
    if (failure.kind != calib::PlanningFailure::Kind::kFace) return failure.reason;
    return fmt::format("plane {}: {} of {} touches can be made, in the way most often: {}", failure.face + 1,
                       failure.found, failure.wanted, failure.reason);
  }

  const Cell& cell_;
  const Recipe& recipe_;
  std::vector<calib::JointVector> in_box_;  // where the workspace box is in the room
};

}  // namespace

Cell with_block_moved(const Cell& cell, const Eigen::Isometry3d& old_from_new) {
  Cell there = cell;
  const Eigen::Isometry3d new_from_old = old_from_new.inverse();
  calib::set_block_pose(there.arm.model, new_from_old * calib::block_pose_of(cell.arm.model));
  there.keep_out_boxes.clear();
  for (const calib::Box& box : cell.keep_out_boxes) {
    const auto pieces = moved_in_pieces(new_from_old, box);
    there.keep_out_boxes.insert(there.keep_out_boxes.end(), pieces.begin(), pieces.end());
  }
  there.workspace_box = moved(new_from_old, cell.workspace_box);
  return there;
}

Cell with_block_at(const Cell& cell, const BlockPlace& place) {
  return with_block_moved(
      cell, Eigen::Translation3d(place.shift_m) * Eigen::AngleAxisd(place.yaw_rad, Eigen::Vector3d::UnitY()));
}

std::vector<PlaceFinding> search_places(const Cell& cell, const Recipe& recipe, const PlaceRange& range,
                                        const PlaceSearchOptions& options,
                                        const calib::PlanningProgress& progress) {
  const PlaceSearch search(cell, recipe);
  const int full_count = std::min(options.full_count, options.place_count + 1);
  const auto tell = [&](const std::string& stage, int done) {
    if (progress) progress(stage, static_cast<double>(done) / (options.place_count + 1 + full_count));
  };
  std::vector<PlaceFinding> findings{{.present = true}};
  for (int i = 1; i <= options.place_count; ++i) findings.push_back({.place = place_in(range, i)});
  for (std::size_t i = 0; i < findings.size(); ++i) {
    tell(fmt::format("place {} of {}", i + 1, findings.size()), static_cast<int>(i));
    search.plan(findings[i], options.coarse_candidate_count);
  }
  const auto rank = [&] {
    std::ranges::stable_sort(findings, {},
                             [&](const PlaceFinding& finding) { return search.error_m(finding); });
  };
  rank();
  for (int i = 0; i < full_count && findings[static_cast<std::size_t>(i)].figures; ++i) {
    tell(fmt::format("best place {} of {}", i + 1, full_count), options.place_count + 1 + i);
    search.plan(findings[static_cast<std::size_t>(i)], std::nullopt);
  }
  rank();
  return findings;
}

}  // namespace cell
