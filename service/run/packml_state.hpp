#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace cell {

/// PackML's states (ISA-TR88.00.02); those in -ing end by themselves.
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

/// What a person (or a supervisor in a person's name) may ask for.
enum class Command {
  kStart,
  kPause,
  kResume,
  kRetry,      // the touch that held the run is made again
  kSkip,       // it is left out; the run stays incomplete
  kTake,       // by hand: the stylus stands where it should
  kUndo,       // by hand: the last touch was none
  kConfirm,    // tells what to confirm at the cell; never stands in for the key there
  kTouchTest,  // tells how the touch test stands
  kLocate,     // a person begins to touch the block to find where it is
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

/// What happens inside: the acting state is done, or something went wrong that a person can mend on the spot
/// (hold), that passes by itself while the arm waits (suspend; the end of a suspension is kDone) or that ends
/// the run (abort), or nobody made the cell ready in time (a start ends, a run on hold stays there).
enum class Event { kDone, kHoldFault, kSuspendFault, kAbortFault, kNotReadyFault, kLinkDown };

std::string_view state_name(State state);  // "EXECUTE"
/// "pause", "touch-test": as in the API's path and on the command line.
std::string_view command_name(Command command);

/// The state a command leads to; nothing when the state does not allow it. Repeating a command whose effect
/// is under way or reached gives the state itself. Stop is always allowed.
std::optional<State> after_command(State state, Command command);

/// The state an event leads to.
State after_event(State state, Event event);

/// Commands that lead out of a state: none is a dead end. Each is a route of the API: start is POST /runs.
std::vector<Command> exits(State state);

/// A run is under way: the arm may move, and no other run may start.
bool is_active(State state);

}  // namespace cell
