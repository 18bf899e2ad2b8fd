// A host alone never starts an arm: what a run waits for, and that nothing moves before it is there.
#include <gtest/gtest.h>

#include "cs8_protocol/codec.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/relay.hpp"
#include "tests/end_to_end/stored_touches.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;
using cs8::MessageType;

class Permission : public ::testing::Test {
 protected:
  /// A cell whose people do this much by themselves.
  void make_ready(sim::OperatorDuties duties) {
    loop_.serve(loop_.true_plant(), {.controller = {.speed = sim::kSpeedMax, .duties = duties}});
    relay_.emplace(loop_.io(), loop_.port(), [this](const cs8::Message& message) {
      const MessageType type = cs8::type_of(message);
      if (type != MessageType::kHeartbeat && type != MessageType::kState) passed_.push_back(type);
    });
    loop_.launch(relay_->port());
    loop_.run_until(State::kIdle);
  }

  void run_until_waiting_for(const std::string& what) {
    loop_.run_until([&](const cell::Status& status) { return status.waiting_for == what; });
    EXPECT_EQ(loop_.status().state, State::kStarting);
  }

  static bool is_motion(MessageType type) {
    return type == MessageType::kTouch || type == MessageType::kTravel || type == MessageType::kRetract;
  }

  [[nodiscard]] std::ptrdiff_t count(MessageType type) const { return std::ranges::count(passed_, type); }

  /// No motion was asked for on a connection before its Begin.
  void expect_begin_before_motion() const {
    bool begun = false;
    for (const MessageType type : passed_) {
      if (type == MessageType::kHello || type == MessageType::kFinish) begun = false;
      if (type == MessageType::kBegin) begun = true;
      EXPECT_TRUE(begun || !is_motion(type));
    }
  }

  /// The run has ended before any motion, with this fault, and a reset leads on.
  void expect_stopped_without_motion(std::int64_t id, const std::string& fault) {
    loop_.run_until(State::kStopped);
    EXPECT_EQ(loop_.fault_name(), fault);
    EXPECT_FALSE(loop_.status().waiting_for);
    EXPECT_TRUE(std::ranges::none_of(passed_, is_motion));
    EXPECT_EQ(loop_.store().run(id)->outcome, cell::RunOutcome::kStopped);
    expect_touches_once(loop_, id, 0);
    loop_.command(Command::kReset);
    loop_.run_until(State::kIdle);
  }

  LoopbackCell loop_;
  std::optional<Relay> relay_;
  std::vector<MessageType> passed_;
};

TEST_F(Permission, ARunIsBegunConfirmedAndFinished) {
  make_ready({});
  const std::int64_t id = loop_.start();
  run_until_waiting_for("confirmation");
  EXPECT_EQ(loop_.status().controller.touch_tested, true);
  EXPECT_EQ(loop_.status().controller.cell_closed, true);
  loop_.run_until(State::kExecute);
  EXPECT_FALSE(loop_.status().waiting_for);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  loop_.run_until([](const cell::Status& status) { return status.controller.permit == "none"; });
  expect_touches_once(loop_, id, kShortTouchCount);
  expect_begin_before_motion();
  EXPECT_EQ(count(MessageType::kFinish), 1);
}

TEST_F(Permission, WithoutATouchTestTheRunWaitsAndThenStops) {
  loop_.cell.deadlines.ready = std::chrono::milliseconds(300);
  make_ready({.touches_probe = false});
  const std::int64_t id = loop_.start();
  run_until_waiting_for("touch_test");
  expect_stopped_without_motion(id, "touch_test_missing");
}

TEST_F(Permission, WithoutAConfirmationTheRunStops) {
  loop_.cell.deadlines.confirm = std::chrono::milliseconds(1000);
  make_ready({.confirms = false});
  const std::int64_t id = loop_.start();
  run_until_waiting_for("confirmation");
  expect_stopped_without_motion(id, "not_confirmed");
}

TEST_F(Permission, AStopEndsAStartThatIsWaitedFor) {
  make_ready({.confirms = false});
  const std::int64_t id = loop_.start();
  run_until_waiting_for("confirmation");
  loop_.command(Command::kStop);
  expect_stopped_without_motion(id, "");
  EXPECT_GE(count(MessageType::kFinish), 1);
}

TEST_F(Permission, ARunOnHoldGoesOnWithoutAnotherConfirmation) {
  make_ready({});
  const std::int64_t id = loop_.start();
  loop_.run_until_touches(3);
  loop_.command(Command::kPause);
  loop_.run_until(State::kHeld);
  const auto begins = count(MessageType::kBegin);
  loop_.command(Command::kResume);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(count(MessageType::kBegin), begins);
  expect_touches_once(loop_, id, kShortTouchCount);
}

TEST_F(Permission, AfterALostLinkNothingMovesWithoutANewConfirmation) {
  make_ready({});
  const std::int64_t id = loop_.start();
  loop_.run_until_touches(3);
  relay_->pull();
  loop_.run_until(State::kHeld);
  const auto begins = count(MessageType::kBegin);
  loop_.command(Command::kResume);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
  EXPECT_EQ(count(MessageType::kBegin), begins + 1);
  expect_begin_before_motion();
  EXPECT_GE(count(MessageType::kHello), 2);  // at first, behind the loss or the clear
}

}  // namespace
}  // namespace touchcal::testing
