#include "service/documents/internal/plan_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "calib_core/geometry/units.hpp"
#include "config/joint_units.hpp"
#include "config/touched_places.hpp"
#include "service/documents/figures.hpp"
#include "service/documents/json_view.hpp"
#include "service/documents/parameter_view.hpp"
#include "service/documents/result_view.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

PlanDocument::Joints joints_of(const Cell& cell, const calib::JointVector& joints) {
  const calib::JointVector shown = joints.cwiseQuotient(joint_units(cell.arm.model));
  return {shown.begin(), shown.end()};
}

std::vector<PlanDocument::Joints> way_of(const Cell& cell, const std::vector<calib::JointVector>& way) {
  std::vector<PlanDocument::Joints> list;
  for (const calib::JointVector& joints : way) list.push_back(joints_of(cell, joints));
  return list;
}

PlanDocument::Touch touch_of(const Cell& cell, const Recipe& recipe, const calib::PlannedTouch& touch) {
  const Eigen::Vector3d& direction = touch.search_direction;
  return {.plane = touch.face + 1,
          .place = further_place_name(cell.block, recipe, touch.face),
          .tip = further_tip_name(cell, recipe, touch.face),
          .role = touch.role,
          .joints_deg = joints_of(cell, touch.joints),
          .via_joints_deg = way_of(cell, touch.via),
          .clear_joints_deg = joints_of(cell, touch.clear_joints),
          .approach_joints_deg = joints_of(cell, touch.approach_joints),
          .search_direction = {direction.x(), direction.y(), direction.z()},
          .search_length_mm = mm_from_metres(touch.search_length_m),
          .search_end_joints_deg = joints_of(cell, touch.search_end_joints),
          .tilt_deg = calib::degrees_from_radians(touch.tilt_rad),
          .predicted_miss_mm = mm_from_metres(touch.predicted_position_error_m),
          .travel_s = finite(touch.travel_s),
          .touch_s = finite(touch.touch_s)};
}

PlanDocument::SpeedsOfArm speeds_of(const Speeds& speeds) {
  PlanDocument::SpeedsOfArm document{.travel_mm_s = mm_from_metres(speeds.travel_m_s),
                                     .approach_mm_s = mm_from_metres(speeds.approach_m_s),
                                     .search_mm_s = mm_from_metres(speeds.search_m_s)};
  if (speeds.second) {
    document.second_mm_s = mm_from_metres(speeds.second->speed_m_s);
    document.second_backoff_mm = mm_from_metres(speeds.second->backoff_m);
  }
  return document;
}

PlanDocument::Goal goal_of(const Recipe& recipe) {
  const auto name = std::ranges::find(kCriterionNames, recipe.goal.criterion,
                                      &std::pair<calib::PlanCriterion, std::string_view>::first);
  return {.criterion = std::string(name->second), .tip_rms_max_mm = finite_mm(recipe.goal.tip_rms_max_m)};
}

/// The parameters as in a result, without their errors.
std::vector<PlannedParameter> predicted_parameters(const Recipe& recipe,
                                                   const PlannedIdentification& planned) {
  const auto parameters = parameters_of(planned.problem, recipe.identification, planned.result);
  return {parameters.begin(), parameters.end()};
}

std::vector<PlannedArtefactParameter> predicted_artefact(const PlannedIdentification& planned) {
  const auto parameters = artefact_parameters_of(planned.problem, planned.result);
  return {parameters.begin(), parameters.end()};
}

std::vector<PlanDocument::TouchesOfPlane> planes_of(const Cell& cell, const calib::TouchPlan& plan,
                                                    const Recipe& recipe) {
  std::vector<PlanDocument::TouchesOfPlane> planes;
  for (const int face : touched_faces(cell.block, recipe)) {
    const auto count = [&](calib::TouchRole role) {
      return static_cast<int>(std::ranges::count_if(plan.touches, [&](const calib::PlannedTouch& touch) {
        return touch.face == face && touch.role == role;
      }));
    };
    planes.push_back({.plane = face + 1,
                      .place = further_place_name(cell.block, recipe, face),
                      .tip = further_tip_name(cell, recipe, face),
                      .fit = count(calib::TouchRole::kFit),
                      .held_out = count(calib::TouchRole::kHeldOut)});
    if (const int proof = count(calib::TouchRole::kProof); proof > 0) planes.back().proof = proof;
  }
  return planes;
}

std::vector<PlanDocument::Effort> efforts_of(const std::vector<calib::FaceEffort>& efforts) {
  std::vector<PlanDocument::Effort> list;
  for (const calib::FaceEffort& effort : efforts) {
    PlanDocument::Effort& told = list.emplace_back(
        PlanDocument::Effort{.plane = effort.face + 1, .tried = effort.tried, .feasible = effort.feasible});
    for (const calib::Obstruction& obstruction : effort.obstructions)
      told.obstructions.push_back({.reason = obstruction.reason, .count = obstruction.count});
  }
  return list;
}

