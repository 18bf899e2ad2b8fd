// What an Operation's commands ask for beside another state.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "service/acquisition/operation.hpp"
#include "service/run/readiness.hpp"

namespace cell {
namespace {

/// A confirmation is a key at the cell; the command says whether it is awaited and what to do.
std::optional<CommandRefusal> refuse_confirm(const Status& status) {
  if (status.waiting_for == awaited_confirmation().name) return std::nullopt;
  if (!status.waiting_for) return CommandRefusal{.detail = "nothing waits for a confirmation now"};
  return CommandRefusal{.detail = fmt::format("before a confirmation comes this: {}",
                                              awaited_instruction(*status.waiting_for))};
}

std::optional<CommandRefusal> refuse_touch_test(const Status& status) {
  if (status.controller.touch_tested.value_or(false)) return std::nullopt;
  if (status.waiting_for == awaited_touch_test().name) return std::nullopt;
  if (!status.controller.connected) return CommandRefusal{.detail = "there is no link to the controller"};
  return CommandRefusal{.detail = fmt::format("the touch test is asked for once a run starts; then {}",
                                              awaited_touch_test().words)};
}

}  // namespace

/// Why a command that the state allows is not taken all the same.
std::optional<CommandRefusal> Operation::objection(Command command) const {
  switch (command) {
    case Command::kRetry:
    case Command::kSkip:
      if (status_.state == State::kUnholding && answer_ != command)
        return CommandRefusal{.detail = fmt::format("the run goes on by {} already", command_name(answer_))};
      if (status_.state == State::kHeld && held_by_ == HeldBy::kNothing)
        return CommandRefusal{.detail = "no touch holds this run; resume goes on with the next one"};
      return std::nullopt;
    case Command::kConfirm:
      return refuse_confirm(status_);
    case Command::kTouchTest:
      return refuse_touch_test(status_);
    case Command::kTake:
      if (hand_watch_ && !passing_) return std::nullopt;
      return CommandRefusal{
          .detail =
              "no touch by hand is awaited: touchcal locate or touchcal run --guided asks for "
              "some"};
    case Command::kUndo:
      return refuse_undo();
    default:
      return std::nullopt;
  }
}

/// What a command changes that was not objected to, before the next state is entered.
void Operation::heed(Command command) {
  const bool settles_fault = command == Command::kAcknowledge || command == Command::kClear ||
                             command == Command::kReset || command == Command::kResume ||
                             command == Command::kRetry || command == Command::kSkip;
  if (settles_fault && status_.fault) {
    status_.fault.reset();
    publish();
  }
  if (command == Command::kStop && locating_ && !passing_) {
    leave_locating();
    publish();
  }
  if (status_.state != State::kHeld) return;
  if (command == Command::kResume || command == Command::kRetry || command == Command::kSkip) {
    answer_ = command;
    settle_hold(command);
    publish();
  }
}

std::vector<Command> Operation::exits() const {
  std::vector<Command> commands = cell::exits(status_.state);
  std::erase_if(commands, [this](Command command) { return objection(command).has_value(); });
  return commands;
}

}  // namespace cell
