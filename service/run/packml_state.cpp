#include "service/run/packml_state.hpp"

namespace cell {
namespace {

std::optional<State> after_pause(State state) {
  switch (state) {
    case State::kExecute:
    case State::kUnholding:
    case State::kSuspending:
    case State::kSuspended:
    case State::kUnsuspending:
      return State::kHolding;
    case State::kHolding:
    case State::kHeld:
      return state;
    case State::kStopped:
    case State::kResetting:
    case State::kIdle:
    case State::kStarting:
    case State::kCompleting:
    case State::kComplete:
    case State::kStopping:
    case State::kAborting:
    case State::kAborted:
    case State::kClearing:
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<State> after_resume(State state) {
  switch (state) {
    case State::kHeld:
      return State::kUnholding;
    case State::kSuspended:
      return State::kUnsuspending;
    case State::kUnholding:
    case State::kUnsuspending:
    case State::kExecute:
      return state;
    case State::kStopped:
    case State::kResetting:
    case State::kIdle:
    case State::kStarting:
    case State::kCompleting:
    case State::kComplete:
    case State::kHolding:
    case State::kSuspending:
    case State::kStopping:
    case State::kAborting:
    case State::kAborted:
    case State::kClearing:
      return std::nullopt;
  }
  return std::nullopt;
}

/// Retry and skip concern the touch that holds the run; a run that continues has none, so it refuses both.
std::optional<State> after_retry_or_skip(State state) {
  if (state == State::kHeld) return State::kUnholding;
  return state == State::kUnholding ? std::optional(state) : std::nullopt;
}

bool asks_for_permission(State state) {
  return state == State::kResetting || state == State::kStarting || state == State::kUnholding ||
         state == State::kUnsuspending;
}

State after_stop(State state) {
  switch (state) {
    case State::kStopped:
    case State::kStopping:
    case State::kAborting:
    case State::kAborted:
    case State::kClearing:
      return state;  // nothing moves, or the stop is under way
    case State::kIdle:
    case State::kComplete:
    case State::kResetting:
      return State::kStopped;
    case State::kStarting:
    case State::kExecute:
    case State::kCompleting:
    case State::kHolding:
    case State::kHeld:
    case State::kUnholding:
    case State::kSuspending:
    case State::kSuspended:
    case State::kUnsuspending:
      return State::kStopping;
  }
  return state;
}

/// States in which a person may jog the arm and touch the block.
bool can_locate(State state) {
  return state == State::kStopped || state == State::kResetting || state == State::kIdle ||
         state == State::kComplete;
}

State after_abort(State state) { return is_active(state) ? State::kAborting : state; }

/// Has touches to lose, and no end is under way.
bool can_be_held(State state) {
  return is_active(state) && state != State::kStopping && state != State::kAborting;
}

State after_hold_fault(State state) {
  return can_be_held(state) && state != State::kHeld ? State::kHolding : state;
}

State after_lost_link(State state) {
  if (can_be_held(state)) return after_hold_fault(state);
  if (is_active(state)) return State::kAborting;
  // Nothing moves: reconnecting needs no command.
  return state == State::kIdle ? State::kResetting : state;
}

}  // namespace

std::string_view state_name(State state) {
  switch (state) {
    case State::kStopped:
      return "STOPPED";
    case State::kResetting:
      return "RESETTING";
    case State::kIdle:
      return "IDLE";
    case State::kStarting:
      return "STARTING";
    case State::kExecute:
      return "EXECUTE";
    case State::kCompleting:
      return "COMPLETING";
    case State::kComplete:
      return "COMPLETE";
    case State::kHolding:
      return "HOLDING";
    case State::kHeld:
      return "HELD";
    case State::kUnholding:
      return "UNHOLDING";
    case State::kSuspending:
      return "SUSPENDING";
    case State::kSuspended:
      return "SUSPENDED";
    case State::kUnsuspending:
      return "UNSUSPENDING";
    case State::kStopping:
      return "STOPPING";
    case State::kAborting:
      return "ABORTING";
    case State::kAborted:
      return "ABORTED";
    case State::kClearing:
      return "CLEARING";
  }
  return "";
}

std::string_view command_name(Command command) {
  switch (command) {
    case Command::kStart:
      return "start";
    case Command::kPause:
      return "pause";
    case Command::kResume:
      return "resume";
    case Command::kRetry:
      return "retry";
    case Command::kSkip:
      return "skip";
    case Command::kTake:
      return "take";
    case Command::kUndo:
      return "undo";
    case Command::kConfirm:
      return "confirm";
    case Command::kTouchTest:
      return "touch-test";
    case Command::kLocate:
      return "locate";
    case Command::kStop:
      return "stop";
    case Command::kAbort:
      return "abort";
    case Command::kClear:
      return "clear";
    case Command::kReset:
      return "reset";
    case Command::kAcknowledge:
      return "acknowledge";
  }
  return "";
}

std::optional<State> after_command(State state, Command command) {
  switch (command) {
    case Command::kStart:
      return state == State::kIdle || state == State::kComplete ? std::optional(State::kStarting)
                                                                : std::nullopt;
    case Command::kPause:
      return after_pause(state);
    case Command::kResume:
      return after_resume(state);
    case Command::kRetry:
    case Command::kSkip:
      return after_retry_or_skip(state);
    case Command::kTake:
    case Command::kUndo:
      return state == State::kExecute || can_locate(state) ? std::optional(state) : std::nullopt;
    case Command::kLocate:
      return can_locate(state) ? std::optional(state) : std::nullopt;
    case Command::kConfirm:
      return asks_for_permission(state) ? std::optional(state) : std::nullopt;
    case Command::kStop:
      return after_stop(state);
    case Command::kAbort:
      return after_abort(state);
    case Command::kClear:
      if (state == State::kAborted) return State::kClearing;
      return state == State::kClearing ? std::optional(state) : std::nullopt;
    case Command::kReset:
      if (state == State::kStopped || state == State::kComplete) return State::kResetting;
      return state == State::kResetting || state == State::kIdle ? std::optional(state) : std::nullopt;
    case Command::kTouchTest:
    case Command::kAcknowledge:
      return state;
  }
  return std::nullopt;
}

State after_event(State state, Event event) {
  // The way back from a face moves the arm in RESETTING.
  if (event == Event::kAbortFault)
    return is_active(state) || state == State::kResetting ? State::kAborting : state;
  if (event == Event::kNotReadyFault) {
    if (state == State::kResetting) return State::kStopped;
    if (state == State::kUnholding || state == State::kUnsuspending) return State::kHolding;
    return state == State::kStarting ? State::kStopping : state;
  }
  if (event == Event::kHoldFault) return after_hold_fault(state);
  if (event == Event::kSuspendFault) return state == State::kExecute ? State::kSuspending : state;
  if (event == Event::kLinkDown) return after_lost_link(state);
  switch (state) {
    case State::kResetting:
      return State::kIdle;
    case State::kStarting:
    case State::kUnholding:
    case State::kUnsuspending:
      return State::kExecute;
    case State::kExecute:
      return State::kCompleting;
    case State::kCompleting:
      return State::kComplete;
    case State::kHolding:
      return State::kHeld;
    case State::kSuspending:
      return State::kSuspended;
    case State::kSuspended:
      return State::kUnsuspending;
    case State::kStopping:
      return State::kStopped;
    case State::kAborting:
      return State::kAborted;
    case State::kClearing:
      return State::kStopped;
    case State::kStopped:
    case State::kIdle:
    case State::kComplete:
    case State::kHeld:
    case State::kAborted:
      break;  // they wait for a command
  }
  return state;
}

std::vector<Command> exits(State state) {
  std::vector<Command> commands;
  for (const Command command : kCommands) {
    const auto next = after_command(state, command);
    if (next && *next != state) commands.push_back(command);
  }
  // What ends by itself and nothing shortens: a stop is sent to the controller all the same.
  if (commands.empty()) commands.push_back(Command::kStop);
  return commands;
}

bool is_active(State state) {
  switch (state) {
    case State::kStopped:
    case State::kResetting:
    case State::kIdle:
    case State::kComplete:
    case State::kAborted:
    case State::kClearing:
      return false;
    case State::kStarting:
    case State::kExecute:
    case State::kCompleting:
    case State::kHolding:
    case State::kHeld:
    case State::kUnholding:
    case State::kSuspending:
    case State::kSuspended:
    case State::kUnsuspending:
    case State::kStopping:
    case State::kAborting:
      return true;
  }
  return false;
}

bool has_ended(State state) { return state == State::kStopped || state == State::kAborted; }

bool stands_still(State state) {
  return state == State::kHolding || state == State::kHeld || state == State::kSuspending ||
         state == State::kSuspended;
}

bool is_going_on(State state) { return state == State::kUnholding || state == State::kUnsuspending; }

}  // namespace cell
