#include "service/http/json_view.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib_core/units.hpp"
#include "service/verdict.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;
using Json = nlohmann::ordered_json;

/// A figure that is not there, or is no number, is null: never 0, never NaN.
Json number(std::optional<double> value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json id_or_null(const std::optional<std::int64_t>& id) {
  return id ? Json(std::to_string(*id)) : Json(nullptr);
}

/// How many touches a run makes is known once it is planned; until then there are none.
Json count_once_planned(int touches_total) { return touches_total > 0 ? Json(touches_total) : Json(nullptr); }

/// Text from outside (a robot's message, an operator's key) may be no UTF-8: it is shown as far as it is.
std::string text_of(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const char* status_name(calib::ParameterStatus status) {
  switch (status) {
    case calib::ParameterStatus::kIdentified:
      return "identified";
    case calib::ParameterStatus::kGrouped:
      return "grouped";
    case calib::ParameterStatus::kNoEffect:
      return "no_effect";
    case calib::ParameterStatus::kExcluded:
      return "excluded";
    case calib::ParameterStatus::kWeak:
      return "weak";
  }
  return "";
}

const char* group_name(calib::ParameterGroup group) {
  switch (group) {
    case calib::ParameterGroup::kPlace:
      return "place";
    case calib::ParameterGroup::kArm:
      return "arm";
    case calib::ParameterGroup::kTool:
      return "tool";
  }
  return "";
}

const char* role_name(calib::TouchRole role) {
  switch (role) {
    case calib::TouchRole::kFit:
      return "fit";
    case calib::TouchRole::kHeldOut:
      return "held_out";
    case calib::TouchRole::kProof:
      return "proof";
  }
  return "";
}

const calib::ErrorParameter& parameter_at(int index) {
  return calib::error_parameters()[static_cast<std::size_t>(index)];
}

/// A parameter's value in the unit that the document shows it in: mm or rad.
double shown(int index, double value) {
  return parameter_at(index).is_length() ? mm_from_metres(value) : value;
}

Json parameter_json(const Cell& cell, const calib::IdentificationResult& result, int index) {
  const calib::ErrorParameter& parameter = parameter_at(index);
  const calib::CandidateStatus& candidate = result.identifiable.candidates[static_cast<std::size_t>(index)];
  const std::string name = parameter.name();
  Json grouped_with = Json::array();
  for (const auto& [other, factor] : candidate.grouped_with) {
    // One shown unit of this error adds `factor` shown units to the other one.
    grouped_with.push_back(
        {{"name", parameter_at(other).name()}, {"factor", shown(other, factor) / shown(index, 1.0)}});
  }
  const bool identified = candidate.status == calib::ParameterStatus::kIdentified;
  return {{"name", name},
          {"frame", parameter.frame},
          {"kind", name.substr(0, name.size() - 1)},
          {"group", group_name(parameter.group())},
          {"unit", parameter.is_length() ? "mm" : "rad"},
          {"nominal", shown(index, calib::parameter_value(cell.arm.model, index))},
          {"status", status_name(candidate.status)},
          {"error", identified ? Json(shown(index, result.errors[index])) : Json(nullptr)},
          {"std_uncertainty", nullptr},
          {"grouped_with", grouped_with}};
}

Json iteration_json(const calib::Iteration& iteration) {
  return {{"condition_number", number(iteration.condition_number)},
          {"scaled_condition_number", number(iteration.scaled_condition_number)},
          {"residual_rms_mm", number(mm_from_metres(iteration.residual_rms_m))},
          {"step_norm", number(iteration.step_norm)}};
}

/// Distances run along the outward normal from the origin: reference + signed distance.
Json plane_json(const Cell& cell, const calib::FaceDistances& face) {
  const double reference = cell.block.faces[static_cast<std::size_t>(face.face)].plane.offset_m;
  const auto percent = [](double part, double whole) {
    return whole == 0.0 ? Json(nullptr) : number(100.0 * (1.0 - std::abs(part) / std::abs(whole)));
  };
  return {{"plane", face.face + 1},
          {"touch_count", face.touch_count},
          {"reference_mm", mm_from_metres(reference)},
          {"nominal_mean_mm", mm_from_metres(reference + face.nominal_mean_m)},
          {"calibrated_mean_mm", mm_from_metres(reference + face.calibrated_mean_m)},
          {"error_removed_percent", percent(face.calibrated_mean_m, face.nominal_mean_m)},
          {"nominal_agreement_percent", percent(face.nominal_mean_m, reference)},
          {"nominal_rms_mm", mm_from_metres(face.nominal_rms_m)},
          {"calibrated_rms_mm", mm_from_metres(face.calibrated_rms_m)}};
}

Json planes_json(const Cell& cell, const calib::IdentificationResult& result, calib::TouchRole role) {
  Json planes = Json::array();
  for (const calib::FaceDistances& face : result.distances) {
    if (face.role == role) planes.push_back(plane_json(cell, face));
  }
  return planes;
}

Json run_json(const StoredRun& run) {
  return {{"id", std::to_string(run.id)},
          {"recipe", run.recipe},
          {"outcome", run.outcome},
          {"verdict", run.verdict},
          {"touches_done", run.touches_done},
          {"touches_total", count_once_planned(run.touches_total)},
          {"started_at", run.started_at},
          {"ended_at", value_or_null(run.ended_at)},
          {"fault_code", value_or_null(run.fault_code)},
          {"fault_message", value_or_null(run.fault_message)}};
}

}  // namespace

std::string status_document(const Status& status) {
  Json document{{"state", state_name(status.state)},
                {"run_id", id_or_null(status.run_id)},
                {"recipe", value_or_null(status.recipe)},
                {"touches_done", status.touches_done},
                {"touches_total", count_once_planned(status.touches_total)},
                {"plane", value_or_null(status.plane)},
                {"identifiable_count", value_or_null(status.identifiable_count)},
                {"condition_number", number(status.condition_number)},
                {"predicted_tip_rms_mm", nullptr},
                {"eta_s", number(status.eta_s)},
                {"verdict", verdict_name(status.verdict)},
                {"controller_connected", status.controller.connected},
                {"controller_powered", value_or_null(status.controller.powered)},
                {"controller_mode", value_or_null(status.controller.mode)},
                {"controller_estop", value_or_null(status.controller.emergency_stop)}};
  const FaultEntry* entry = status.fault ? &describe(status.fault->code) : nullptr;
  document["fault_code"] = entry ? Json(entry->name) : Json(nullptr);
  document["fault_message"] = entry ? Json(status.fault->message()) : Json(nullptr);
  document["fault_robot_action"] = entry ? Json(entry->robot_action) : Json(nullptr);
  document["fault_next_step"] = entry ? Json(entry->next_step) : Json(nullptr);
  document["last_accepted_run_id"] = id_or_null(status.last_accepted_run_id);
  document["last_accepted_at"] = value_or_null(status.last_accepted_at);
  document["data_age_ms"] = value_or_null(status.data_age_ms);
  document["sequence"] = status.sequence;
  document["instance_id"] = status.instance_id;
  document["since"] = status.since;
  return text_of(document);
}

std::string run_document(const StoredRun& run) { return text_of(run_json(run)); }

std::string runs_document(const std::vector<StoredRun>& runs, std::optional<std::int64_t> next_before) {
  Json list = Json::array();
  for (const StoredRun& run : runs) list.push_back(run_json(run));
  return text_of({{"runs", list}, {"next_before", id_or_null(next_before)}});
}

std::string touches_document(const Cell& cell, const std::vector<StoredTouch>& touches) {
  Json list = Json::array();
  for (const StoredTouch& touch : touches) {
    Json joints = Json::array();
    for (const std::int32_t microdeg : touch.joints) joints.push_back(microdeg / 1e6);
    list.push_back({{"plane", touch.plane}, {"role", role_name(touch.role)}, {"joints_deg", joints}});
  }
  return text_of({{"schema", "touchcal/touches/1"}, {"arm", cell.arm.name}, {"touches", list}});
}

std::string result_document(const Cell& cell, const Recipe& recipe, const calib::IdentificationResult& result,
                            const ResultContext& context) {
  Json document{{"schema", "touchcal/result/1"},
                {"arm", cell.arm.name},
                {"recipe", recipe.name},
                {"touch_count", result.fitted_touch_count},
                {"complete", context.complete},
                {"warnings", context.warnings},
                {"rejected_touches", Json::array()},
                {"converged", result.status == calib::IdentificationStatus::kConverged}};
  Json iterations = Json::array();
  for (const calib::Iteration& iteration : result.iterations) iterations.push_back(iteration_json(iteration));
  document["iterations"] = iterations;
  document["identifiable_count"] = result.identifiable.columns.size();
  const calib::Iteration* last = result.iterations.empty() ? nullptr : &result.iterations.back();
  document["condition_number"] = last ? number(last->condition_number) : Json(nullptr);
  document["scaled_condition_number"] = last ? number(last->scaled_condition_number) : Json(nullptr);
  document["singular_values"] = result.singular_values;
  Json parameters = Json::array();
  for (int i = 0; i < calib::kErrorParameterCount; ++i) parameters.push_back(parameter_json(cell, result, i));
  document["parameters"] = parameters;
  document["artefact_parameters"] = Json::array();  // none is estimated yet
  document["planes"] = planes_json(cell, result, calib::TouchRole::kFit);
  document["planes_held_out"] = planes_json(cell, result, calib::TouchRole::kHeldOut);
  document["planes_proof"] = planes_json(cell, result, calib::TouchRole::kProof);
  document["scale"] = {{"source", "block"}, {"std_uncertainty_ppm", nullptr}, {"warning", nullptr}};
  document["tip_uncertainty"] = {
      {"at_block_rms_mm", nullptr}, {"workspace_box_rms_mm", nullptr}, {"joint_ranges_rms_mm", nullptr}};
  document["fit"] = {
      {"noise_declared_um", 1e3 * mm_from_metres(cell.touch_noise_m)},
      {"noise_estimated_um",
       result.noise_estimated_m ? number(1e3 * mm_from_metres(*result.noise_estimated_m)) : Json(nullptr)},
      {"lack_of_fit_p", nullptr}};
  const Judgement judgement = judge(result, cell.acceptance, context.complete);
  document["verdict"] = {{"accepted", judgement.accepted}, {"reasons", judgement.reasons}};
  return text_of(document);
}

}  // namespace cell
