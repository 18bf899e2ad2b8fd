// What else may be wrong with a cell: no controller, another one, nothing to touch, no room for the touches.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/stored_touches.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;

/// The cell stands at RESETTING with this fault, and a start is refused with the fault's own words.
void expect_fault_and_refused_start(LoopbackCell& loop, const std::string& fault) {
  loop.run_until([](const cell::Status& status) { return status.fault.has_value(); });
  EXPECT_EQ(loop.status().state, State::kResetting);
  EXPECT_EQ(loop.fault_name(), fault);
  EXPECT_FALSE(loop.status().controller.connected);
  const auto answer = loop.ask_to_start({.recipe = kShortRecipe});
  const auto& refusal = std::get<cell::CommandRefusal>(answer);
  EXPECT_EQ(refusal.kind, cell::CommandRefusal::Kind::kPreconditions);
  ASSERT_EQ(refusal.unmet.size(), 1U);
  EXPECT_EQ(refusal.unmet.front().code, "controller_not_connected");
  EXPECT_EQ(refusal.unmet.front().detail, loop.status().fault->message());
  EXPECT_TRUE(loop.store().runs(10).empty());
}

TEST(CellFaults, AControllerThatIsNotThereIsNamedAndOneThatComesIsTakenByItself) {
  LoopbackCell loop;
  loop.serve();
  loop.stop_serving();  // its port is free again, and nobody's
  loop.launch();
  expect_fault_and_refused_start(loop, "controller_unreachable");
  loop.serve();
  loop.run_until(State::kIdle);
  EXPECT_TRUE(loop.fault_name().empty());
  EXPECT_TRUE(loop.status().controller.connected);
}

TEST(CellFaults, AnotherArmIsRefusedBeforeAnyMotion) {
  LoopbackCell loop;
  loop.serve();
  loop.cell.arm.name = "tx60";
  loop.launch();
  expect_fault_and_refused_start(loop, "controller_incompatible");
}

TEST(CellFaults, OtherJointLimitsAreRefusedBeforeAnyMotion) {
  LoopbackCell loop;
  sim::Plant plant = loop.true_plant();
  plant.joint_ranges.upper[2] -= 0.1;
  loop.serve(std::move(plant), {.controller = {.speed = sim::kSpeedMax}});
  loop.launch();
  expect_fault_and_refused_start(loop, "controller_incompatible");
  EXPECT_NE(loop.status().fault->message().find("joint 3"), std::string::npos);
}

TEST(CellFaults, ABlockOfUnknownTemperatureIsNotCalibratedOn) {
  LoopbackCell loop;
  loop.serve();
  loop.cell.block.temperature_c.reset();
  loop.launch();
  loop.run_until(State::kIdle);
  const auto answer = loop.ask_to_start({.recipe = kShortRecipe});
  const auto& refusal = std::get<cell::CommandRefusal>(answer);
  EXPECT_EQ(refusal.kind, cell::CommandRefusal::Kind::kPreconditions);
  EXPECT_EQ(refusal.unmet.front().code, "temperature_missing");
  EXPECT_TRUE(loop.store().runs(10).empty());
}

TEST(CellFaults, SearchesThatMeetNothingHoldTheRunAndCountNothing) {
  LoopbackCell loop;
  sim::Plant plant = loop.true_plant();
  plant.scene.obstacles.clear();  // somebody took the block away
  loop.serve(std::move(plant), {.controller = {.speed = sim::kSpeedMax}});
  loop.launch();
  loop.run_until(State::kIdle);
  const std::int64_t id = loop.start();
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kHeld);
  EXPECT_EQ(loop.fault_name(), "no_contact");
  loop.command(Command::kAcknowledge);
  EXPECT_EQ(loop.fault_name(), "no_contact") << "why it stands stays to be read";
  loop.command(Command::kResume);
  EXPECT_TRUE(loop.fault_name().empty());
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kHeld);
  EXPECT_EQ(loop.fault_name(), "no_contact") << "tried again";
  loop.command(Command::kStop);
  loop.run_until(State::kStopped);
  EXPECT_EQ(loop.store().run(id)->outcome, cell::RunOutcome::kStopped);
  expect_touches_once(loop, id, 0);
  loop.command(Command::kReset);
  loop.run_until(State::kIdle);
}

/// A store that takes no more: what is written fails as it does on a full disk, until relieve().
class FullDisk {
 public:
  explicit FullDisk(LoopbackCell& loop) : database_(loop.store_file().string(), SQLite::OPEN_READWRITE) {}

  /// From touch `number` on no touch is taken.
  void refuse_touches_from(int number) {
    refuse("touch_refused", "INSERT ON touches", "WHEN NEW.number >= " + std::to_string(number));
  }
  /// Of their plan and of their end; a run that begins is one with its checksum.
  void refuse_changes_of_runs() { refuse("run_refused", "UPDATE OF plan_id, outcome ON runs", ""); }
  void refuse_new_runs() { refuse("new_run_refused", "INSERT ON runs", ""); }

