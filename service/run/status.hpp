#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/run/fault_table.hpp"
#include "service/run/hand_guide.hpp"
#include "service/run/packml_state.hpp"
#include "service/run/verdict.hpp"
#include "service/store/sink_state.hpp"

namespace cell {

/// What is known of the controller. Absent means unknown, which is never shown as good.
struct ControllerView {
  bool connected = false;
  std::optional<bool> powered;
  std::optional<std::string> mode;
  std::optional<bool> emergency_stop;
  std::optional<bool> cell_closed;
  std::optional<bool> touch_tested;   // the stylus, by hand
  std::optional<std::string> permit;  // "granted": the run was confirmed at the cell
  std::optional<std::string> probe;   // "free", "touched", "fault"
  std::optional<bool> retract_due;    // the arm stands at a face and is taken back before anything else

  bool operator==(const ControllerView&) const = default;
};

/// What a supervisor polls: a value, replaced at each change. `sequence` counts the changes since the start
/// of the daemon, which `instance_id` names.
struct Status {
  State state = State::kStopped;
  std::optional<std::string> waiting_for;  // action of a person at the cell: "touch_test" (readiness.hpp)
  std::optional<std::int64_t> run_id;
  std::optional<std::string> recipe;
  int touches_done = 0;
  int touches_total = 0;
  std::optional<int> plane;  // of the touch under way, from 1
  /// Where the block stands in a run at several places, or where a person is to bring it; nothing in others.
  std::optional<std::string> block_place;
  std::optional<int> identifiable_count;
  std::optional<double> condition_number;
  std::optional<double> predicted_tip_rms_m;  // over the workspace box
  std::optional<std::string> touch_benefit;   // "8 more on plane 5: 0.21 to 0.15 mm"
  std::optional<double> eta_s;
  Verdict verdict = Verdict::kNone;
  ControllerView controller;
  std::optional<HandGuide> by_hand;  // while touches by hand are awaited
  std::optional<Fault> fault;
  std::optional<Fault> warning;  // the newest of the run
  /// Last reference touch minus the first, along the face's normal; absent before the second.
  std::optional<double> reference_drift_m;
  std::optional<std::int64_t> last_accepted_run_id;
  std::optional<std::string> last_accepted_at;
  std::uint64_t sequence = 0;
  std::string instance_id;
  std::string since;  // when the state was entered
  std::optional<std::int64_t>
      data_age_ms;               // since the last message of the controller; not part of `sequence`
  std::vector<SinkState> sinks;  // of the outbox, those that are configured; nor are these
};

}  // namespace cell