/// What every plan has: where the arm goes.
PlanDocument steps_of(const Cell& cell, const Recipe& recipe, const calib::TouchPlan& plan) {
  PlanDocument document{.cell = cell.name,
                        .arm = cell.arm.name,
                        .recipe = recipe.name,
                        .touch_count = static_cast<int>(plan.touches.size()),
                        .planes = planes_of(cell, plan, recipe),
                        .duration_s = finite(plan.duration_s()),
                        .speeds = speeds_of(cell.speeds),
                        .park_joints_deg = joints_of(cell, cell.park_joints),
                        .park_via_joints_deg = way_of(cell, plan.park_via),
                        .park_s = finite(plan.park_s)};
  for (const calib::PlannedTouch& touch : plan.touches)
    document.touches.push_back(touch_of(cell, recipe, touch));
  if (!plan.leaving.empty()) document.leaving.emplace();
  for (const calib::LeavingPlace& place : plan.leaving)
    document.leaving->push_back({.touches = static_cast<int>(place.touches),
                                 .via_joints_deg = way_of(cell, place.via),
                                 .travel_s = finite(place.travel_s)});
  return document;
}

std::string accuracy_words(const std::vector<ErrorShare>& shares) {
  std::string words;
  for (const ErrorShare& share : shares) {
    if (share.share < kShareReportedMin) break;
    words += fmt::format("{}{} {:.0f} % ({:.3f} mm alone)", words.empty() ? "" : ", ", share.source,
                         100.0 * share.share, mm_from_metres(share.rms_m));
  }
  return words.empty() ? words : "the tip error in the workspace box comes from: " + words;
}

/// The part of the workspace box that the arm does not reach.
std::optional<std::string> out_of_reach_words(const TipPrediction& tip) {
  if (!tip.map) return std::nullopt;
  const auto cells = tip.map->rms_m.size();
  const auto out = std::ranges::count(tip.map->rms_m, std::optional<double>{});
  if (out == 0) return std::nullopt;
  return fmt::format("the tip does not reach {} of the {} cells of the workspace box", out, cells);
}

PlanDocument::Limits limits_of(const calib::TouchPlan& plan, const TipPrediction& tip) {
  const std::vector<ErrorShare> shares = error_shares(tip);
  PlanDocument::Limits limits{.postures = efforts_of(plan.efforts)};
  for (const ErrorShare& share : shares) {
    limits.accuracy.push_back({.source = share.source,
                               .workspace_box_rms_mm = mm_from_metres(share.rms_m),
                               .share_percent = 100.0 * share.share});
  }
  if (const std::string of_accuracy = accuracy_words(shares); !of_accuracy.empty())
    limits.words.push_back(of_accuracy);
  if (const auto out_of_reach = out_of_reach_words(tip)) limits.words.push_back(*out_of_reach);
  for (const std::string& line : effort_lines(plan.efforts)) limits.words.push_back(line);
  return limits;
}

}  // namespace

std::vector<ErrorShare> error_shares(const TipPrediction& tip) {
  std::vector<ErrorShare> shares;
  double sum = 0.0;
  for (const TipPrediction::OfSource& source : tip.sources) {
    const double rms_m = source.workspace_box_rms_m.value_or(0.0);
    shares.push_back({source.name, rms_m, rms_m * rms_m});
    sum += rms_m * rms_m;
  }
  for (ErrorShare& share : shares) share.share = sum > 0.0 ? share.share / sum : 0.0;
  std::ranges::stable_sort(shares, std::greater<>(), &ErrorShare::share);
  return shares;
}

PlanDocument plan_of(const TipRegions& regions, const Recipe& recipe, const calib::TouchPlan& plan,
                     const PlannedIdentification& planned) {
  const Cell& cell = regions.cell();
  const calib::IdentificationResult& result = planned.result;
  const TipPrediction tip = predict_tip(regions, planned.problem, result);
  const calib::Iteration& last = result.iterations.back();
  PlanDocument document = steps_of(cell, recipe, plan);
  document.goal = goal_of(recipe);
  document.identifiable_count = static_cast<int>(result.identifiable.columns.size());
  document.condition_number = finite(last.condition_number);
  document.scaled_condition_number = finite(last.scaled_condition_number);
  document.tip_uncertainty = tip_of(cell, tip);
  document.parameters = predicted_parameters(recipe, planned);
  document.artefact_parameters = predicted_artefact(planned);
  document.limits = limits_of(plan, tip);
  document.warnings = result.warnings;
  return document;
}

PlanDocument plan_of_verification(const Cell& cell, const Recipe& recipe, const calib::TouchPlan& plan,
                                  RunKind kind) {
  PlanDocument document = steps_of(cell, recipe, plan);
  document.goal.criterion = std::string(run_kind_name(kind));
  document.limits = {
      .words = effort_lines(plan.efforts), .accuracy = {}, .postures = efforts_of(plan.efforts)};
  return document;
}

}  // namespace cell
