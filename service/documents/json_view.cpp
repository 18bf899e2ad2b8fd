#include "service/documents/json_view.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/touched_places.hpp"
#include "config/touches_file.hpp"
#include "service/base/json_figures.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/figures.hpp"
#include "service/documents/internal/geometry_json.hpp"
#include "service/documents/run_document.hpp"
#include "service/run/run.hpp"
#include "service/run/run_conditions.hpp"
#include "service/run/run_repeats.hpp"

namespace cell {
namespace {

std::optional<std::string> id_text(const std::optional<std::int64_t>& id) {
  return id ? std::optional(std::to_string(*id)) : std::nullopt;
}

/// Absent before the run is planned.
std::optional<int> count_once_planned(int touches_total) {
  return touches_total > 0 ? std::optional(touches_total) : std::nullopt;
}

RunSummary summary_of(const StoredRun& run) {
  return {.id = std::to_string(run.id),
          .kind = std::string(run_kind_name(run.kind)),
          .of_run = id_text(run.of_run),
          .recipe = run.recipe,
          .touch_mode = std::string(
              touch_mode_name(is_guided(run.conditions_json) ? TouchMode::kGuided : TouchMode::kAutomatic)),
          .outcome = run.outcome,
          .verdict = run.verdict,
          .touches_done = run.touches_done,
          .touches_total = count_once_planned(run.touches_total),
          .started_at = run.started_at,
          .ended_at = run.ended_at,
          .fault_code = run.fault_code,
          .fault_message = run.fault_message};
}

void set_controller(const ControllerView& controller, StatusDocument& document) {
  document.controller_connected = controller.connected;
  document.controller_powered = controller.powered;
  document.controller_mode = controller.mode;
  document.controller_estop = controller.emergency_stop;
  document.controller_cell_closed = controller.cell_closed;
  document.controller_touch_tested = controller.touch_tested;
  document.controller_permit = controller.permit;
  document.probe = controller.probe;
  document.retract_due = controller.retract_due;
}

/// Instructions to a person who touches by hand.
void set_by_hand(const HandGuide& guide, StatusDocument& document) {
  document.by_hand = guide.activity;
  document.by_hand_step = guide.step;
  document.by_hand_plane = guide.plane;
  document.by_hand_index = guide.index;
  document.by_hand_total = guide.total;
  document.by_hand_words = guide.words;
  document.by_hand_problem = guide.problem;
  if (!guide.about_joints) return;
  auto& joints = document.by_hand_joints_deg.emplace();
  for (const double joint : *guide.about_joints) joints.push_back(calib::degrees_from_radians(joint));
}

void set_faults(const Status& status, StatusDocument& document) {
  if (status.fault) {
    const FaultEntry& entry = describe(status.fault->code);
    document.fault_code = entry.name;
    document.fault_message = status.fault->message();
    document.fault_robot_action = entry.robot_action;
    document.fault_next_step = entry.next_step;
  }
  if (!status.warning) return;
  document.warning_code = describe(status.warning->code).name;
  document.warning_message = status.warning->message();
}

std::string_view schema_of(int version) {
  if (version == 1) return kFirstTouchesSchema;
  if (version == 2) return kSecondTouchesSchema;
  return version == 3 ? kThirdTouchesSchema : kTouchesSchema;
}

/// What the third version of a touches document has of a touch; false when nothing is known of it.
bool add_third(const StoredTouch& touch, const std::optional<double>& at_s, Json& entry) {
  if (at_s) entry["at_s"] = *at_s;
  const auto first = first_contact_of(touch);
  if (first) entry["first_joints_deg"] = joints_deg_json(*first);
  if (touch.again) entry["again_joints_deg"] = joints_deg_json(*touch.again);
  return at_s || first || touch.again;
}

/// But for the rounding of units.
bool is_noise_of_cell(const Cell& cell, double noise_um) {
  return std::abs(calib::metres_from_um(noise_um) - cell.touch_noise_m) < calib::kTouchDeviationMinMetres;
}

}  // namespace

StatusDocument status_of(const Status& status) {
  StatusDocument document{.state = status.state,
                          .waiting_for = status.waiting_for,
                          .run_id = id_text(status.run_id),
                          .recipe = status.recipe,
                          .touches_done = status.touches_done,
                          .touches_total = count_once_planned(status.touches_total),
                          .plane = status.plane,
                          .block_place = status.block_place,
                          .identifiable_count = status.identifiable_count,
                          .condition_number = finite(status.condition_number),
                          .predicted_tip_rms_mm = finite_mm(status.predicted_tip_rms_m),
                          .touch_benefit = status.touch_benefit,
                          .eta_s = finite(status.eta_s),
                          .verdict = status.verdict};
  set_controller(status.controller, document);
  if (status.by_hand) set_by_hand(*status.by_hand, document);
  set_faults(status, document);
  document.reference_drift_mm = finite_mm(status.reference_drift_m);
  document.last_accepted_run_id = id_text(status.last_accepted_run_id);
  document.last_accepted_at = status.last_accepted_at;
  document.live = live_fields(status.data_age_ms, status.sinks);
  document.sequence = status.sequence;
  document.instance_id = status.instance_id;
  document.since = status.since;
  return document;
}

LiveFields live_fields(std::optional<std::int64_t> data_age_ms, const std::vector<SinkState>& sinks) {
  LiveFields live{.data_age_ms = data_age_ms};
  for (const SinkState& sink : sinks) {
    if (sink.sink == kMqttSink) {
      live.mqtt_behind = sink.behind;
      live.mqtt_trouble = sink.trouble;
    } else if (sink.sink == kArchiveSink) {
      live.archive_behind = sink.behind;
      live.archive_trouble = sink.trouble;
    }
  }
  return live;
}

std::string status_document(const Status& status) { return document_text(status_of(status)); }

std::string run_document(const StoredRun& run) {
  RunDocument document{summary_of(run), {}, {}};
  if (run.origin)
    document.imported_from = ImportedFrom{.cell = run.origin->cell,
                                          .run_id = std::to_string(run.origin->run_id),
                                          .exported_at = run.origin->exported_at,
                                          .imported_at = run.origin->imported_at,
                                          .sha256 = run.origin->sha256};
  if (run.conditions_json) document.conditions = CarriedJson{*run.conditions_json};
  return document_text(document);
}

std::string runs_document(const RunPage& page) {
  RunsDocument document{.runs = {}, .damaged = {}, .next_before = id_text(page.next_before)};
  std::ranges::transform(page.runs, std::back_inserter(document.runs), summary_of);
  for (const DamagedRun& run : page.damaged) document.damaged.push_back({std::to_string(run.id), run.what});
  return document_text(document);
}

std::string touches_document(const Cell& cell, const std::vector<StoredTouch>& touches,
                             const std::vector<ReferenceTouch>& references,
                             const std::optional<calib::TouchNoise>& qualified, const Recipe* recipe) {
  const TouchTimes times = times_of(touches, references);
  Json list = Json::array();
  int version = 1;  // older programs read it
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const StoredTouch& touch = touches[i];
    Json& entry = list.emplace_back(Json{{"plane", touch.plane},
                                         {"role", word_of(touch.role)},
                                         {"joints_deg", joints_deg_json(touch.joints)}});
    if (touch.noise_um && !is_noise_of_cell(cell, *touch.noise_um)) {
      entry["noise_um"] = *touch.noise_um;
      version = std::max(version, 2);
    }
    if (add_third(touch, times.touches_s[i], entry)) version = 3;
  }
  const std::vector<calib::Touch> places =
      to_touches(references, touches, faces_per_place(cell.block, recipe ? *recipe : Recipe{}));
  Json again = Json::array();
  for (std::size_t i = 0; i < places.size(); ++i) {
    Json& entry = again.emplace_back(
        Json{{"plane", places[i].face + 1}, {"joints_deg", joints_deg_json(references[i].joints)}});
    if (times.references_s.empty()) continue;
    entry["at_s"] = times.references_s[i];
    version = 3;
  }
  if (qualified) version = 4;
  Json document{{"schema", schema_of(version)}, {"arm", cell.arm.name}, {"touches", list}};
  if (!again.empty()) document["reference_touches"] = again;
  if (qualified)
    document["qualification"] = {{"scatter_um", scatter_um_of(*qualified)},
                                 {"degrees_of_freedom", qualified->degrees_of_freedom}};
  return text_of(document);
}

}  // namespace cell
