// What a run touches beside its plan, and what a person can say to a touch that holds it.
#include <gmock/gmock.h>

#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/stored_touches.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;

class TouchedAgain : public ::testing::Test {
 protected:
  void make_ready(int reference_every) {
    loop_.cell.recipes.at(kShortRecipe).reference_every = reference_every;
    loop_.serve();
    loop_.launch();
    loop_.run_until(State::kIdle);
  }

  void expect_held_by(const std::string& fault) {
    EXPECT_EQ(loop_.status().state, State::kHeld);
    EXPECT_EQ(loop_.fault_name(), fault);
  }

  LoopbackCell loop_;
};

TEST_F(TouchedAgain, TheReferenceIsTouchedAtTheStartOnTheWayAndAtTheEndAndIsNoTouchOfThePlan) {
  make_ready(10);
  const std::int64_t id = loop_.start();
  loop_.run_until_touches(2);
  EXPECT_FALSE(loop_.status().reference_drift_m) << "there is nothing to compare with yet";
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
  std::vector<int> at;
  for (const cell::ReferenceTouch& touch : loop_.store().references(id)) {
    at.push_back(touch.touches_done);
    EXPECT_EQ(touch.drift_mm.has_value(), touch.number > 1);
  }
  EXPECT_THAT(at, ::testing::ElementsAre(1, 10, 20, 30, kShortTouchCount));
  EXPECT_LE(std::abs(loop_.status().reference_drift_m.value()), cell::reference_drift_max_m(loop_.cell));
}

TEST_F(TouchedAgain, AReferenceThatDriftsHoldsTheRunUntilAPersonLetsItGoOn) {
  loop_.cell.acceptance.reference_drift_max_m = 1e-9;  // less than any touch repeats
  make_ready(10);
  const std::int64_t id = loop_.start();
  loop_.run_until_over();
  expect_held_by("reference_drift");
  EXPECT_EQ(loop_.status().touches_done, 1) << "no two contacts there agree";
  EXPECT_TRUE(loop_.store().references(id).empty());
  loop_.command(Command::kResume);
  loop_.run_until_over();
  expect_held_by("reference_drift");
  EXPECT_EQ(loop_.status().touches_done, 10);
  loop_.command(Command::kRetry);
  loop_.run_until_over();
  expect_held_by("reference_drift");
  EXPECT_EQ(loop_.status().touches_done, 10) << "it was touched again";
  EXPECT_EQ(loop_.store().references(id).size(), 3U);
  loop_.command(Command::kResume);
  loop_.run_until_over();
  expect_held_by("reference_drift");
  EXPECT_EQ(loop_.status().touches_done, 20);
  EXPECT_EQ(cell::describe(loop_.status().warning.value().code).name, "reference_drift");
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
  expect_touches_once(loop_, id, 20);
}

TEST_F(TouchedAgain, ATouchThatHoldsTheRunIsMadeAgainByRetry) {
  make_ready(0);
  loop_.inject(R"({"fault":"probe_stuck","touch":5})");
  const std::int64_t id = loop_.start();
  loop_.run_until_over();
  expect_held_by("probe_stuck");
  EXPECT_THAT(loop_.operation().exits(), ::testing::IsSupersetOf({Command::kRetry, Command::kSkip}));
  loop_.inject(R"({"fault":"probe_mended"})");
  loop_.command(Command::kRetry);
  EXPECT_FALSE(loop_.is_refused(Command::kRetry)) << "once more changes nothing";
  EXPECT_TRUE(loop_.is_refused(Command::kSkip)) << "it is being made again";
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
}

TEST_F(TouchedAgain, ARunWithASkippedTouchIsNeverComplete) {
  make_ready(0);
  loop_.inject(R"({"fault":"probe_stuck","touch":5})");
  const std::int64_t id = loop_.start();
  loop_.run_until_over();
  expect_held_by("probe_stuck");
  loop_.inject(R"({"fault":"probe_mended"})");
  loop_.command(Command::kSkip);
  loop_.run_until_over();
  const cell::Status status = loop_.status();
  EXPECT_EQ(status.state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(status.touches_done, kShortTouchCount - 1);
  EXPECT_EQ(status.touches_total, kShortTouchCount);
  EXPECT_EQ(status.verdict, cell::Verdict::kIncomplete);
  EXPECT_EQ(cell::describe(status.warning.value().code).name, "touches_left_out");
  EXPECT_EQ(loop_.store().run(id)->verdict, cell::Verdict::kIncomplete);
  expect_touches_once(loop_, id, kShortTouchCount - 1);
}

TEST_F(TouchedAgain, ARunThatIsHeldByAPersonHasNothingToRetryOrSkip) {
  make_ready(0);
  loop_.start();
  loop_.run_until_touches(2);
  EXPECT_TRUE(loop_.is_refused(Command::kRetry));
  EXPECT_TRUE(loop_.is_refused(Command::kConfirm)) << "nothing waits for it";
  loop_.command(Command::kPause);
  loop_.run_until(State::kHeld);
  EXPECT_TRUE(loop_.is_refused(Command::kRetry));
  EXPECT_TRUE(loop_.is_refused(Command::kSkip));
  EXPECT_THAT(loop_.operation().exits(),
              ::testing::UnorderedElementsAre(Command::kResume, Command::kStop, Command::kAbort));
}

TEST_F(TouchedAgain, AFalseTriggerInFreeAirIsTouchedAgainWithoutAPerson) {
  make_ready(0);
  loop_.inject(R"({"fault":"vibration","touch":5,"ms":1})");
  const std::int64_t id = loop_.start();
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(cell::describe(loop_.status().warning.value().code).name, "false_trigger");
  expect_touches_once(loop_, id, kShortTouchCount);
}

TEST_F(TouchedAgain, AChangedMonitorSpeedSuspendsTheRunUntilItIsBack) {
  make_ready(0);
  loop_.inject(R"({"fault":"monitor_speed","touch":5,"phase":"retract","percent":50})");
  const std::int64_t id = loop_.start();
  loop_.run_until(State::kSuspended);
  EXPECT_EQ(loop_.fault_name(), "monitor_speed_changed");
  expect_touches_once(loop_, id, 5);
  loop_.inject(R"({"fault":"monitor_speed","percent":100})");
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_TRUE(loop_.fault_name().empty());
  expect_touches_once(loop_, id, kShortTouchCount);
}

TEST_F(TouchedAgain, ARunOnHoldFindsItsControllerAgainAndKeepsItsFault) {
  make_ready(0);
  loop_.inject(R"({"fault":"close","touch":5})");
  loop_.start();
  loop_.run_until(State::kHeld);
  EXPECT_FALSE(loop_.status().controller.connected);
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  EXPECT_EQ(loop_.status().state, State::kHeld);
  EXPECT_EQ(loop_.fault_name(), "link_lost") << "until somebody has read it";
}

TEST_F(TouchedAgain, AStopDoesNotWaitForThePlanner) {
  make_ready(0);
  loop_.start();
  EXPECT_EQ(loop_.status().state, State::kStarting);
  loop_.run_until([this](const cell::Status&) { return loop_.operation().is_planning(); });
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
  EXPECT_FALSE(loop_.operation().planned(kShortRecipe)) << "what nobody waits for is given up";
}

}  // namespace
}  // namespace touchcal::testing
