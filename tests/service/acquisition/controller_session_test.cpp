#include "service/acquisition/controller_session.hpp"

#include <gmock/gmock.h>

#include "service/run/touch_command.hpp"
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

class ControllerSessionTest : public ::testing::Test, public OwnersBench {};

TEST_F(ControllerSessionTest, LooksForTheControllerWithGrowingPausesUpToTwoSeconds) {
  controller.is_connected = false;
  status.enter(State::kResetting);
  std::vector<std::chrono::milliseconds> at;
  controller.on_connect = [&]() -> cs8::ConnectReply {
    at.push_back(time.since_begin());
    if (at.size() < 7) return cs8::LinkError{cs8::LinkErrorKind::kUnreachable, "nobody"};
    return cs8::Welcome{};
  };
  EXPECT_EQ(run(session.connect(false)), 0u);
  EXPECT_THAT(at, ElementsAre(0ms, 100ms, 300ms, 700ms, 1500ms, 3100ms, 5100ms));
  EXPECT_THAT(faults, ElementsAre("controller_unreachable")) << "the same fault again is none";
  EXPECT_FALSE(status.fault()) << "it ended with the link";
}

TEST_F(ControllerSessionTest, AnOpenCommandIsToBeSettledAtOnceAlsoWhereARunHasEnded) {
  cs8::Welcome welcome;
  welcome.open_sequence = 9;
  controller.on_connect = [&] { return welcome; };
  status.enter(State::kResetting);
  EXPECT_EQ(run(session.connect(false)), 9u);
  for (const State ended : {State::kAborted, State::kStopped, State::kComplete, State::kHeld}) {
    status.enter(ended);
    EXPECT_EQ(run(session.connect(false)), 9u) << state_name(ended);
  }
  EXPECT_EQ(session.sequence_to_settle(), 9u) << "until it is acknowledged";
  session.acknowledge(9);
  EXPECT_EQ(session.sequence_to_settle(), 0u);
}

TEST_F(ControllerSessionTest, AStateThatChangesEndsTheSearch) {
  controller.is_connected = false;
  controller.on_connect = [] { return cs8::LinkError{cs8::LinkErrorKind::kUnreachable, "nobody"}; };
  status.enter(State::kResetting);
  wake.on_wait = [this] { status.enter(State::kStopped); };
  EXPECT_EQ(run(session.connect(false)), 0u);
  EXPECT_EQ(wake.wait_count, 1);
}

TEST_F(ControllerSessionTest, APermitIsAskedForAgainOnceTheReasonOfItsRefusalHasChanged) {
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

TEST_F(ControllerSessionTest, NobodyWhoMakesTheCellReadyInTimeEndsTheStart) {
  status.enter(State::kStarting);
  controller.on_begin = [](std::uint32_t run) { return refused(run, cs8::RejectReason::kCellOpen); };
  EXPECT_FALSE(run(session.obtain_permit(7)));
  EXPECT_THAT(faults, ElementsAre("cell_open"));
  EXPECT_EQ(status.state(), State::kStopping);
  EXPECT_GE(time.since_begin(), cell_of_owners().deadlines.ready);
  EXPECT_LT(time.since_begin(), cell_of_owners().deadlines.ready + 2s);
}

TEST_F(ControllerSessionTest, APermitOfTheRunBeforeIsNone) {
  status.enter(State::kStarting);
  controller.permit = cs8::Permit{.run = 6, .state = cs8::PermitState::kGranted};
  EXPECT_TRUE(run(session.obtain_permit(7)));
  EXPECT_THAT(controller.asked, ElementsAre("begin 7"));
}

TEST_F(ControllerSessionTest, WhereTheArmStandsIsWhatItsControllerSaysAfterTheQuestion) {
  status.enter(State::kExecute);
  tell_state();  // before: it may have moved since
  calib::JointVector later = calib::JointVector::Zero();
  wake.on_wait = [&] {
    controller.state->joints = to_wire(later);
    tell_state();
  };
  EXPECT_TRUE(run(session.standing_joints()).value().isApprox(later));
}

TEST_F(ControllerSessionTest, ASearchThatWasBrokenOffIsLeftFirst) {
  status.enter(State::kExecute);
  controller.state->flags |= cs8::kRetractDue;
  EXPECT_TRUE(run(session.standing_joints()));
  EXPECT_THAT(controller.asked, ElementsAre("retract 1", "acknowledge 1"));
}

TEST_F(ControllerSessionTest, WhatTookThePermissionIsTold) {
  controller.state->flags &= ~static_cast<std::uint32_t>(cs8::kCellClosed);
  controller.state->permit = cs8::PermitState::kGranted;
  controller.permit = cs8::Permit{.run = 7, .reason = cs8::PermitReason::kPermissionLost};
  const Fault told = session.with_permission_told({FaultCode::kPermissionLost, "in the phase 'search'"});
  EXPECT_EQ(
      told.detail,
      "in the phase 'search'; the controller tells an open cell; the permit ended by 'permission_lost'");
  EXPECT_EQ(session.with_permission_told({FaultCode::kNoContact, "here"}).detail, "here");
}

TEST_F(ControllerSessionTest, AnArmThatStandsAtAFaceIsTold) {
  EXPECT_EQ(session.view({}).retract_due, false);
  controller.state->flags |= cs8::kRetractDue;
  EXPECT_EQ(session.view({}).retract_due, true);
  controller.state->active_sequence = 1;
  EXPECT_EQ(session.view({}).retract_due, false) << "in every touch that goes well";
  controller.is_connected = false;
  EXPECT_EQ(session.view({}).retract_due, std::nullopt);
}

TEST_F(ControllerSessionTest, AnArmThatDoesNotComeToRestAbortsTheRun) {
  status.enter(State::kExecute);
  controller.state->flags &= ~static_cast<std::uint32_t>(cs8::kSettled);
  EXPECT_FALSE(run(session.standing_joints()));
  EXPECT_THAT(faults, ElementsAre("motion_error"));
  EXPECT_GT(time.since_begin(), 10s);
}

TEST_F(ControllerSessionTest, AnArmThatMovesByItselfIsNoLongerWhereItWasLeft) {
  status.enter(State::kExecute);
  session.set_standing(cell_of_owners().park_joints);
  tell_state();
  EXPECT_TRUE(session.standing());
  controller.state->joints[2] += 100'000;  // a tenth of a degree
  tell_state();
  EXPECT_FALSE(session.standing());
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kArmMoved);
}

