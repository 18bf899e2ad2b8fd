#pragma once

namespace sim {

/// What can be wrong with the probe, the controller or the confirmation at the cell.
enum class TroubleKind {
  // The probe.
  kStylusSticks,        // from the next trip on it does not seat again
  kStylusStaysTouched,  // reads touched, whatever it does
  kStylusNeverTouches,
  kProbeBounces,  // `number`: each trip opens and closes again so often
  kVibration,     // `seconds`: one pulse of this length; the latch takes none below 0.2 ms
  kLatchLost,     // edges are seen when the input is polled, 4 ms late
  kContactCut,    // the latch input's wire: never touched
  kContactShort,  // ... always touched
  kLoopCut,       // the loop's wire: always open
  kLoopShort,     // ... always closed
  kProbeMended,   // all of the above is over
  // The controller.
  kTaskDies,        // `number`: with this run-time error
  kOverruns,        // `number`: so many periods more were not met
  kMonitorSpeed,    // `number`: percent
  kReferencesLost,  // joint positions are not referenced
  kReferencesFound,
  kMotionError,   // `number`: the running motion ends with this run-time error
  kCollision,     // following error: the power is cut
  kNeverSettles,  // the arm is never said to stand
  kSettles,       // that is over
  kRestarts,      // the application is restarted at the pendant, in a new session
  // The confirmation.
  kConfirmsLate,          // `seconds` from being asked to the pressed key
  kConfirmationKeyStuck,  // pressed, for good
};

struct Trouble {
  TroubleKind kind{};
  int number = 0;
  double seconds = 0.0;  // simulated
};

}  // namespace sim
