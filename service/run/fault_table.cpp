#include "service/run/fault_table.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace cell {
namespace {

constexpr std::array kTable{
    FaultEntry{FaultCode::kControllerNotConnected, "controller_not_connected",
               "there is no link to the controller", "nothing moved",
               "switch the controller on and start its application; the daemon keeps trying",
               FaultKind::kRefused, "P03"},
    FaultEntry{FaultCode::kControllerStateUnknown, "controller_state_unknown",
               "the controller has not reported its state yet", "nothing moved",
               "wait a second and start again", FaultKind::kRefused},
    FaultEntry{FaultCode::kEmergencyStop, "emergency_stop",
               "the emergency stop is active or not acknowledged", "nothing moved",
               "release and acknowledge the emergency stop", FaultKind::kRefused, "P03"},
    FaultEntry{FaultCode::kNotRemote, "not_remote", "the controller is not in remote mode", "nothing moved",
               "turn the controller to remote mode", FaultKind::kRefused, "P03"},
    FaultEntry{FaultCode::kNotPowered, "not_powered", "the arm has no power", "nothing moved",
               "switch the arm's power on", FaultKind::kRefused, "P03"},
    FaultEntry{FaultCode::kHold, "hold", "the pendant holds the arm", "nothing moved",
               "release the hold on the pendant", FaultKind::kRefused, "P03"},
    FaultEntry{FaultCode::kNotCalibrated, "not_calibrated", "the arm does not know its joint zeros",
               "nothing moved", "let the controller find its joint zeros", FaultKind::kRefused, "P03"},
    FaultEntry{FaultCode::kProbeTouched, "probe_touched", "the probe reads touched before anything moved",
               "nothing moved", "free the probe, or check its cable and polarity", FaultKind::kRefused,
               "P01"},
    FaultEntry{FaultCode::kTaskError, "task_error", "a task of the controller's application has ended",
               "nothing moved", "restart the controller's application", FaultKind::kRefused},
    FaultEntry{FaultCode::kMonitorSpeed, "monitor_speed", "the monitor speed is not 100 %", "nothing moved",
               "set the monitor speed to 100 %", FaultKind::kRefused},
    FaultEntry{FaultCode::kProbeNotCalibrated, "probe_not_calibrated",
               "the probe's pre-travel was not measured at the speed of these contacts", "nothing moved",
               "calibrate the probe at the cell's contact speed, or set that speed to the calibrated one",
               FaultKind::kRefused, "P06"},
    FaultEntry{FaultCode::kRunActive, "run_active", "another run is active", "the arm goes on with that run",
               "wait for its end, or touchcal stop or touchcal abort", FaultKind::kRefused, "P08"},
    FaultEntry{FaultCode::kFaultUnacknowledged, "fault_unacknowledged",
               "a fault is still shown that nobody has acknowledged", "nothing moved",
               "read it, remove its cause, then touchcal acknowledge", FaultKind::kRefused, "P09 P42"},
    FaultEntry{FaultCode::kNotInThisState, "not_in_this_state", "the state does not allow this command",
               "the arm goes on as before", "give one of the commands that are named as exits",
               FaultKind::kRefused, "P40"},
    FaultEntry{
        FaultCode::kAnswerMissing, "answer_missing",
        "the controller lives but did not answer a command in time",
        "the link was cut, on which the arm stops by itself",
        "look at the controller's screen, then touchcal resume to go on with the touch that was broken "
        "off, or touchcal stop; in ABORTED touchcal clear, then touchcal reset",
        FaultKind::kHeld, "P23"},
    FaultEntry{FaultCode::kPlanInvalid, "plan_invalid",
               "a touch of the plan has no length, no speed or no number", "nothing moved",
               "correct the cell's speeds and recipe, or the application's limits, then touchcal resume "
               "where a run is "
               "on hold, else touchcal clear, touchcal reset and start a new run",
               FaultKind::kAborted, "P04"},
    FaultEntry{FaultCode::kProbeTriggered, "probe_triggered",
               "the probe reads touched before the touch began",
               "the arm did not start and stands clear of the face",
               "free the stylus and check its cable, then touchcal retry to make this touch again, touchcal "
               "skip to leave it out, or touchcal stop; after a stop touchcal reset, in ABORTED touchcal "
               "clear first",
               FaultKind::kHeld, "P12"},
    FaultEntry{FaultCode::kEarlyContact, "early_contact",
               "the probe triggered where the search had hardly begun",
               "the arm finished the touch and stands clear of the face; nothing was recorded",
               "look for dirt and obstacles before the face, then touchcal retry to make this touch again, "
               "touchcal skip to leave it out, or touchcal stop",
               FaultKind::kHeld, "P11"},
    FaultEntry{FaultCode::kFalseTrigger, "false_trigger",
               "the probe triggered in free air, and again when the touch was repeated",
               "the arm went to the end of the search and retracted; nothing was recorded",
               "check the probe's cable, shield and seat, then touchcal retry to make this touch again, "
               "touchcal skip to leave it out, or touchcal stop",
               FaultKind::kHeld, "P15"},
    FaultEntry{FaultCode::kMonitorSpeedChanged, "monitor_speed_changed",
               "the monitor speed was changed during the run",
               "the arm stands still; where it goes on it makes the touch again",
               "set the monitor speed to 100 %: the run goes on by itself, one on hold by touchcal resume; "
               "touchcal pause keeps it, touchcal stop ends it; after a stop touchcal reset, in ABORTED "
               "touchcal clear first",
               FaultKind::kSuspended, "P19"},
    FaultEntry{FaultCode::kTouchSpread, "touch_spread",
               "the two contacts of a touch lie too far apart, each time it was made",
               "the arm finished the touch and stands clear of the face; nothing was recorded",
               "check that block, stylus and probe are tight, then touchcal retry to make this touch again, "
               "touchcal skip to leave it out, or touchcal stop",
               FaultKind::kHeld, "P27"},
    FaultEntry{FaultCode::kRetriesWorse, "retries_worse", "a touch that was made again is worse than before",
               "the arm finished the touch and stands clear of the face; nothing was recorded",
               "check the fixing of block and probe, then touchcal retry to make this touch again, touchcal "
               "skip to leave it out, or touchcal stop",
               FaultKind::kHeld, "P29"},
    FaultEntry{FaultCode::kRepeatedTouch, "repeated_touch",
               "the controller reports the joints of an earlier touch once more",
               "the arm finished the touch and stands clear of the face; nothing was recorded",
               "restart the controller's application if it happens again; else touchcal retry to make this "
               "touch again, touchcal skip to leave it out, or touchcal stop",
               FaultKind::kHeld, "P35"},
    FaultEntry{FaultCode::kTouchDoesNotFit, "touch_does_not_fit",
               "a touch does not fit the others, and made again it fits neither them nor itself",
               "the arm finished the touch and stands clear of the face",
               "look whether block, stylus and probe are tight, then touchcal retry to make it again, "
               "touchcal skip to leave it out, or touchcal resume to keep it",
               FaultKind::kHeld, "P31"},
    FaultEntry{FaultCode::kReferenceDrift, "reference_drift",
               "the reference place is no longer where it was at the start",
               "the arm finished the touch and stands clear of the face",
               "look whether block and probe are tight and the arm is warm, then touchcal retry to touch it "
               "again, touchcal resume to go on all the same, or touchcal stop",
               FaultKind::kHeld, "P32"},
    FaultEntry{FaultCode::kWrongStylus, "wrong_stylus",
               "the touches contradict the stylus radius of the probe file",
               "the arm finished the touch and stands clear of the face",
               "check which stylus is fitted and its file, then touchcal stop, or touchcal resume to go on "
               "all the same",
               FaultKind::kHeld, "P07"},
    FaultEntry{FaultCode::kProbeBounced, "probe_bounced", "the probe bounced after a contact",
               "the first edge counts, the run goes on", "check the probe when it comes often",
               FaultKind::kWarning, "P14"},
    FaultEntry{FaultCode::kLatchMissing, "latch_missing",
               "a contact was not latched but read in the next cycle", "the touch counts, the run goes on",
               "check the cable of the latch input", FaultKind::kWarning, "P16"},
    FaultEntry{FaultCode::kStoppedInSearch, "stopped_in_search", "a search was stopped",
               "the arm went back along the line of its search", "touchcal reset leads on",
               FaultKind::kWarning, "P21"},
    FaultEntry{FaultCode::kControllerOverruns, "controller_overruns",
               "a task of the controller did not finish in its period", "the touch counts, the run goes on",
               "note the count; end other applications on the controller", FaultKind::kWarning, "P24"},
    FaultEntry{FaultCode::kFirstTouchBiased, "first_touch_biased",
               "the first touch of the run lies apart from its repetition",
               "the arm touches the place once more and goes on with the run",
               "warm the probe up by a few touches before the next run", FaultKind::kWarning, "P28"},
    FaultEntry{FaultCode::kArmMoved, "arm_moved", "the arm does not stand where the touch before left it",
               "the path was planned again from where it is", "keep hands off the pendant during a run",
               FaultKind::kWarning, "P30"},
    FaultEntry{FaultCode::kTouchOutlier, "touch_outlier",
               "a touch does not fit the others, also when it is made again",
               "the arm made the touch again; the first one stays",
               "look at the rejected touches of the result", FaultKind::kWarning},
    FaultEntry{FaultCode::kFaceBias, "face_bias",
               "the touches of one face fit worse than those of the others", "the arm finished the run",
               "clean the face and check its certificate", FaultKind::kWarning, "P33"},
    FaultEntry{FaultCode::kFalseTriggersMany, "false_triggers_many", "false triggers come often",
               "each touch was made again, the run goes on",
               "check battery, window and cable of the probe before the next run", FaultKind::kWarning,
               "P34"},
    FaultEntry{FaultCode::kTouchesLeftOut, "touches_left_out",
               "touches of the plan were left out: the run is incomplete",
               "the arm finished the other touches", "start a new run for a complete result",
               FaultKind::kWarning, "P38"},
    FaultEntry{FaultCode::kControllerUnreachable, "controller_unreachable",
               "the controller cannot be reached", "nothing: there is no link",
               "check that the controller's application runs and that its address is right; the daemon keeps "
               "trying; then touchcal resume where a run is on hold",
               FaultKind::kHeld},
    FaultEntry{FaultCode::kControllerIncompatible, "controller_incompatible",
               "the controller is not the one this cell is made for",
               "nothing: it was refused before any motion",
               "install the matching application or correct the cell file; the daemon keeps trying",
               FaultKind::kRefused},
    FaultEntry{
        FaultCode::kProtocolError, "protocol_error",
        "the controller sent something the protocol does not know",
        "the arm stops by itself when the link is gone; it stands where it was",
        "check what listens at the controller's address and that no other host uses it; the daemon keeps "
        "trying; then touchcal resume where a run is on hold, in ABORTED touchcal clear and touchcal reset",
        FaultKind::kHeld, "P36"},
    FaultEntry{
        FaultCode::kLinkLost, "link_lost", "the link to the controller was lost",
        "the arm stops by itself after the heartbeat time-out and stands where it was",
        "look at cable and controller; the daemon keeps trying; where a run is on hold touchcal resume, to "
        "go on with the touch that was broken off, or touchcal stop; in STOPPED touchcal reset; in ABORTED "
        "touchcal clear, then touchcal reset",
        FaultKind::kHeld, "P22"},
    FaultEntry{FaultCode::kRecipeUnreachable, "recipe_unreachable",
               "the recipe's touches cannot be planned in this cell", "nothing moved",
               "change the place of the block, the tilt limit or the recipe", FaultKind::kAborted, "P05"},
    FaultEntry{FaultCode::kNotReady, "not_ready", "the cell was not made ready in time", "nothing moved",
               "make the cell ready, then touchcal resume where a run is on hold, else touchcal reset and "
               "start a new run",
               FaultKind::kHeld},
    FaultEntry{FaultCode::kTouchTestMissing, "touch_test_missing",
               "nobody touched the stylus by hand since the cell was last open", "nothing moved",
               "touch the stylus by hand in manual mode or with power off, leave and close the cell, then "
               "touchcal resume where a run is on hold, else touchcal reset and start a new run",
               FaultKind::kHeld, "P02"},
    FaultEntry{FaultCode::kCellOpen, "cell_open", "the cell is open", "nothing moved",
               "touch the stylus by hand, leave and close the cell, then touchcal resume where a run is on "
               "hold, else touchcal reset and start a new run",
               FaultKind::kHeld},
    FaultEntry{FaultCode::kNotConfirmed, "not_confirmed", "nobody confirmed at the cell in time",
               "nothing moved",
               "touchcal resume where a run is on hold, else touchcal reset and start a new run; press the "
               "confirmation key at the cell within 30 s of being asked",
               FaultKind::kHeld},
    FaultEntry{FaultCode::kTouchRejected, "touch_rejected", "the controller refused a command",
               "what was refused moved nothing; a command that ran already was stopped",
               "remove the cause at the cell, then touchcal resume to try this touch again, or touchcal "
               "stop; in ABORTED touchcal clear, then touchcal reset",
               FaultKind::kHeld},
    FaultEntry{FaultCode::kNoContact, "no_contact", "the search ended without contact",
               "the arm went to the end of the search and retracted; nothing was recorded",
               "check the block's place and the probe's cable, then touchcal resume to try this touch again, "
               "or touchcal stop",
               FaultKind::kHeld, "P10"},
    FaultEntry{FaultCode::kUnexpectedContact, "unexpected_contact",
               "the probe touched something outside a search", "the arm stopped at once and stands there",
               "jog it clear, look for the obstacle, then touchcal clear, "
               "touchcal reset and start a new run",
               FaultKind::kAborted, "P13"},
    FaultEntry{FaultCode::kProbeStuck, "probe_stuck", "the probe still reads touched after the retract",
               "the arm retracted and stands clear of the face; nothing was recorded",
               "free the stylus, then touchcal resume to try this touch again, or touchcal stop",
               FaultKind::kHeld, "P25"},
    FaultEntry{FaultCode::kProbeFault, "probe_fault",
               "the two inputs of the probe disagree: a cable is cut or shorted",
               "the arm did not start, or stopped at once and stands there; nothing was recorded",
               "repair the probe's cable, connector or interface and touch the stylus by hand, then touchcal "
               "resume where a run is on hold, touchcal clear where it was aborted, touchcal reset and start "
               "a new run",
               FaultKind::kHeld, "P26"},
    FaultEntry{FaultCode::kOvertravel, "overtravel", "the arm stopped too far beyond the trigger",
               "the arm stopped and retracted",
               "check the stylus and lower the search speed, then touchcal clear, "
               "touchcal reset and start a new run",
               FaultKind::kAborted, "P17"},
    FaultEntry{
        FaultCode::kPermissionLost, "permission_lost",
        "power, mode, hold, emergency stop or an opened cell took the permission to move",
        "the arm stopped and stands where it was",
        "restore power, remote mode and the arm's references, release the hold, close the cell, then "
        "touchcal resume to go on with the touch that was broken off or did not begin, or touchcal stop; in "
        "ABORTED touchcal clear, then touchcal reset",
        FaultKind::kHeld, "P20"},
    FaultEntry{FaultCode::kCollision, "collision", "the arm collided with something",
               "the drives cut out; the arm is where it was",
               "look at arm, probe and block, free the arm by hand, then touchcal clear, touchcal reset and "
               "start a new run"},
    FaultEntry{FaultCode::kMotionError, "motion_error", "the controller could not carry out a motion",
               "the arm stopped and stands where it was",
               "look up the controller's error number, then touchcal clear, "
               "touchcal reset and start a new run"},
    FaultEntry{
        FaultCode::kTaskFailed, "task_failed", "a task of the controller's application ended",
        "the arm stopped and stands where it was",
        "note the error number, stop and start the application at the pendant and jog the arm clear of "
        "the block, then touchcal resume to go on, or touchcal stop; in ABORTED touchcal clear, then "
        "touchcal reset",
        FaultKind::kHeld},
    FaultEntry{
        FaultCode::kTouchDeadline, "touch_deadline", "a touch took longer than its deadline",
        "the arm was stopped and stands where it was",
        "check hold and monitor speed, then touchcal resume to make this touch again, touchcal skip to "
        "leave it out, or touchcal stop; in ABORTED touchcal clear, then touchcal reset",
        FaultKind::kHeld, "P18"},
    FaultEntry{FaultCode::kImplausibleTouch, "implausible_touch",
               "the reported contact cannot belong to the touch that was asked for",
               "the arm stands where it ended the touch or was held in it; nothing was recorded",
               "check that the cell's arm file is the arm's, then touchcal clear, touchcal reset and start a "
               "new run",
               FaultKind::kAborted, "P37"},
    FaultEntry{FaultCode::kNoSafeWay, "no_safe_way",
               "no collision-free path leads from the arm's posture to the next one", "nothing moved",
               "jog the arm clear of the block, best to its park posture, then touchcal resume to go on, "
               "touchcal skip to leave this touch out, or touchcal stop; in ABORTED touchcal clear, then "
               "touchcal reset",
               FaultKind::kHeld},
    FaultEntry{
        FaultCode::kStoreFailed, "store_failed", "the state directory could not be written",
        "the arm finished a touch that was under way, or stands where a stop left it",
        "free disk space, repair the state directory's rights or end the program that has its database "
        "locked, then touchcal resume if the run is on hold; the end of a run that is over is stored by "
        "itself; else touchcal clear and touchcal "
        "reset",
        FaultKind::kHeld, "P39"},
    FaultEntry{FaultCode::kNotIdentifiable, "not_identifiable", "the touches do not determine the parameters",
               "the arm finished its touches",
               "look at the result's message; change the recipe and start a new run", FaultKind::kWarning},
    FaultEntry{
        FaultCode::kDaemonRestarted, "daemon_restarted", "the daemon was restarted during the run",
        "the arm stands where the last daemon's end left it: taken back by it, or stopped when the link went",
        "touchcal resume to go on with the touch after the last one that is stored, or touchcal stop to "
        "end the run as it is; in ABORTED it cannot go on: touchcal clear, then touchcal reset",
        FaultKind::kHeld, "P41"},
    FaultEntry{
        FaultCode::kBlockMoved, "block_moved", "the block is not where it was located",
        "the arm stopped at this touch or retracted from it",
        "touchcal stop, or touchcal clear where the run was aborted, then touchcal reset and touchcal locate "
        "to "
        "find the block again; touchcal resume goes on where the block is sure to stand as it was located",
        FaultKind::kHeld},
    FaultEntry{
        FaultCode::kStateMissing, "state_missing", "the controller does not tell its state any more",
        "the arm was told to stop",
        "look at the controller's screen and at the arm, then touchcal resume to go on, or touchcal stop",
        FaultKind::kHeld},
    FaultEntry{FaultCode::kInternalError, "internal_error", "the daemon met an error of its own",
               "the arm was told to stop and stands where it was",
               "note the message and report it, then touchcal clear, touchcal reset and start a new run"},
    FaultEntry{
        FaultCode::kComputationSlow, "computation_slow", "a computation takes unusually long",
        "the arm ends a touch that is under way, then it stands still",
        "wait: the run goes on by itself and this warning ends with the computation; or touchcal stop, "
        "which stops the arm at once",
        FaultKind::kWarning},
    FaultEntry{
        FaultCode::kStoreSlow, "store_slow", "the disk takes unusually long to store something",
        "the arm ends a touch that is under way, then it stands still until that is stored",
        "look at the disk of the state directory; the run goes on by itself and this warning ends when "
        "it has answered; touchcal stop stops the arm at once",
        FaultKind::kWarning, "P39"},
    FaultEntry{FaultCode::kRunResumed, "run_resumed", "the run went on after it was confirmed anew",
               "the arm went to a safe place and on with the next touch",
               "read what was checked before; nothing else is to be done", FaultKind::kWarning},
    FaultEntry{FaultCode::kBlockToMove, "block_to_move", "the block is to be brought to another place",
               "the arm stands still, in the park posture where it had touched before",
               "bring the block to the place that is named, then touchcal resume; or touchcal stop",
               FaultKind::kHeld},
};

}  // namespace

std::span<const FaultEntry> fault_table() { return kTable; }

std::string_view fault_kind_name(FaultKind kind) {
  switch (kind) {
    case FaultKind::kRefused:
      return "refused";
    case FaultKind::kWarning:
      return "warning";
    case FaultKind::kHeld:
      return "held";
    case FaultKind::kSuspended:
      return "suspended";
    case FaultKind::kAborted:
      return "aborted";
  }
  return "";
}

const FaultEntry& describe(FaultCode code) {
  const auto found = std::ranges::find(kTable, code, &FaultEntry::code);
  if (found == kTable.end()) throw std::logic_error("a fault code without an entry in the table");
  return *found;
}

std::string Fault::message() const {
  const std::string cause(describe(code).cause);
  return detail.empty() ? cause : cause + ": " + detail;
}

}  // namespace cell