TEST_F(ControllerSessionTest, StoppingTheCellStopsTheArm) {
  session.on_entered(State::kStopping);
  session.on_entered(State::kAborting);
  session.on_entered(State::kHolding);
  EXPECT_THAT(controller.asked, ElementsAre("stop", "stop"));
}

TEST_F(ControllerSessionTest, AStylusLeavesTheFaceBeforeTheEndUnlessAPersonSaysStop) {
  status.enter(State::kStopping);
  controller.state->flags |= cs8::kRetractDue;
  wake.on_wait = [this] {
    session.stop();
    tell_state();
  };
  run(session.leave_face());
  EXPECT_THAT(controller.asked, ElementsAre("stop"));
  wake.on_wait = [this] { tell_state(); };
  controller.asked.clear();
  run(session.leave_face());
  EXPECT_THAT(controller.asked, ElementsAre("retract 1", "acknowledge 1"));
}

TEST_F(ControllerSessionTest, TheProbesInputsMayChangeOneAfterTheOther) {
  tell_state();
  EXPECT_EQ(session.view("free").probe, "free");
  controller.state->flags |= cs8::kProbeTouched;  // the loop is closed yet
  tell_state();
  EXPECT_EQ(session.view("free").probe, "free");
  tell_state();
  EXPECT_EQ(session.view("free").probe, "fault");
}

TEST_F(ControllerSessionTest, DataIsAsOldAsTheClockThatWasHandedInSays) {
  EXPECT_EQ(session.data_age_ms(), std::nullopt);
  tell_state();
  time.pass(140ms);
  EXPECT_EQ(session.data_age_ms(), 140);
  session.on_heartbeat();
  EXPECT_EQ(session.data_age_ms(), 140) << "only State says how the controller is";
}

TEST_F(ControllerSessionTest, WhatStateSaysHoldsARunThatHasItsPermit) {
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
  // A permit that State denies is asked for again, whatever the controller said of it before.
  controller.state->emergency_stop = 0;
  status.enter(State::kUnholding);
  controller.asked.clear();
  EXPECT_TRUE(run(session.obtain_permit(7)));
  EXPECT_THAT(controller.asked, ElementsAre("begin 7"));
}

TEST_F(ControllerSessionTest, NoStateAtAllHoldsARun) {
  status.enter(State::kStarting);
  ASSERT_TRUE(run(session.obtain_permit(7)));
  status.enter(State::kExecute);
  controller.state->permit = cs8::PermitState::kGranted;
  tell_state();
  for (int i = 1; i < PermissionWatch::kSilentHeartbeatsMax; ++i) session.on_heartbeat();
  EXPECT_EQ(status.state(), State::kExecute);
  session.on_heartbeat();
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(faults, ElementsAre("state_missing"));
}

