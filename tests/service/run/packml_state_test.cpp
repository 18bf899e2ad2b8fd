#include "service/run/packml_state.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace cell {
namespace {

using enum State;

constexpr std::array kEvents{Event::kDone,       Event::kHoldFault,     Event::kSuspendFault,
                             Event::kAbortFault, Event::kNotReadyFault, Event::kLinkDown};

struct Row {
  State state;
  std::array<std::optional<State>, kCommands.size()> after_command;  // as kCommands
  std::array<State, kEvents.size()> after_event;                     // as kEvents
};

constexpr std::nullopt_t no = std::nullopt;

/// ISA-TR88.00.02's model with the commands this cell has.
// clang-format off
const std::array kTable{
    // state, then what follows on
    //   start, pause, resume, retry, skip, take, undo, confirm,
    //   touch-test, locate, stop, abort, clear, reset, acknowledge
    //  done, hold, suspend, abort, not ready, link down
    Row{kStopped,
        {no, no, no, no, no, kStopped, kStopped, no,
         kStopped, kStopped, kStopped, kStopped, no, kResetting, kStopped},
        {kStopped, kStopped, kStopped, kStopped, kStopped, kStopped}},
    Row{kResetting,
        {no, no, no, no, no, kResetting, kResetting, kResetting,
         kResetting, kResetting, kStopped, kResetting, no, kResetting, kResetting},
        {kIdle, kResetting, kResetting, kAborting, kStopped, kResetting}},
    Row{kIdle,
        {kStarting, no, no, no, no, kIdle, kIdle, no,
         kIdle, kIdle, kStopped, kIdle, no, kIdle, kIdle},
        {kIdle, kIdle, kIdle, kIdle, kIdle, kResetting}},
    Row{kStarting,
        {no, no, no, no, no, no, no, kStarting,
         kStarting, no, kStopping, kAborting, no, no, kStarting},
        {kExecute, kHolding, kStarting, kAborting, kStopping, kHolding}},
    Row{kExecute,
        {no, kHolding, kExecute, no, no, kExecute, kExecute, no,
         kExecute, no, kStopping, kAborting, no, no, kExecute},
        {kCompleting, kHolding, kSuspending, kAborting, kExecute, kHolding}},
    Row{kCompleting,
        {no, no, no, no, no, no, no, no,
         kCompleting, no, kStopping, kAborting, no, no, kCompleting},
        {kComplete, kHolding, kCompleting, kAborting, kCompleting, kHolding}},
    Row{kComplete,
        {kStarting, no, no, no, no, kComplete, kComplete, no,
         kComplete, kComplete, kStopped, kComplete, no, kResetting, kComplete},
        {kComplete, kComplete, kComplete, kComplete, kComplete, kComplete}},
    Row{kHolding,
        {no, kHolding, no, no, no, no, no, no,
         kHolding, no, kStopping, kAborting, no, no, kHolding},
        {kHeld, kHolding, kHolding, kAborting, kHolding, kHolding}},
    Row{kHeld,
        {no, kHeld, kUnholding, kUnholding, kUnholding, no, no, no,
         kHeld, no, kStopping, kAborting, no, no, kHeld},
        {kHeld, kHeld, kHeld, kAborting, kHeld, kHeld}},
    Row{kUnholding,
        {no, kHolding, kUnholding, kUnholding, kUnholding, no, no, kUnholding,
         kUnholding, no, kStopping, kAborting, no, no, kUnholding},
        {kExecute, kHolding, kUnholding, kAborting, kHolding, kHolding}},
    Row{kSuspending,
        {no, kHolding, no, no, no, no, no, no,
         kSuspending, no, kStopping, kAborting, no, no, kSuspending},
        {kSuspended, kHolding, kSuspending, kAborting, kSuspending, kHolding}},
    Row{kSuspended,
        {no, kHolding, kUnsuspending, no, no, no, no, no,
         kSuspended, no, kStopping, kAborting, no, no, kSuspended},
        {kUnsuspending, kHolding, kSuspended, kAborting, kSuspended, kHolding}},
    Row{kUnsuspending,
        {no, kHolding, kUnsuspending, no, no, no, no, kUnsuspending,
         kUnsuspending, no, kStopping, kAborting, no, no, kUnsuspending},
        {kExecute, kHolding, kUnsuspending, kAborting, kHolding, kHolding}},
    Row{kStopping,
        {no, no, no, no, no, no, no, no,
         kStopping, no, kStopping, kAborting, no, no, kStopping},
        {kStopped, kStopping, kStopping, kAborting, kStopping, kAborting}},
    Row{kAborting,
        {no, no, no, no, no, no, no, no,
         kAborting, no, kAborting, kAborting, no, no, kAborting},
        {kAborted, kAborting, kAborting, kAborting, kAborting, kAborting}},
    Row{kAborted,
        {no, no, no, no, no, no, no, no,
         kAborted, no, kAborted, kAborted, kClearing, no, kAborted},
        {kAborted, kAborted, kAborted, kAborted, kAborted, kAborted}},
    Row{kClearing,
        {no, no, no, no, no, no, no, no,
         kClearing, no, kClearing, kClearing, kClearing, no, kClearing},
        {kStopped, kClearing, kClearing, kClearing, kClearing, kClearing}},
};
// clang-format on

/// The arm moves there, or is about to.
bool is_motion(State state) {
  constexpr std::array kMotion{kStarting, kExecute, kCompleting, kUnholding, kUnsuspending};
  return std::ranges::find(kMotion, state) != kMotion.end();
}

std::string text(std::optional<State> state) { return std::string(state ? state_name(*state) : "refused"); }

TEST(StateMachine, EveryStateAnswersEveryCommandAsTheTableSays) {
  for (const Row& row : kTable) {
    for (std::size_t i = 0; i < kCommands.size(); ++i) {
      EXPECT_EQ(text(after_command(row.state, kCommands[i])), text(row.after_command[i]))
          << command_name(kCommands[i]) << " in " << state_name(row.state);
    }
  }
}

TEST(StateMachine, EveryStateTakesEveryEventAsTheTableSays) {
  for (const Row& row : kTable) {
    for (std::size_t i = 0; i < kEvents.size(); ++i) {
      EXPECT_EQ(text(after_event(row.state, kEvents[i])), text(row.after_event[i]))
          << "event " << i << " in " << state_name(row.state);
    }
  }
}

TEST(StateMachine, NamesAreThoseOfPackMlAndTheTableHasThemAll) {
  std::set<std::string> names;
  for (const Row& row : kTable) names.insert(std::string(state_name(row.state)));
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("STOPPED", "RESETTING", "IDLE", "STARTING", "EXECUTE",
                                                     "COMPLETING", "COMPLETE", "HOLDING", "HELD", "UNHOLDING",
                                                     "SUSPENDING", "SUSPENDED", "UNSUSPENDING", "STOPPING",
                                                     "ABORTING", "ABORTED", "CLEARING"));
}

