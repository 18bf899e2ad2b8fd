#pragma once

#include <span>
#include <string>
#include <vector>

#include "service/run/packml_state.hpp"
#include "tests/simulation/chance.hpp"

namespace simulation {

enum class FaultKind {
  kController,      // what the simulated controller, its probe and its people do by a line of config/FILES.md
  kLinkCut,         // both sides are told
  kLinkHalfOpen,    // nobody is told
  kLinkHeldUp,      // what is under way comes so much later
  kLinkInPieces,    // for a time
  kLinkRefuses,     // for a time nobody listens
  kLinkSwallows,    // for a time a connection gets no answer
  kDiskFull,        // for a time, as those that follow
  kDiskWriteFails,  // EIO
  kDiskSyncFails,   // EIO
  kDiskWritesShort,  // half of each write
  kDiskStalls,       // nothing comes back
  kClockJumps,       // the clock of the day, by `lasts`, back or forth
  kKilled,           // kill -9, at once
  kKilledAtWrite,    // at the `number`-th write from then on
  kPowerFails,       // at the `number`-th write; what was not synced is there or is not
  kKilledAtStart,    // at once, and the next one at its `number`-th write
  kPowerFailsAtStart,
  kTerminated,          // SIGTERM
  kClientsFlood,        // ten times `number` requests at the HTTP port at once
  kClientRepeatsKey,    // a command with a key: twice at once, and once more behind `lasts`
  kClientsStopReading,  // `number` of them ask for much and read nothing of it
  kCommand,             // somebody gives `command`
};

std::string_view fault_kind_name(FaultKind kind);
/// Of the daemon's machine.
bool takes_power(FaultKind kind);

/// What lasts so long ends when the world's person comes (Scenario::script).
inline constexpr Time kUntilMended = Time::max();

/// What goes wrong, and when. A value: a world of the same seed with fewer of them is another world.
struct DrawnFault {
  Time at{};
  FaultKind kind{};
  std::string line;  // of kController
  int number = 0;
  Time lasts{};
  cell::Command command{};
  std::size_t event = 0;  // its number among those that the seed draws, from 1
};

/// Without a time: for a Script.
DrawnFault of_controller(std::string line);
DrawnFault commanded(cell::Command command);

std::string fault_text(const DrawnFault& fault);

/// Up to six, over the time of a run of so many touches; for every tenth seed none.
std::vector<DrawnFault> draw_faults(std::uint64_t seed, int touch_count);

/// Every line that kController may have.
std::vector<std::string> controller_lines();

}  // namespace simulation
