#include "service/faults.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <regex>
#include <set>

#include "service/acquisition/state_machine.hpp"

namespace cell {
namespace {

/// The code declared behind `code`; a new one makes the compiler ask for its place here.
std::optional<FaultCode> next_code(FaultCode code) {
  switch (code) {
    case FaultCode::kControllerUnreachable:
    case FaultCode::kControllerIncompatible:
    case FaultCode::kProtocolError:
    case FaultCode::kLinkLost:
    case FaultCode::kRecipeUnreachable:
    case FaultCode::kNotReady:
    case FaultCode::kTouchTestMissing:
    case FaultCode::kCellOpen:
    case FaultCode::kNotConfirmed:
    case FaultCode::kTouchRejected:
    case FaultCode::kNoContact:
    case FaultCode::kUnexpectedContact:
    case FaultCode::kProbeStuck:
    case FaultCode::kProbeFault:
    case FaultCode::kOvertravel:
    case FaultCode::kPermissionLost:
    case FaultCode::kCollision:
    case FaultCode::kMotionError:
    case FaultCode::kTaskFailed:
    case FaultCode::kTouchDeadline:
    case FaultCode::kImplausibleTouch:
    case FaultCode::kNoSafeWay:
    case FaultCode::kStoreFailed:
    case FaultCode::kNotIdentifiable:
      return static_cast<FaultCode>(static_cast<int>(code) + 1);
    case FaultCode::kDaemonRestarted:
      return std::nullopt;
  }
  return std::nullopt;
}

TEST(Faults, EveryCodeHasOneEntryWithAllItsTexts) {
  std::size_t count = 0;
  for (auto code = std::optional(FaultCode{}); code; code = next_code(*code)) {
    const FaultEntry& entry = describe(*code);
    EXPECT_EQ(entry.code, *code);
    EXPECT_FALSE(entry.cause.empty()) << entry.name;
    EXPECT_FALSE(entry.robot_action.empty()) << entry.name;
    EXPECT_FALSE(entry.next_step.empty()) << entry.name;
    ++count;
  }
  EXPECT_EQ(fault_table().size(), count);
}

TEST(Faults, NamesAreSnakeCaseAndDiffer) {
  std::set<std::string_view> names;
  for (const FaultEntry& entry : fault_table()) {
    EXPECT_THAT(std::string(entry.name), ::testing::MatchesRegex("^[a-z]+(_[a-z]+)*$"));
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name << " is there twice";
  }
}

TEST(Faults, TheNextStepNamesOnlyCommandsThatExist) {
  std::set<std::string> commands;
  for (const Command command : kCommands) commands.insert(std::string(command_name(command)));
  const std::regex named("touchcal ([a-z]+)");
  int seen = 0;
  for (const FaultEntry& entry : fault_table()) {
    const std::string text(entry.next_step);
    for (auto match = std::sregex_iterator(text.begin(), text.end(), named); match != std::sregex_iterator();
         ++match) {
      ++seen;
      EXPECT_TRUE(commands.contains((*match)[1])) << entry.name << ": " << match->str();
    }
  }
  EXPECT_GT(seen, 0);
}

TEST(Faults, AMessageIsTheCauseAndThenWhatWasSpecial) {
  const std::string cause(describe(FaultCode::kLinkLost).cause);
  EXPECT_EQ((Fault{FaultCode::kLinkLost, ""}).message(), cause);
  EXPECT_EQ((Fault{FaultCode::kLinkLost, "reset by peer"}).message(), cause + ": reset by peer");
}

}  // namespace
}  // namespace cell