TEST(StateMachine, AValueThatIsNoStateOrCommandHasNoNameAndMovesNothing) {
  const auto no_state = static_cast<State>(99);
  const auto no_command = static_cast<Command>(99);
  EXPECT_EQ(state_name(no_state), "");
  EXPECT_EQ(command_name(no_command), "");
  EXPECT_FALSE(is_active(no_state));
  for (const Command command : {Command::kPause, Command::kResume, Command::kStart, Command::kRetry})
    EXPECT_EQ(after_command(no_state, command), std::nullopt) << command_name(command);
  for (const Command command : {Command::kStop, Command::kAbort})
    EXPECT_EQ(after_command(no_state, command), no_state) << command_name(command);
  for (const Event event : kEvents) EXPECT_EQ(after_event(no_state, event), no_state);
  for (const Row& row : kTable) EXPECT_EQ(after_command(row.state, no_command), std::nullopt);
}

TEST(StateMachine, EveryCommandHasAWordOfItsOwn) {
  std::vector<std::string> words;
  for (const Command command : kCommands) words.emplace_back(command_name(command));
  EXPECT_THAT(words, ::testing::UnorderedElementsAre("start", "pause", "resume", "retry", "skip", "take",
                                                     "undo", "confirm", "touch-test", "locate", "stop",
                                                     "abort", "clear", "reset", "acknowledge"));
}

TEST(StateMachine, EveryStateEndsStandsStillAndGoesOnWhereItsNameSaysSo) {
  const auto all_with = [](bool (*is)(State)) {
    std::set<State> states;
    for (const Row& row : kTable)
      if (is(row.state)) states.insert(row.state);
    return states;
  };
  EXPECT_EQ(all_with(has_ended), (std::set{kStopped, kAborted}));
  EXPECT_EQ(all_with(stands_still), (std::set{kHolding, kHeld, kSuspending, kSuspended}));
  EXPECT_EQ(all_with(is_going_on), (std::set{kUnholding, kUnsuspending}));
}

