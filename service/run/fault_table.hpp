#pragma once

#include <span>
#include <string>
#include <string_view>

namespace cell {

/// Every fault of a run or of the controller. The table in fault_table.cpp holds what the operator reads; the
/// API, the command line and the page take it from there.
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
  kStateMissing,
  kInternalError,
  kComputationSlow,
  kStoreSlow,
  kRunResumed,
  kBlockToMove,
};

/// Effect of a fault on the run. A refused command or start changes nothing; a warning is kept with the run,
/// which continues.
enum class FaultKind { kRefused, kWarning, kHeld, kSuspended, kAborted };
std::string_view fault_kind_name(FaultKind kind);  // "held"

struct FaultEntry {
  FaultCode code;
  std::string_view name;          // in the API: "link_lost"
  std::string_view cause;         // what happened
  std::string_view robot_action;  // what the robot did
  std::string_view next_step;     // what to do now
  FaultKind kind = FaultKind::kAborted;
  /// Codes of the known failure modes of probing that this fault covers: "P10"; separated by spaces.
  std::string_view modes = {};
};

std::span<const FaultEntry> fault_table();
const FaultEntry& describe(FaultCode code);

/// A fault that occurred: its code and the details of this occurrence.
struct Fault {
  FaultCode code = FaultCode::kControllerUnreachable;
  std::string detail;

  [[nodiscard]] std::string message() const;  // cause, then detail
};

}  // namespace cell
