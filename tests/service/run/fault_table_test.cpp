#include "service/run/fault_table.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "service/run/packml_state.hpp"

namespace cell {
namespace {

TEST(Faults, EveryCodeHasOneEntryWithAllItsTexts) {
  for (std::size_t i = 0; i < fault_table().size(); ++i) {
    const FaultEntry& entry = describe(static_cast<FaultCode>(i));
    EXPECT_EQ(entry.code, static_cast<FaultCode>(i));
    EXPECT_FALSE(entry.cause.empty()) << entry.name;
    EXPECT_FALSE(entry.robot_action.empty()) << entry.name;
    EXPECT_FALSE(entry.next_step.empty()) << entry.name;
    EXPECT_FALSE(fault_kind_name(entry.kind).empty()) << entry.name;
  }
}

TEST(Faults, EveryKnownWayInWhichProbingFailsHasAnEntry) {
  constexpr int kKnownWays = 42;
  std::set<std::string> modes;
  for (const FaultEntry& entry : fault_table()) {
    std::istringstream words{std::string(entry.modes)};
    for (std::string mode; words >> mode;) modes.insert(mode);
  }
  for (int i = 1; i <= kKnownWays; ++i) {
    const std::string mode = (i < 10 ? "P0" : "P") + std::to_string(i);
    EXPECT_TRUE(modes.erase(mode) == 1) << mode;
  }
  EXPECT_TRUE(modes.empty()) << *modes.begin();
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
