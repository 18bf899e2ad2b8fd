#pragma once

namespace cell {

/// Exit codes of all three programs (service/doc/surfaces.md, section 2).
enum ExitCode : int {
  kExitDone = 0,
  kExitLimitsMissed = 1,  // the job ran, its acceptance limits were missed
  kExitUsage = 2,
  kExitBadInput = 3,
  kExitRefused = 4,      // too few touches, unobservable, unreachable
  kExitFailed = 5,       // the controller or the acquisition failed
  kExitUnreachable = 6,  // no daemon
};

}  // namespace cell
