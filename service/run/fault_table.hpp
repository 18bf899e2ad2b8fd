#pragma once

#include <span>
#include <string>
#include <string_view>

namespace cell {

/// Everything that can go wrong in a run or with the controller. The table in faults.cpp says of each what
/// the operator reads; the API, the command line and (later) the page take it from there.
enum class FaultCode {
  kControllerNotConnected,
  kControllerStateUnknown,
  kEmergencyStop,
  kNotRemote,
  kNotPowered,
  kHold,
  kNotCalibrated,
  kProbeTouched,
  kTaskError,
  kMonitorSpeed,
  kProbeNotCalibrated,
  kRunActive,
  kFaultUnacknowledged,
  kNotInThisState,
  kAnswerMissing,
  kPlanInvalid,
  kProbeTriggered,
  kEarlyContact,
  kFalseTrigger,
  kMonitorSpeedChanged,
  kTouchSpread,
  kRetriesWorse,
  kRepeatedTouch,
  kTouchDoesNotFit,
  kReferenceDrift,
  kWrongStylus,
  kProbeBounced,
  kLatchMissing,
  kStoppedInSearch,
  kControllerOverruns,
  kFirstTouchBiased,
  kArmMoved,
  kTouchOutlier,
  kFaceBias,
  kFalseTriggersMany,
  kTouchesLeftOut,
  kControllerUnreachable,
  kControllerIncompatible,
  kProtocolError,
  kLinkLost,
  kRecipeUnreachable,
  kNotReady,
  kTouchTestMissing,
  kCellOpen,
  kNotConfirmed,
  kTouchRejected,
  kNoContact,
  kUnexpectedContact,
  kProbeStuck,
  kProbeFault,
  kOvertravel,
  kPermissionLost,
  kCollision,
  kMotionError,
  kTaskFailed,
  kTouchDeadline,
  kImplausibleTouch,
  kNoSafeWay,
  kStoreFailed,
  kNotIdentifiable,
  kDaemonRestarted,
  kBlockMoved,
};

/// What a fault makes of the run. A command or start that is refused changes nothing; a warning lets the run
/// go on and is kept with it.
enum class FaultKind { kRefused, kWarning, kHeld, kSuspended, kAborted };
std::string_view fault_kind_name(FaultKind kind);  // "held"

struct FaultEntry {
  FaultCode code;
  std::string_view name;          // in the API: "link_lost"
  std::string_view cause;         // what happened
  std::string_view robot_action;  // what the robot did
  std::string_view next_step;     // what to do now
  FaultKind kind = FaultKind::kAborted;
  /// Which of the ways in which probing is known to fail this is: "P10"; several with a space between them.
  std::string_view modes = {};
};

std::span<const FaultEntry> fault_table();
const FaultEntry& describe(FaultCode code);

/// A fault that occurred: the table's entry and what was special about this one.
struct Fault {
  FaultCode code = FaultCode::kControllerUnreachable;
  std::string detail;

  [[nodiscard]] std::string message() const;  // cause, then detail
};

}  // namespace cell
