// A disk that lies breaks each world whose power fails later; what else went wrong there has no part in it.
#include "tests/simulation/shrinking.hpp"

#include <gmock/gmock.h>

namespace simulation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using namespace std::chrono_literals;

Scenario with_events_around_power_failure() {
  Scenario scenario{.seed = 1, .touch_count = 8};
  scenario.sabotage = [](Disk& disk) { disk.trouble = DiskTrouble::kSyncLies; };
  scenario.sabotaged_at = 50s;
  scenario.faults = {{.at = 20s, .kind = FaultKind::kLinkHeldUp, .lasts = 300ms},
                     {.at = 40s, .kind = FaultKind::kClockJumps, .lasts = 1h},
                     {.at = 100s, .kind = FaultKind::kPowerFails, .number = 1},
                     {.at = 150s, .kind = FaultKind::kLinkCut},
                     {.at = 160s, .kind = FaultKind::kCommand, .command = cell::Command::kPause}};
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) scenario.faults[i].event = i + 1;
  return scenario;
}

TEST(Shrinking, LeavesTheOneEventThatBreaksTheWorld) {
  const Scenario scenario = with_events_around_power_failure();
  const Outcome broken = run_world(scenario);
  ASSERT_THAT(broken.broken, ElementsAre(StartsWith("answered_touches_are_durable: ")));
  const Shrunk shrunk = shrink(scenario, broken);
  EXPECT_THAT(shrunk.kept, ElementsAre(2u));
  EXPECT_THAT(shrunk.outcome.broken, ElementsAre(StartsWith("answered_touches_are_durable: ")));
  EXPECT_THAT(shrunk.outcome.journal, HasSubstr("the power of the daemon's machine fails"));
  EXPECT_THAT(shrunk.outcome.journal, Not(HasSubstr("link cut")));
  EXPECT_THAT(shrunk.outcome.journal, Not(HasSubstr("clock jumps")));
}

TEST(Shrinking, LeavesNoEventWhereTheWorldIsBrokenWithoutAny) {
  Scenario scenario{.seed = 1};
  scenario.sabotage = [](Disk& disk) { disk.trouble = DiskTrouble::kReadOnly; };  // no daemon starts
  scenario.faults = {{.at = 20s, .kind = FaultKind::kLinkCut}};
  const Outcome broken = run_world(scenario);
  ASSERT_THAT(broken.broken, Not(IsEmpty()));
  EXPECT_THAT(shrink(scenario, broken).kept, IsEmpty());
}

TEST(Shrinking, SaysWhichEventsAreLeftAndHowToRepeatThem) {
  const Scenario scenario = with_events_around_power_failure();
  const std::string report = broken_report(scenario, run_world(scenario));
  EXPECT_THAT(report, HasSubstr("seed 1 breaks answered_touches_are_durable: "));
  EXPECT_THAT(report, HasSubstr("1 of its 5 events are enough"));
  EXPECT_THAT(report, HasSubstr("  event 3 at 100.000 s: power fails at a write (1)\n"));
  EXPECT_THAT(report, HasSubstr("again: touchcal-sim --seed 1 --events 3\n"));
}

}  // namespace
}  // namespace simulation
