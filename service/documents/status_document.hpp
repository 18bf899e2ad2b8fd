#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/words.hpp"

namespace cell {

/// The fields of a status that change without being a change of it: `sequence` does not count them.
struct LiveFields {
  std::optional<std::int64_t> data_age_ms;
  std::optional<std::int64_t> mqtt_behind;  // these four: no value where the sink is not configured
  std::optional<std::string> mqtt_trouble;  // nor where there is no trouble
  std::optional<std::int64_t> archive_behind;
  std::optional<std::string> archive_trouble;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("data_age_ms", self.data_age_ms);
    fields("mqtt_behind", self.mqtt_behind);
    fields("mqtt_trouble", self.mqtt_trouble);
    fields("archive_behind", self.archive_behind);
    fields("archive_trouble", self.archive_trouble);
  }
};

/// What a supervisor polls. Every field is always there; what is not known is null.
struct StatusDocument {
  State state = State::kStopped;
  std::optional<std::string> waiting_for;
  std::optional<std::string> run_id;
  std::optional<std::string> recipe;
  int touches_done = 0;
  std::optional<int> touches_total;
  std::optional<int> plane;
  std::optional<std::string> block_place;
  std::optional<int> identifiable_count;
  std::optional<double> condition_number;
  std::optional<double> predicted_tip_rms_mm;
  std::optional<std::string> touch_benefit;
  std::optional<double> eta_s;
  Verdict verdict = Verdict::kNone;
  bool controller_connected = false;
  std::optional<bool> controller_powered;
  std::optional<std::string> controller_mode;
  std::optional<bool> controller_estop;
  std::optional<bool> controller_cell_closed;
  std::optional<bool> controller_touch_tested;
  std::optional<std::string> controller_permit;
  std::optional<std::string> probe;
  std::optional<bool> retract_due;
  std::optional<HandActivity> by_hand;
  std::optional<HandStep> by_hand_step;
  std::optional<int> by_hand_plane;
  std::optional<int> by_hand_index;
  std::optional<int> by_hand_total;
  std::optional<std::string> by_hand_words;
  std::optional<std::string> by_hand_problem;
  std::optional<std::vector<double>> by_hand_joints_deg;
  std::optional<std::string> fault_code;
  std::optional<std::string> fault_message;
  std::optional<std::string> fault_robot_action;
  std::optional<std::string> fault_next_step;
  std::optional<std::string> warning_code;
  std::optional<std::string> warning_message;
  std::optional<double> reference_drift_mm;
  std::optional<std::string> last_accepted_run_id;
  std::optional<std::string> last_accepted_at;
  LiveFields live;
  std::uint64_t sequence = 0;
  std::string instance_id;
  std::string since;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("state", self.state);
    fields("waiting_for", self.waiting_for);
    fields("run_id", self.run_id);
    fields("recipe", self.recipe);
    fields("touches_done", self.touches_done);
    fields("touches_total", self.touches_total);
    fields("plane", self.plane);
    fields("block_place", self.block_place);
    fields("identifiable_count", self.identifiable_count);
    fields("condition_number", self.condition_number);
    fields("predicted_tip_rms_mm", self.predicted_tip_rms_mm);
    fields("more_would_bring", self.touch_benefit);
    fields("eta_s", self.eta_s);
    fields("verdict", self.verdict);
    fields("controller_connected", self.controller_connected);
    fields("controller_powered", self.controller_powered);
    fields("controller_mode", self.controller_mode);
    fields("controller_estop", self.controller_estop);
    fields("controller_cell_closed", self.controller_cell_closed);
    fields("controller_touch_tested", self.controller_touch_tested);
    fields("controller_permit", self.controller_permit);
    fields("probe", self.probe);
    fields("retract_due", self.retract_due);
    fields("by_hand", self.by_hand);
    fields("by_hand_step", self.by_hand_step);
    fields("by_hand_plane", self.by_hand_plane);
    fields("by_hand_index", self.by_hand_index);
    fields("by_hand_total", self.by_hand_total);
    fields("by_hand_words", self.by_hand_words);
    fields("by_hand_problem", self.by_hand_problem);
    fields("by_hand_joints_deg", self.by_hand_joints_deg);
    fields("fault_code", self.fault_code);
    fields("fault_message", self.fault_message);
    fields("fault_robot_action", self.fault_robot_action);
    fields("fault_next_step", self.fault_next_step);
    fields("warning_code", self.warning_code);
    fields("warning_message", self.warning_message);
    fields("reference_drift_mm", self.reference_drift_mm);
    fields("last_accepted_run_id", self.last_accepted_run_id);
    fields("last_accepted_at", self.last_accepted_at);
    LiveFields::visit(self.live, fields);
    fields("sequence", self.sequence);
    fields("instance_id", self.instance_id);
    fields("since", self.since);
  }
};

std::string document_text(const StatusDocument& document);

/// The fields as they stand in a status, without braces.
std::string members_text(const LiveFields& fields);

/// DocumentError when the text is no status.
StatusDocument read_status(std::string_view text);

}  // namespace cell
