#pragma once

#include <optional>
#include <span>
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
enum class Command { kStart, kPause, kResume, kStop, kAbort, kClear, kReset, kAcknowledge };

/// What happens inside: the acting state is done, or something went wrong that a person can mend on the spot
/// (hold) or that ends the run (abort), or nobody made the cell ready in time (a start ends, a run on hold
/// stays there).
enum class Event { kDone, kHoldFault, kAbortFault, kNotReadyFault, kLinkDown };

std::string_view state_name(State state);        // "EXECUTE"
std::string_view command_name(Command command);  // "pause"

/// The state a command leads to; nothing when the state does not allow it. Repeating a command whose effect
/// is under way or reached gives the state itself. Stop is always allowed.
std::optional<State> after_command(State state, Command command);

/// The state an event leads to.
State after_event(State state, Event event);

/// Commands that lead out of a state: none is a dead end.
std::vector<Command> exits(State state);

/// A run is under way: the arm may move, and no other run may start.
bool is_active(State state);

}  // namespace cell