TEST(StateMachine, StopIsAlwaysTakenAndNeverEndsInMotion) {
  for (const Row& row : kTable) {
    const auto next = after_command(row.state, Command::kStop);
    ASSERT_TRUE(next) << state_name(row.state);
    EXPECT_FALSE(is_motion(*next)) << state_name(row.state);
  }
}

TEST(StateMachine, FromEveryStateCommandsLeadBackToIdle) {
  for (const Row& row : kTable) {
    std::set<State> reached{row.state};
    for (std::size_t before = 0; before != reached.size();) {
      before = reached.size();
      for (const State state : std::set<State>(reached)) {
        reached.insert(after_event(state, Event::kDone));
        for (const Command command : kCommands) {
          if (const auto next = after_command(state, command)) reached.insert(*next);
        }
      }
    }
    EXPECT_TRUE(reached.contains(kIdle)) << state_name(row.state) << " is a dead end";
  }
}

TEST(StateMachine, AStateNamesTheCommandsThatLeadOutAndWhereNoneDoesTheStop) {
  for (const Row& row : kTable) {
    const std::vector<Command> out = exits(row.state);
    if (row.state == kAborting || row.state == kClearing) {
      EXPECT_THAT(out, ::testing::ElementsAre(Command::kStop)) << state_name(row.state);
      continue;
    }
    for (std::size_t i = 0; i < kCommands.size(); ++i) {
      const bool leads_out = row.after_command[i] && *row.after_command[i] != row.state;
      EXPECT_EQ(std::ranges::find(out, kCommands[i]) != out.end(), leads_out)
          << command_name(kCommands[i]) << " in " << state_name(row.state);
    }
    const bool ends_by_itself = after_event(row.state, Event::kDone) != row.state;
    EXPECT_TRUE(ends_by_itself || !out.empty()) << state_name(row.state);
  }
}

TEST(StateMachine, AStandstillIsLeftByGoingOnOrByAnEnd) {
  for (const Row& row : kTable) {
    const State state = row.state;
    const bool may_stand = after_event(state, Event::kDone) != state && is_active(state);
    EXPECT_FALSE(stands_still(state) && !is_active(state)) << state_name(state);
    EXPECT_FALSE(stands_still(state) && is_going_on(state)) << state_name(state);
    EXPECT_FALSE(is_going_on(state) && !may_stand) << state_name(state);
    EXPECT_FALSE(has_ended(state) && is_active(state)) << state_name(state);
    const auto resumed = after_command(state, Command::kResume);
    EXPECT_FALSE(resumed && *resumed != state && !(stands_still(state) && is_going_on(*resumed)))
        << state_name(state);
  }
}

TEST(StateMachine, OnlyCommandsThatAskForItLeadFromRestToMotionAndTheEndOfASuspension) {
  constexpr std::array kAsking{Command::kStart, Command::kResume, Command::kRetry, Command::kSkip};
  for (const Row& row : kTable) {
    if (is_motion(row.state)) continue;
    for (const Command command : kCommands) {
      const auto next = after_command(row.state, command);
      const bool asks_for_motion = std::ranges::find(kAsking, command) != kAsking.end();
      EXPECT_FALSE(next && is_motion(*next) && !asks_for_motion)
          << command_name(command) << " in " << state_name(row.state);
    }
    for (const Event event : kEvents) {
      const bool ends_suspension = row.state == kSuspended && event == Event::kDone;
      EXPECT_EQ(is_motion(after_event(row.state, event)), ends_suspension) << state_name(row.state);
    }
  }
}

TEST(StateMachine, ARepeatedCommandThatWasTakenIsTakenAgainWithoutEffect) {
  for (const Row& row : kTable) {
    for (const Command command : kCommands) {
      const auto once = after_command(row.state, command);
      if (!once || *once == kStarting) continue;  // what starts is repeated by its Idempotency-Key
      EXPECT_EQ(text(after_command(*once, command)), text(once))
          << command_name(command) << " in " << state_name(row.state);
    }
  }
}

TEST(StateMachine, ARunIsActiveExactlyWhereItCanBeAborted) {
  for (const Row& row : kTable) {
    const bool can_be_aborted = after_command(row.state, Command::kAbort) == kAborting;
    EXPECT_EQ(is_active(row.state), can_be_aborted) << state_name(row.state);
    if (is_motion(row.state)) {
      EXPECT_TRUE(is_active(row.state)) << state_name(row.state);
    }
  }
}

}  // namespace
}  // namespace cell
