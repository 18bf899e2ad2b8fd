// How a ControllerSession obtains a person's permit, and what ends it.
#include <gmock/gmock.h>

#include "service/acquisition/controller_session.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using namespace std::chrono_literals;

cs8::Permit refused(std::uint32_t run, cs8::RejectReason reason) {
  cs8::Permit permit;
  permit.run = run;
  permit.reason = cs8::PermitReason::kRefused;
  permit.detail = static_cast<std::int32_t>(reason);
  return permit;
}

class ControllerPermitTest : public ::testing::Test, public OwnersBench {};

TEST_F(ControllerPermitTest, APermitIsAskedForAgainOnceTheReasonOfItsRefusalHasChanged) {
  status.enter(State::kStarting);
  int asked = 0;
  controller.on_begin = [&](std::uint32_t run) {
    if (++asked == 1) return refused(run, cs8::RejectReason::kCellOpen);
    cs8::Permit granted;
    granted.run = run;
    granted.state = cs8::PermitState::kGranted;
    return granted;
  };
  std::optional<std::string> awaited;
  wake.on_wait = [&] {
    awaited = status.latest().waiting_for;
    controller.state->flags ^= cs8::kCellClosed;
  };
  EXPECT_TRUE(run(session.obtain_permit(7)));
  EXPECT_EQ(awaited, "cell_closed");
  EXPECT_EQ(status.latest().waiting_for, std::nullopt);
  EXPECT_EQ(wake.wait_count, 1);
  EXPECT_THAT(controller.asked, ElementsAre("begin 7", "begin 7"));
}

TEST_F(ControllerPermitTest, NobodyWhoMakesTheCellReadyInTimeEndsTheStart) {
  status.enter(State::kStarting);
  controller.on_begin = [](std::uint32_t run) { return refused(run, cs8::RejectReason::kCellOpen); };
  EXPECT_FALSE(run(session.obtain_permit(7)));
  EXPECT_THAT(faults, ElementsAre("cell_open"));
  EXPECT_EQ(status.state(), State::kStopping);
  EXPECT_GE(time.since_begin(), cell_of_owners().deadlines.ready);
  EXPECT_LT(time.since_begin(), cell_of_owners().deadlines.ready + 2s);
}

TEST_F(ControllerPermitTest, AHandOnTheStylusThatOneWireOnlyKnowsIsToldAsTheOtherWire) {
  status.enter(State::kStarting);
  controller.state->flags &= ~static_cast<std::uint32_t>(cs8::kTouchTested);
  controller.on_begin = [](std::uint32_t run) { return refused(run, cs8::RejectReason::kTouchTestMissing); };
  std::vector<std::string> awaited;
  wake.on_wait = [&] {
    const std::string now = status.latest().waiting_for.value_or("");
    if (awaited.empty() || awaited.back() != now) awaited.push_back(now);
    controller.state->flags ^= cs8::kProbeLoopClosed;  // the contact's wire is cut
    for (int i = 0; i < 3; ++i) session.on_controller_state(*controller.state);
  };
  EXPECT_FALSE(run(session.obtain_permit(7)));
  EXPECT_THAT(awaited, ElementsAre("touch_test", "probe_inputs"));
  EXPECT_THAT(faults, ElementsAre("probe_fault"));
}

TEST_F(ControllerPermitTest, AWireThatWasMendedLeavesTheTouchTestToBeMade) {
  status.enter(State::kStarting);
  controller.state->flags &= ~static_cast<std::uint32_t>(cs8::kTouchTested);
  controller.on_begin = [](std::uint32_t run) { return refused(run, cs8::RejectReason::kTouchTestMissing); };
  int waits = 0;
  std::optional<std::string> awaited;
  wake.on_wait = [&] {
    awaited = status.latest().waiting_for;
    controller.state->flags ^= cs8::kProbeLoopClosed;
    if (++waits > 4) controller.state->flags ^= cs8::kProbeTouched;  // both wires know of the hand now
    for (int i = 0; i < 3; ++i) session.on_controller_state(*controller.state);
  };
  EXPECT_FALSE(run(session.obtain_permit(7)));
  EXPECT_EQ(awaited, "touch_test");
  EXPECT_THAT(faults, ElementsAre("touch_test_missing"));
}

