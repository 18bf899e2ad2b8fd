#include "service/faults.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace cell {
namespace {

constexpr std::array kTable{
    FaultEntry{FaultCode::kControllerUnreachable, "controller_unreachable",
               "the controller cannot be reached", "nothing: there is no link",
               "check that the controller's application runs and that its address is right; the daemon keeps "
               "trying"},
    FaultEntry{FaultCode::kControllerIncompatible, "controller_incompatible",
               "the controller is not the one this cell is made for",
               "nothing: it was refused before any motion",
               "install the matching application or correct the cell file; the daemon keeps trying"},
    FaultEntry{
        FaultCode::kProtocolError, "protocol_error",
        "the controller sent something the protocol does not know",
        "the arm stops by itself when the link is gone; it stands where it was",
        "check what listens at the controller's address and that no other host uses it; after a run touchcal "
        "clear and touchcal reset, else the daemon keeps trying"},
    FaultEntry{FaultCode::kLinkLost, "link_lost", "the link to the controller was lost",
               "the arm stops by itself after the heartbeat time-out and stands where it was",
               "look at cable and controller, then touchcal clear, touchcal reset and start a new run; it "
               "begins with a retract"},
    FaultEntry{FaultCode::kRecipeUnreachable, "recipe_unreachable",
               "the recipe's touches cannot be planned in this cell", "nothing moved",
               "change the place of the block, the tilt limit or the recipe"},
    FaultEntry{FaultCode::kNotReady, "not_ready", "the cell was not made ready in time", "nothing moved",
               "make the cell ready, then touchcal resume where a run is on hold, else touchcal reset and "
               "start a new run"},
    FaultEntry{FaultCode::kTouchTestMissing, "touch_test_missing",
               "nobody touched the stylus by hand since the cell was last open", "nothing moved",
               "touch the stylus by hand in manual mode or with power off, leave and close the cell, then "
               "touchcal resume where a run is on hold, else touchcal reset and start a new run"},
    FaultEntry{FaultCode::kCellOpen, "cell_open", "the cell is open", "nothing moved",
               "touch the stylus by hand, leave and close the cell, then touchcal resume where a run is on "
               "hold, else touchcal reset and start a new run"},
    FaultEntry{FaultCode::kNotConfirmed, "not_confirmed", "nobody confirmed the run at the cell in time",
               "nothing moved",
               "touchcal resume where a run is on hold, else touchcal reset and start a new run; then press "
               "the confirmation key at the cell within 30 s"},
    FaultEntry{FaultCode::kTouchRejected, "touch_rejected", "the controller refused a command",
               "nothing moved",
               "remove the cause at the cell, then touchcal resume to try this touch again, or touchcal "
               "stop; a run that "
               "was aborted is left by touchcal clear and touchcal reset"},
    FaultEntry{FaultCode::kNoContact, "no_contact", "the search ended without contact",
               "the arm went to the end of the search and retracted; nothing was recorded",
               "check the block's place and the probe's cable, then touchcal resume to try this touch again, "
               "or touchcal stop"},
    FaultEntry{FaultCode::kUnexpectedContact, "unexpected_contact",
               "the probe touched something outside a search", "the arm stopped at once and stands there",
               "jog it clear, look for the obstacle, then touchcal clear, "
               "touchcal reset and start a new run"},
    FaultEntry{FaultCode::kProbeStuck, "probe_stuck", "the probe still reads touched after the retract",
               "the arm retracted and stands clear of the face; nothing was recorded",
               "free the stylus, then touchcal resume to try this touch again, or touchcal stop"},
    FaultEntry{FaultCode::kProbeFault, "probe_fault",
               "the two inputs of the probe disagree: a cable is cut or shorted",
               "the arm did not start, or stopped at once and stands there; nothing was recorded",
               "mend the probe's cable, connector or interface and touch the stylus by hand, then touchcal "
               "resume where a run is on hold, touchcal clear where it was aborted, touchcal reset and start "
               "a new run"},
    FaultEntry{FaultCode::kOvertravel, "overtravel", "the arm stopped too far behind the trigger",
               "the arm stopped and retracted",
               "check the stylus and lower the search speed, then touchcal clear, "
               "touchcal reset and start a new run"},
    FaultEntry{FaultCode::kPermissionLost, "permission_lost",
               "power, mode, hold, emergency stop or an opened cell took the permission to move",
               "the arm stopped and stands where it was",
               "restore power and remote mode, close the cell, then touchcal clear, "
               "touchcal reset and start a new run"},
    FaultEntry{FaultCode::kCollision, "collision", "the arm ran into something",
               "the drives cut out; the arm stands where it was",
               "look at arm, probe and block, free the arm by hand, then touchcal clear, touchcal reset and "
               "start a new run"},
    FaultEntry{FaultCode::kMotionError, "motion_error", "the controller could not carry out a motion",
               "the arm stopped and stands where it was",
               "look up the controller's error number, then touchcal clear, "
               "touchcal reset and start a new run"},
    FaultEntry{FaultCode::kTaskFailed, "task_failed", "a task of the controller's application ended",
               "the arm stopped and stands where it was",
               "note the error number, stop and start the application at the pendant, then touchcal clear, "
               "touchcal reset and start a new run"},
    FaultEntry{FaultCode::kTouchDeadline, "touch_deadline", "a touch took longer than its deadline",
               "the arm was stopped and stands where it was",
               "check hold and monitor speed, then touchcal clear, "
               "touchcal reset and start a new run"},
    FaultEntry{FaultCode::kImplausibleTouch, "implausible_touch",
               "the reported contact cannot belong to the touch that was asked for",
               "the arm finished the touch and stands clear of the face; nothing was recorded",
               "check that the cell's arm file is the arm's, then touchcal clear, touchcal reset and start a "
               "new run"},
    FaultEntry{FaultCode::kNoSafeWay, "no_safe_way",
               "no way clear of all obstacles leads from the arm's posture to the next one", "nothing moved",
               "jog the arm to its park posture, then touchcal clear, touchcal reset and start a new run"},
    FaultEntry{FaultCode::kStoreFailed, "store_failed", "a touch could not be stored",
               "the arm finished the touch and stands clear of the face",
               "free disk space or mend the state directory's "
               "rights, then touchcal clear, touchcal reset and start a new run"},
    FaultEntry{FaultCode::kNotIdentifiable, "not_identifiable", "the touches do not determine the parameters",
               "the arm finished its touches",
               "look at the result's message; change the recipe and start a new run"},
    FaultEntry{
        FaultCode::kDaemonRestarted, "daemon_restarted", "the daemon was started anew during the run",
        "the arm stopped by itself when the link was gone and stands where it was",
        "touchcal resume to go on with the touch behind the last one that is stored, or touchcal stop to "
        "end the run as it is"},
};

}  // namespace

std::span<const FaultEntry> fault_table() { return kTable; }

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
