#include "service/http/json_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/units.hpp"
#include "service/http/json_figures.hpp"
#include "service/traceability.hpp"

namespace cell {
namespace {

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json id_or_null(const std::optional<std::int64_t>& id) {
  return id ? Json(std::to_string(*id)) : Json(nullptr);
}

/// How many touches a run makes is known once it is planned; until then there are none.
Json count_once_planned(int touches_total) { return touches_total > 0 ? Json(touches_total) : Json(nullptr); }

Json run_json(const StoredRun& run) {
  return {{"id", std::to_string(run.id)},
          {"recipe", run.recipe},
          {"touching", is_guided(run.trace_json) ? "guided" : "automatic"},
          {"outcome", run.outcome},
          {"verdict", run.verdict},
          {"touches_done", run.touches_done},
          {"touches_total", count_once_planned(run.touches_total)},
          {"started_at", run.started_at},
          {"ended_at", value_or_null(run.ended_at)},
          {"fault_code", value_or_null(run.fault_code)},
          {"fault_message", value_or_null(run.fault_message)}};
}

/// What a person who touches by hand is told.
void add_by_hand(Json& document, const std::optional<HandGuide>& guide) {
  document["by_hand"] = guide ? Json(hand_activity_name(guide->activity)) : Json(nullptr);
  document["by_hand_step"] = guide ? Json(hand_step_name(guide->step)) : Json(nullptr);
  document["by_hand_plane"] = guide ? Json(guide->plane) : Json(nullptr);
  document["by_hand_index"] = guide ? Json(guide->index) : Json(nullptr);
  document["by_hand_total"] = guide ? Json(guide->total) : Json(nullptr);
  document["by_hand_words"] = guide ? Json(guide->words) : Json(nullptr);
  document["by_hand_problem"] = guide && guide->problem ? Json(*guide->problem) : Json(nullptr);
  Json& joints = document["by_hand_joints_deg"] = nullptr;
  if (!guide || !guide->about_joints) return;
  joints = Json::array();
  for (const double joint : *guide->about_joints) joints.push_back(calib::degrees_from_radians(joint));
}

}  // namespace

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

std::string status_document(const Status& status) {
  Json document{{"state", state_name(status.state)},
                {"waiting_for", value_or_null(status.waiting_for)},
                {"run_id", id_or_null(status.run_id)},
                {"recipe", value_or_null(status.recipe)},
                {"touches_done", status.touches_done},
                {"touches_total", count_once_planned(status.touches_total)},
                {"plane", value_or_null(status.plane)},
                {"identifiable_count", value_or_null(status.identifiable_count)},
                {"condition_number", number(status.condition_number)},
                {"predicted_tip_rms_mm", number_mm(status.predicted_tip_rms_m)},
                {"more_would_bring", value_or_null(status.more_would_bring)},
                {"eta_s", number(status.eta_s)},
                {"verdict", verdict_name(status.verdict)},
                {"controller_connected", status.controller.connected},
                {"controller_powered", value_or_null(status.controller.powered)},
                {"controller_mode", value_or_null(status.controller.mode)},
                {"controller_estop", value_or_null(status.controller.emergency_stop)},
                {"controller_cell_closed", value_or_null(status.controller.cell_closed)},
                {"controller_touch_tested", value_or_null(status.controller.touch_tested)},
                {"controller_permit", value_or_null(status.controller.permit)},
                {"probe", value_or_null(status.controller.probe)}};
  add_by_hand(document, status.by_hand);
  const FaultEntry* entry = status.fault ? &describe(status.fault->code) : nullptr;
  document["fault_code"] = entry ? Json(entry->name) : Json(nullptr);
  document["fault_message"] = entry ? Json(status.fault->message()) : Json(nullptr);
  document["fault_robot_action"] = entry ? Json(entry->robot_action) : Json(nullptr);
  document["fault_next_step"] = entry ? Json(entry->next_step) : Json(nullptr);
  document["warning_code"] = status.warning ? Json(describe(status.warning->code).name) : Json(nullptr);
  document["warning_message"] = status.warning ? Json(status.warning->message()) : Json(nullptr);
  document["reference_drift_mm"] = number_mm(status.reference_drift_m);
  document["last_accepted_run_id"] = id_or_null(status.last_accepted_run_id);
  document["last_accepted_at"] = value_or_null(status.last_accepted_at);
  document["data_age_ms"] = value_or_null(status.data_age_ms);
  document["sequence"] = status.sequence;
  document["instance_id"] = status.instance_id;
  document["since"] = status.since;
  return text_of(document);
}

std::string run_document(const StoredRun& run) {
  Json document = run_json(run);
  document["conditions"] = run.trace_json ? Json::parse(*run.trace_json) : Json(nullptr);
  return text_of(document);
}

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

}  // namespace cell