  void relieve() {
    for (const char* name : {"touch_refused", "run_refused", "new_run_refused"}) {
      database_.exec(std::string("DROP TRIGGER IF EXISTS ") + name);
    }
  }

 private:
  void refuse(const std::string& name, const std::string& what, const std::string& when) {
    database_.exec("CREATE TRIGGER " + name + " BEFORE " + what + " " + when +
                   " BEGIN SELECT RAISE(ABORT, 'database or disk is full'); END");
  }

  SQLite::Database database_;
};

class FailingStore : public ::testing::Test {
 protected:
  FailingStore() {
    loop_.serve();
    loop_.launch();
    loop_.run_until(State::kIdle);
  }

  void expect_fault(State state) {
    EXPECT_EQ(loop_.status().state, state);
    EXPECT_EQ(loop_.fault_name(), "store_failed");
    EXPECT_NE(loop_.status().fault->message().find("disk is full"), std::string::npos);
  }

  LoopbackCell loop_{"demo"};  // the cell `edf` is never accepted
  FullDisk disk_{loop_};
};

TEST_F(FailingStore, ATouchThatCannotBeStoredHoldsTheRunAndIsKeptOnceThereIsRoom) {
  for (const int number : {1, 17, kShortTouchCount}) {
    SCOPED_TRACE("touch " + std::to_string(number));
    disk_.refuse_touches_from(number);
    const std::int64_t id = loop_.start();
    loop_.run_until_over();
    expect_fault(State::kHeld);
    EXPECT_EQ(loop_.status().touches_done, number - 1);
    expect_touches_once(loop_, id, number - 1);
    loop_.command(Command::kResume);
    loop_.run_until_over();
    expect_fault(State::kHeld);  // still full
    disk_.relieve();
    loop_.command(Command::kResume);
    loop_.run_until_over();
    EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
    expect_touches_once(loop_, id, kShortTouchCount);
  }
}

TEST_F(FailingStore, ADiskThatStaysFullIsToldAtEveryResetAndLosesNothing) {
  disk_.refuse_touches_from(5);
  const std::int64_t id = loop_.start();
  loop_.run_until_over();
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
  for (int attempt = 0; attempt < 2; ++attempt) {
    loop_.command(Command::kReset);
    loop_.run_until(State::kStopped);
    expect_fault(State::kStopped);
    expect_touches_once(loop_, id, 4);
  }
  disk_.relieve();
  loop_.command(Command::kReset);
  loop_.run_until(State::kIdle);
  expect_touches_once(loop_, id, 5);
}

TEST_F(FailingStore, ARunThatCannotBeWrittenDoesNotBegin) {
  disk_.refuse_new_runs();
  const auto answer = loop_.ask_to_start({.recipe = kShortRecipe});
  const auto* refusal = std::get_if<cell::CommandRefusal>(&answer);
  ASSERT_TRUE(refusal);
  ASSERT_EQ(refusal->unmet.size(), 1u);
  EXPECT_EQ(refusal->unmet[0].code, "store_not_writable");
  EXPECT_EQ(loop_.status().state, State::kIdle);
  EXPECT_EQ(loop_.operation().run(), nullptr);
  disk_.relieve();
  loop_.start();
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
}

TEST_F(FailingStore, APlanThatCannotBeWrittenHoldsTheRunWhichGoesOnOnceThereIsRoom) {
  disk_.refuse_changes_of_runs();
  const std::int64_t id = loop_.start();
  loop_.run_until_over();
  expect_fault(State::kHeld);
  expect_touches_once(loop_, id, 0);
  disk_.relieve();
  loop_.command(Command::kResume);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
}

TEST_F(FailingStore, AnEndThatCannotBeWrittenIsToldAndNotAcceptedUntilItCan) {
  constexpr double kAnything = 1.0;
  loop_.cell.acceptance = {kAnything, kAnything, std::numeric_limits<double>::max()};
  const std::int64_t id = loop_.start();
  loop_.run_until_touches(kShortTouchCount);
  disk_.refuse_changes_of_runs();
  loop_.run_until_over();
  EXPECT_EQ(loop_.fault_name(), "store_failed");
  EXPECT_EQ(loop_.status().verdict, cell::Verdict::kIncomplete);
  EXPECT_NE(loop_.status().last_accepted_run_id, id);
  expect_touches_once(loop_, id, kShortTouchCount);
  EXPECT_THROW(loop_.start(), std::runtime_error) << "nobody has read the fault";
  disk_.relieve();
  loop_.run_until([](const cell::Status& now) { return !now.fault; });
  const auto stored = loop_.operation().store().run(id);
  EXPECT_EQ(stored.value().outcome, cell::RunOutcome::kComplete) << "its end is stored by itself now";
  EXPECT_NE(stored->verdict, cell::Verdict::kIncomplete);
  EXPECT_EQ(loop_.status().verdict, stored->verdict);
  const std::int64_t next = loop_.start();
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().verdict, cell::Verdict::kAccepted);
  EXPECT_EQ(loop_.status().last_accepted_run_id, next);
}

}  // namespace
}  // namespace touchcal::testing
