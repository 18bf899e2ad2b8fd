#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace cell {

/// PackML states (ISA-TR88.00.02); acting states (-ing) end by themselves.
enum class State {
  kStopped,
  kResetting,
  kIdle,
  kStarting,
  kExecute,
  kCompleting,
  kComplete,
  kHolding,
  kHeld,
  kUnholding,
  kSuspending,
  kSuspended,
  kUnsuspending,
  kStopping,
  kAborting,
  kAborted,
  kClearing,
};

/// Commands of an operator or of a supervisor system.
enum class Command {
  kStart,
  kPause,
  kResume,
  kRetry,      // repeats the touch that held the run
  kSkip,       // leaves it out; the run stays incomplete
  kTake,       // by hand: records the contact under way
  kUndo,       // by hand: discards the last touch
  kConfirm,    // reports what to confirm at the cell; never replaces the key there
  kTouchTest,  // reports the state of the touch test
  kLocate,     // starts locating the block by touches of a person
  kStop,
  kAbort,
  kClear,
  kReset,
  kAcknowledge,
};
inline constexpr std::array kCommands{
    Command::kStart, Command::kPause, Command::kResume,  Command::kRetry,     Command::kSkip,
    Command::kTake,  Command::kUndo,  Command::kConfirm, Command::kTouchTest, Command::kLocate,
    Command::kStop,  Command::kAbort, Command::kClear,   Command::kReset,     Command::kAcknowledge};

/// Internal events: the acting state is done (kDone, also at the end of a suspension); a fault that a person
/// can remove on the spot (hold), that passes while the arm waits (suspend) or that ends the run (abort); the
/// cell was not made ready in time (a start or a reset ends, a held run stays held); the link is down, which
/// holds a run as a fault does and makes an end that is under way an abort.
enum class Event { kDone, kHoldFault, kSuspendFault, kAbortFault, kNotReadyFault, kLinkDown };

std::string_view state_name(State state);  // "EXECUTE"
/// "pause", "touch-test": as in the API's path and on the command line.
std::string_view command_name(Command command);

/// The state that a command leads to; nothing if the state does not allow it. Repeating a command whose
/// effect is under way or reached gives the state itself. Stop is always allowed.
std::optional<State> after_command(State state, Command command);

/// The state an event leads to.
State after_event(State state, Event event);

/// Commands that lead out of a state; stop in one that only ends by itself. Each is a route of the API: start
/// is POST /runs.
std::vector<Command> exits(State state);

/// True during a run: the arm may move, and no other run may start.
bool is_active(State state);

/// True where a run that was stopped or aborted is over, and with its end waits for a person.
bool has_ended(State state);

/// True where a run stands still or is about to, and may go on.
bool stands_still(State state);

/// True where a run that stood still is about to go on.
bool is_going_on(State state);

}  // namespace cell
