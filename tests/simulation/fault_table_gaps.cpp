#include "tests/simulation/fault_table_document.hpp"

namespace simulation {

const std::map<std::string, std::string>& codes_without_cell() {
  static const std::map<std::string, std::string> reasons{
      {"arm_moved",
       "the arm is only jogged where that takes the permit, and the run then goes on with a way back: "
       "`tests/service/acquisition/touch_executor_test`"},
      {"block_moved",
       "the block here stands where it was located: `tests/service/acquisition/place_check_test`"},
      {"block_to_move", "the recipe here has one place: `tests/service/acquisition/block_move_test`"},
      {"computation_slow",
       "computations take no time here: `tests/service/acquisition/run_computation_test`"},
      {"early_contact", "takes an obstacle before a face: `tests/service/acquisition/touch_judgement_test`"},
      {"emergency_stop",
       "refuses a start in a cell that is not ready, which nobody gives here: "
       "`tests/service/acquisition/preconditions_test`"},
      {"face_bias",
       "takes more touches of a face than a run here has: `tests/service/acquisition/touch_judgement_test`"},
      {"false_triggers_many",
       "takes three false triggers in one run, and a cell has one mode: "
       "`tests/service/acquisition/touch_executor_test`"},
      {"fault_unacknowledged",
       "refuses a start below a fault; the person here does first what it asks for: "
       "`tests/service/acquisition/preconditions_test`"},
      {"first_touch_biased",
       "runs here touch no reference place: `tests/service/acquisition/reference_monitor_test`"},
      {"hold",
       "refuses a start in a cell that is not ready, which nobody gives here: "
       "`tests/service/acquisition/preconditions_test`"},
      {"internal_error", "no cell makes the daemon err: `tests/service/acquisition/cell_operation_test`"},
      {"monitor_speed",
       "refuses a start in a cell that is not ready, which nobody gives here: "
       "`tests/service/acquisition/preconditions_test`"},
      {"no_contact",
       "a probe that never trips ends in a collision here, as the block is there: "
       "`tests/end_to_end/cell_faults_test`"},
      {"no_safe_way",
       "the arm never stands here where no way leads on: `tests/service/acquisition/touch_executor_test`"},
      {"not_calibrated",
       "refuses a start in a cell that is not ready, which nobody gives here: "
       "`tests/service/acquisition/preconditions_test`"},
      {"not_identifiable", "the recipe here determines its parameters"},
      {"not_powered",
       "refuses a start in a cell that is not ready, which nobody gives here: "
       "`tests/service/acquisition/preconditions_test`"},
      {"not_ready",
       "told when nobody makes the cell ready for ten minutes; a cell counts as at rest before, and shows "
       "what it asks for"},
      {"not_remote",
       "refuses a start in a cell that is not ready, which nobody gives here: "
       "`tests/service/acquisition/preconditions_test`"},
      {"overtravel",
       "the search speed here lets the arm stop in time: `tests/service/acquisition/touch_judgement_test`"},
      {"plan_invalid",
       "plans are handed in here, and none is without length: "
       "`tests/service/acquisition/touch_judgement_test`"},
      {"probe_not_calibrated",
       "of the probe's file, which no cell here changes: `tests/service/acquisition/preconditions_test`"},
      {"probe_touched",
       "refuses a start in a cell that is not ready, which nobody gives here: "
       "`tests/service/acquisition/preconditions_test`"},
      {"recipe_unreachable", "plans are handed in here: `tests/service/acquisition/preconditions_test`"},
      {"reference_drift",
       "runs here touch no reference place: `tests/service/acquisition/reference_monitor_test`"},
      {"retries_worse",
       "takes three contacts of a touch far apart: `tests/service/acquisition/touch_judgement_test`"},
      {"state_missing", "the link counts as lost before: `tests/service/acquisition/permission_watch_test`"},
      {"task_error",
       "refuses a start in a cell that is not ready, which nobody gives here: "
       "`tests/service/acquisition/preconditions_test`"},
      {"touch_deadline",
       "a touch here ends long before its deadline: "
       "`tests/service/acquisition/touch_executor_answers_test`"},
      {"touch_does_not_fit",
       "takes a contact elsewhere that is plausible: `tests/service/acquisition/outlier_retest_test`"},
      {"touch_outlier",
       "takes a contact elsewhere that is plausible: `tests/service/acquisition/touch_executor_at_end_test`"},
      {"touch_spread",
       "takes two contacts of a touch far apart: `tests/service/acquisition/touch_judgement_test`"},
      {"touch_test_missing",
       "told when nobody tests the stylus for ten minutes; a cell counts as at rest before, and shows what "
       "it asks for"},
      {"wrong_stylus",
       "the stylus here is that of its file: `tests/service/acquisition/touch_judgement_test`"}};
  return reasons;
}

const std::map<std::string, std::string>& modes_without_row() {
  static const std::map<std::string, std::string> places{
      {"P04",
       "`tests/service/acquisition/touch_judgement_test`: plans are handed in here, and none is without "
       "length"},
      {"P05", "`tests/service/acquisition/preconditions_test`: a plan that cannot be made starts no run"},
      {"P06",
       "`tests/service/acquisition/preconditions_test`: it is of the probe's file, which no cell here "
       "changes"},
      {"P07",
       "`tests/service/acquisition/touch_judgement_test`: the stylus of every cell here is that of its file"},
      {"P09", "`tests/service/acquisition/preconditions_test`, `tests/page/browser/faults_test`"},
      {"P17", "`tests/sim_controller/motion_task_test`, `tests/service/acquisition/touch_judgement_test`"},
      {"P27", "`tests/service/acquisition/touch_judgement_test`"},
      {"P28", "`tests/service/acquisition/reference_monitor_test`: runs here touch no reference place"},
      {"P29", "`tests/service/acquisition/touch_judgement_test`"},
      {"P31",
       "`tests/service/acquisition/outlier_retest_test`, "
       "`tests/service/acquisition/touch_executor_at_end_test`"},
      {"P32", "`tests/service/acquisition/reference_monitor_test`: runs here touch no reference place"},
      {"P33",
       "`tests/service/acquisition/touch_judgement_test`: it takes more touches of a face than a run here "
       "has"},
      {"P34",
       "`tests/service/acquisition/touch_executor_test`: it takes three false triggers in one run, and a "
       "cell here has one mode"},
      {"P42", "`tests/page/browser/faults_test`: what stays on the page"}};
  return places;
}

}  // namespace simulation
