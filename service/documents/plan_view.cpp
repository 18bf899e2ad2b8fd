#include "service/documents/internal/plan_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/joint_units.hpp"
#include "service/base/json_figures.hpp"
#include "service/documents/json_view.hpp"
#include "service/documents/parameter_view.hpp"
#include "service/documents/result_view.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

Json joints_json(const Cell& cell, const calib::JointVector& joints) {
  const calib::JointVector shown = joints.cwiseQuotient(joint_units(cell.arm.model));
  return std::vector<double>(shown.begin(), shown.end());
}

Json way_json(const Cell& cell, const std::vector<calib::JointVector>& way) {
  Json list = Json::array();
  for (const calib::JointVector& joints : way) list.push_back(joints_json(cell, joints));
  return list;
}

Json touch_json(const Cell& cell, const calib::PlannedTouch& touch) {
  const Eigen::Vector3d& direction = touch.search_direction;
  return {{"plane", touch.face + 1},
          {"role", role_name(touch.role)},
          {"joints_deg", joints_json(cell, touch.joints)},
          {"via_joints_deg", way_json(cell, touch.via)},
          {"clear_joints_deg", joints_json(cell, touch.clear_joints)},
          {"approach_joints_deg", joints_json(cell, touch.approach_joints)},
          {"search_direction", {direction.x(), direction.y(), direction.z()}},
          {"search_length_mm", mm_from_metres(touch.search_length_m)},
          {"search_end_joints_deg", joints_json(cell, touch.search_end_joints)},
          {"tilt_deg", calib::degrees_from_radians(touch.tilt_rad)},
          {"predicted_miss_mm", mm_from_metres(touch.predicted_position_error_m)},
          {"travel_s", number(touch.travel_s)},
          {"touch_s", number(touch.touch_s)}};
}

Json speeds_json(const Speeds& speeds) {
  Json json{{"travel_mm_s", mm_from_metres(speeds.travel_m_s)},
            {"approach_mm_s", mm_from_metres(speeds.approach_m_s)},
            {"search_mm_s", mm_from_metres(speeds.search_m_s)},
            {"second_mm_s", nullptr},
            {"second_backoff_mm", nullptr}};
  if (speeds.second) {
    json["second_mm_s"] = mm_from_metres(speeds.second->speed_m_s);
    json["second_backoff_mm"] = mm_from_metres(speeds.second->backoff_m);
  }
  return json;
}

Json goal_json(const Recipe& recipe) {
  const auto name = std::ranges::find(kCriterionNames, recipe.goal.criterion,
                                      &std::pair<calib::PlanCriterion, std::string_view>::first);
  return {{"criterion", std::string(name->second)}, {"tip_rms_max_mm", number_mm(recipe.goal.tip_rms_max_m)}};
}

/// The parameters as in a result, without their errors.
Json predicted_parameters_json(const Recipe& recipe, const PlannedIdentification& planned) {
  Json parameters = parameters_json(planned.problem, recipe.identification, planned.result);
  for (Json& parameter : parameters) {
    parameter.erase("error");
    parameter.erase("interval95");
  }
  return parameters;
}

Json predicted_artefact_json(const PlannedIdentification& planned) {
  Json parameters = artefact_parameters_json(planned.problem, planned.result);
  for (Json& parameter : parameters) parameter.erase("value");
  return parameters;
}

Json planes_of(const calib::TouchPlan& plan, const Recipe& recipe) {
  Json planes = Json::array();
  for (const int face : recipe.faces) {
    const auto count = [&](calib::TouchRole role) {
      return std::ranges::count_if(plan.touches, [&](const calib::PlannedTouch& touch) {
        return touch.face == face && touch.role == role;
      });
    };
    planes.push_back({{"plane", face + 1},
                      {"fit", count(calib::TouchRole::kFit)},
                      {"held_out", count(calib::TouchRole::kHeldOut)}});
  }
  return planes;
}

Json efforts_json(const std::vector<calib::FaceEffort>& efforts) {
  Json list = Json::array();
  for (const calib::FaceEffort& effort : efforts) {
    Json obstructions = Json::array();
    for (const calib::Obstruction& obstruction : effort.obstructions)
      obstructions.push_back({{"reason", obstruction.reason}, {"count", obstruction.count}});
    list.push_back({{"plane", effort.face + 1},
                    {"tried", effort.tried},
                    {"feasible", effort.feasible},
                    {"obstructions", obstructions}});
  }
  return list;
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

Json limits_json(const calib::TouchPlan& plan, const TipPrediction& tip) {
  const std::vector<ErrorShare> shares = error_shares(tip);
  Json accuracy = Json::array();
  for (const ErrorShare& share : shares) {
    accuracy.push_back({{"source", share.source},
                        {"workspace_box_rms_mm", mm_from_metres(share.rms_m)},
                        {"share_percent", 100.0 * share.share}});
  }
  Json words = Json::array();
  if (const std::string of_accuracy = accuracy_words(shares); !of_accuracy.empty())
    words.push_back(of_accuracy);
  if (const auto out_of_reach = out_of_reach_words(tip)) words.push_back(*out_of_reach);
  for (const std::string& line : effort_lines(plan.efforts)) words.push_back(line);
  return {{"words", words}, {"accuracy", accuracy}, {"postures", efforts_json(plan.efforts)}};
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

Json plan_json(const TipRegions& regions, const Recipe& recipe, const calib::TouchPlan& plan,
               const PlannedIdentification& planned) {
  const Cell& cell = regions.cell();
  const calib::IdentificationResult& result = planned.result;
  const TipPrediction tip = predict_tip(regions, planned.problem, result);
  const calib::Iteration& last = result.iterations.back();
  Json touches = Json::array();
  for (const calib::PlannedTouch& touch : plan.touches) touches.push_back(touch_json(cell, touch));
  return {{"schema", "touchcal/plan/1"},
          {"plan_id", nullptr},
          {"cell", cell.name},
          {"arm", cell.arm.name},
          {"recipe", recipe.name},
          {"goal", goal_json(recipe)},
          {"touch_count", plan.touches.size()},
          {"planes", planes_of(plan, recipe)},
          {"identifiable_count", result.identifiable.columns.size()},
          {"condition_number", number(last.condition_number)},
          {"scaled_condition_number", number(last.scaled_condition_number)},
          {"tip_uncertainty", tip_json(cell, tip)},
          {"parameters", predicted_parameters_json(recipe, planned)},
          {"artefact_parameters", predicted_artefact_json(planned)},
          {"duration_s", number(plan.duration_s())},
          {"limits", limits_json(plan, tip)},
          {"warnings", result.warnings},
          {"speeds", speeds_json(cell.speeds)},
          {"park_joints_deg", joints_json(cell, cell.park_joints)},
          {"touches", touches},
          {"park_via_joints_deg", way_json(cell, plan.park_via)},
          {"park_s", number(plan.park_s)}};
}

}  // namespace cell
