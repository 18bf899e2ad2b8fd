#pragma once

#include <span>
#include <string>
#include <string_view>

namespace cell {

/// Everything that can go wrong in a run or with the controller. The table in faults.cpp says of each what
/// the operator reads; the API, the command line and (later) the page take it from there.
enum class FaultCode {
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
};

struct FaultEntry {
  FaultCode code;
  std::string_view name;          // in the API: "link_lost"
  std::string_view cause;         // what happened
  std::string_view robot_action;  // what the robot did
  std::string_view next_step;     // what to do now
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