TEST_F(ControllerSessionTest, WithoutAPermitStateHoldsNothing) {
  status.enter(State::kExecute);  // a guided run: a person jogs the arm, in manual mode
  controller.state->mode = cs8::WorkingMode::kManual;
  for (int i = 0; i < 100; ++i) {
    tell_state();
    session.on_heartbeat();
    time.pass(20ms);
  }
  EXPECT_EQ(status.state(), State::kExecute);
}

TEST_F(ControllerSessionTest, LinksThatDieAtOnceAreTriedWithPausesAndFillNoTable) {
  controller.is_connected = false;
  status.enter(State::kResetting);
  for (int i = 0; i < 20; ++i) {
    run(session.connect(false));
    controller.is_connected = false;
    session.on_link_lost({cs8::LinkErrorKind::kPeerClosed, "the connection ended"}, Event::kLinkDown);
  }
  EXPECT_GT(time.since_begin(), 25s);
  EXPECT_THAT(faults, ElementsAre("link_lost", "link_lost")) << "the first and the tenth";
  EXPECT_THAT(status.fault().value().message(), ::testing::HasSubstr("20 short links"));
}

TEST_F(ControllerSessionTest, WhyARunIsOnHoldStaysWhileTheLinkComesAndGoes) {
  status.enter(State::kExecute);
  session.on_link_lost({cs8::LinkErrorKind::kPeerClosed, "the connection ended"}, Event::kLinkDown);
  EXPECT_EQ(status.state(), State::kHolding);
  status.enter(State::kHeld);
  int tried = 0;
  controller.on_connect = [&]() -> cs8::ConnectReply {
    if (++tried == 1) return cs8::LinkError{cs8::LinkErrorKind::kUnreachable, "nobody"};
    return cs8::Welcome{};
  };
  run(session.connect(false));
  session.on_link_lost({cs8::LinkErrorKind::kSilent, "nothing was heard"}, Event::kLinkDown);
  EXPECT_EQ(status.state(), State::kHeld);
  EXPECT_EQ(status.fault().value().detail, "the connection ended");
  EXPECT_THAT(faults, ElementsAre("link_lost"));
}

TEST_F(ControllerSessionTest, AControllerThatMissedAnAcknowledgementIsMetAnew) {
  status.enter(State::kUnholding);
  controller.on_begin = [](std::uint32_t run) {
    return refused(run, cs8::RejectReason::kResultUnacknowledged);
  };
  EXPECT_FALSE(run(session.obtain_permit(7)));
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(controller.asked, ElementsAre("begin 7", "close"));
}

TEST_F(ControllerSessionTest, ATaskThatFailedIsToldWithTheNumberThatStateHasOfIt) {
  status.enter(State::kUnholding);
  controller.state->task_error = 60;
  controller.on_begin = [](std::uint32_t run) { return refused(run, cs8::RejectReason::kTaskFailed); };
  EXPECT_FALSE(run(session.obtain_permit(7)));
  EXPECT_THAT(faults, ElementsAre("task_failed"));
  EXPECT_EQ(status.fault().value().detail, "run-time error 60");
}

TEST_F(ControllerSessionTest, ASearchThatTheControllerWillNotMakeIsNamedBeforeAnythingMoves) {
  status.enter(State::kResetting);
  const std::vector<calib::PlannedTouch>& touches = plan_of_owners().touches.touches;
  const auto fault_with = [&](std::int32_t length_dmm, std::int32_t speed_um_s) {
    cs8::Welcome welcome;
    welcome.search_length_max_dmm = length_dmm;
    welcome.search_speed_max_um_s = speed_um_s;
    controller.on_connect = [welcome] { return welcome; };
    run(session.connect(false));
    const auto fault = session.search_fault(touches);
    return fault ? fault->detail : std::string();
  };
  EXPECT_EQ(fault_with(400'000, 20'000), "");
  EXPECT_THAT(fault_with(10'000, 20'000), ::testing::StartsWith("touch 1 searches over"));
  EXPECT_THAT(fault_with(400'000, 100), ::testing::HasSubstr("takes 100 at most"));
}

TEST_F(ControllerSessionTest, AMoveThatDoesNotArriveIsAFaultUnlessSomebodyAskedForAStop) {
  cs8::MoveResult stopped;
  stopped.outcome = cs8::Outcome::kStopped;
  controller.on_move = [&] { return stopped; };
  status.enter(State::kStopping);
  EXPECT_FALSE(run(session.travel({})));
  EXPECT_TRUE(faults.empty());
  status.enter(State::kCompleting);
  EXPECT_FALSE(run(session.travel({})));
  EXPECT_THAT(faults, ElementsAre("protocol_error"));
}

}  // namespace
}  // namespace cell
