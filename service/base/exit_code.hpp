#pragma once

namespace cell {

/// Exit codes of all three programs.
enum ExitCode : int {
  kExitDone = 0,
  kExitLimitsMissed = 1,  // the job is done, a limit of acceptance is missed
  kExitUsage = 2,
  kExitBadInput = 3,
  kExitRefused = 4,      // too few touches, unobservable, unreachable
  kExitFailed = 5,       // the controller or the acquisition failed
  kExitUnreachable = 6,  // no daemon
};

}  // namespace cell