TEST_F(ControllerPermitTest, APermitOfTheRunBeforeIsNone) {
  status.enter(State::kStarting);
  controller.permit = cs8::Permit{.run = 6, .state = cs8::PermitState::kGranted};
  EXPECT_TRUE(run(session.obtain_permit(7)));
  EXPECT_THAT(controller.asked, ElementsAre("begin 7"));
}

TEST_F(ControllerPermitTest, WhatTookThePermissionIsTold) {
  controller.state->flags &= ~static_cast<std::uint32_t>(cs8::kCellClosed);
  controller.state->permit = cs8::PermitState::kGranted;
  controller.permit = cs8::Permit{.run = 7, .reason = cs8::PermitReason::kPermissionLost};
  const Fault told = session.with_permission_told({FaultCode::kPermissionLost, "in the phase 'search'"});
  EXPECT_EQ(
      told.detail,
      "in the phase 'search'; the controller tells an open cell; the permit ended by 'permission_lost'");
  EXPECT_EQ(session.with_permission_told({FaultCode::kNoContact, "here"}).detail, "here");
}

TEST_F(ControllerPermitTest, WhatStateSaysHoldsARunThatHasItsPermit) {
  status.enter(State::kStarting);
  ASSERT_TRUE(run(session.obtain_permit(7)));
  status.enter(State::kExecute);
  controller.state->permit = cs8::PermitState::kGranted;
  const auto tell_for = [this](std::chrono::milliseconds duration) {
    for (auto passed = 0ms; passed <= duration; passed += 20ms) {
      tell_state();
      time.pass(20ms);
    }
  };
  tell_for(2s);
  EXPECT_EQ(status.state(), State::kExecute);
  controller.asked.clear();
  controller.state->emergency_stop = 2;
  tell_for(PermissionWatch::kAnswerPatience - 40ms);
  EXPECT_EQ(status.state(), State::kExecute) << "the controller's own answer comes first";
  EXPECT_FALSE(session.lost_permission().empty()) << "and a contact is none by now";
  tell_for(40ms);
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(faults, ElementsAre("permission_lost"));
  EXPECT_THAT(status.fault().value().message(), ::testing::HasSubstr("emergency stop"));
  EXPECT_THAT(controller.asked, ElementsAre("stop"));
  tell_state();
  EXPECT_FALSE(session.lost_permission().empty()) << "a contact that is answered now is none either";
  // A permit that State denies is asked for again, whatever the controller said of it before.
  controller.state->emergency_stop = 0;
  status.enter(State::kUnholding);
  controller.asked.clear();
  EXPECT_TRUE(run(session.obtain_permit(7)));
  EXPECT_THAT(controller.asked, ElementsAre("begin 7"));
  EXPECT_TRUE(session.lost_permission().empty());
}

TEST_F(ControllerPermitTest, AControllerThatMissedAnAcknowledgementIsMetAnew) {
  status.enter(State::kUnholding);
  controller.on_begin = [](std::uint32_t run) {
    return refused(run, cs8::RejectReason::kResultUnacknowledged);
  };
  EXPECT_FALSE(run(session.obtain_permit(7)));
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(controller.asked, ElementsAre("begin 7", "close"));
}

TEST_F(ControllerPermitTest, ATaskThatFailedIsToldWithTheNumberThatStateHasOfIt) {
  status.enter(State::kUnholding);
  controller.state->task_error = 60;
  controller.on_begin = [](std::uint32_t run) { return refused(run, cs8::RejectReason::kTaskFailed); };
  EXPECT_FALSE(run(session.obtain_permit(7)));
  EXPECT_THAT(faults, ElementsAre("task_failed"));
  EXPECT_EQ(status.fault().value().detail, "run-time error 60");
}

}  // namespace
}  // namespace cell
