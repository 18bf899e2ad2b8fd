#include "service/acquisition/controller_session.hpp"

#include <gmock/gmock.h>

#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace std::chrono_literals;

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
  controller.permit = cs8::Permit{.run = 7, .state = cs8::PermitState::kGranted};
  controller.state->flags |= cs8::kRetractDue;
  EXPECT_TRUE(run(session.standing_joints()));
  EXPECT_THAT(controller.asked, ElementsAre("retract 1", "acknowledge 1"));
}

TEST_F(ControllerSessionTest, ASearchThatWasBrokenOffIsNotLeftWithAPermitThatHasEnded) {
  status.enter(State::kExecute);
  controller.permit = cs8::Permit{.run = 7, .reason = cs8::PermitReason::kProbeFault};
  controller.state->flags |= cs8::kRetractDue;
  EXPECT_FALSE(run(session.standing_joints()));
  EXPECT_THAT(controller.asked, IsEmpty());
  EXPECT_THAT(faults, ElementsAre("permission_lost"));
  EXPECT_THAT(status.fault().value().detail, HasSubstr("the permit ended by 'probe_fault'"));
}

TEST_F(ControllerSessionTest, AWayThatNobodyPermitsAnyMoreIsNotTaken) {
  confirm(7);
  for (const auto state :
       {cs8::PermitState::kNone, cs8::PermitState::kAwaited, cs8::PermitState::kRetractOnly}) {
    status.enter(State::kCompleting);
    controller.permit = cs8::Permit{.run = 7, .state = state};
    EXPECT_FALSE(run(session.travel({})));
    EXPECT_EQ(status.state(), State::kHolding) << "the run keeps its touches";
  }
  controller.permit = ScriptedController::granted(6);
  status.enter(State::kCompleting);
  EXPECT_FALSE(run(session.travel({}))) << "of another run";
  EXPECT_THAT(controller.asked, IsEmpty());
  EXPECT_THAT(faults, Each("permission_lost"));
}

TEST_F(ControllerSessionTest, AWayAtAnotherMonitorSpeedHoldsTheRunOrSuspendsItsTouches) {
  confirm(7);
  controller.on_move = [] { return cs8::Rejected{cs8::RejectReason::kMonitorSpeed, 50}; };
  const auto after_way_in = [this](State state) {
    status.enter(state);
    EXPECT_FALSE(run(session.travel({})));
    return status.state();
  };
  EXPECT_EQ(after_way_in(State::kExecute), State::kSuspending);
  EXPECT_EQ(after_way_in(State::kCompleting), State::kHolding);
  EXPECT_EQ(after_way_in(State::kHolding), State::kHolding) << "State told of it first";
  EXPECT_EQ(after_way_in(State::kStarting), State::kAborting) << "the way around the block begins anew";
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
  controller.permit = cs8::Permit{.run = 7, .state = cs8::PermitState::kRetractOnly};
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
  controller.permit = cs8::Permit{.run = 7};
  controller.asked.clear();
  run(session.leave_face());
  EXPECT_THAT(controller.asked, IsEmpty()) << "nobody permits it any more";
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

TEST_F(ControllerSessionTest, WhatStateSaysEndsTheWayAroundTheBlock) {
  status.enter(State::kStarting);
  ASSERT_TRUE(run(session.obtain_permit(0)));
  controller.asked.clear();
  controller.state->permit = cs8::PermitState::kGranted;
  controller.state->emergency_stop = 2;
  for (auto passed = 0ms; passed <= PermissionWatch::kAnswerPatience; passed += 20ms) {
    tell_state();
    time.pass(20ms);
  }
  EXPECT_EQ(status.state(), State::kAborting) << "it has no touches to keep";
  EXPECT_THAT(faults, ElementsAre("permission_lost"));
  EXPECT_THAT(controller.asked, Contains("stop"));
}

TEST_F(ControllerSessionTest, WhatIsToldOfACompleteRunStaysWhileTheLinkComesAndGoes) {
  status.enter(State::kComplete);
  status.set_fault({FaultCode::kNotIdentifiable, "28 of 30"});
  session.on_link_lost({cs8::LinkErrorKind::kPeerClosed, "the connection ended"}, Event::kLinkDown);
  EXPECT_EQ(status.fault().value().code, FaultCode::kNotIdentifiable);
  controller.on_connect = [] { return cs8::Welcome{}; };
  run(session.connect(false));
  EXPECT_EQ(status.fault().value().code, FaultCode::kNotIdentifiable) << "until somebody acknowledges it";
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

// A run of an earlier daemon waits for its files over night, with a controller that takes links and drops
// them.
TEST_F(ControllerSessionTest, WhyAnInterruptedRunCannotGoOnOutlivesLinksThatDieAtOnceAndFillsNoTable) {
  const Fault why{FaultCode::kDaemonRestarted, "the cell's files are not those of the run"};
  controller.is_connected = false;
  status.enter(State::kHeld);
  status.set_fault(why);
  int tried = 0;
  controller.on_connect = [&]() -> cs8::ConnectReply {
    if (++tried == 1) return cs8::LinkError{cs8::LinkErrorKind::kUnreachable, "nobody"};
    return cs8::Welcome{};
  };
  for (int i = 0; i < 20; ++i) {
    run(session.connect(true));
    EXPECT_EQ(status.fault().value().detail, why.detail);
    controller.is_connected = false;
    session.on_link_lost({cs8::LinkErrorKind::kPeerClosed, "the connection ended"}, Event::kNotReadyFault);
    EXPECT_EQ(status.fault().value().detail, why.detail);
  }
  EXPECT_TRUE(faults.empty());
  status.set_fault({FaultCode::kDaemonRestarted, {}});
  for (int i = 0; i < 20; ++i) {
    run(session.connect(true));
    controller.is_connected = false;
    session.on_link_lost({cs8::LinkErrorKind::kPeerClosed, "the connection ended"}, Event::kNotReadyFault);
  }
  EXPECT_LE(faults.size(), 3u) << "the first, and where the number has become ten times as large";
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

TEST_F(ControllerSessionTest, AResumeWithoutALinkHidesOnlyUntilItIsBackThatTheLinkWasLost) {
  status.begin_run(1);
  status.enter(State::kExecute);
  controller.is_connected = false;
  session.on_link_lost({cs8::LinkErrorKind::kSilent, "nothing was heard"}, Event::kLinkDown);
  const Fault lost = status.fault().value();
  ASSERT_EQ(lost.code, FaultCode::kLinkLost);
  status.clear_fault();  // as a person's resume does
  status.enter(State::kUnholding);
  controller.on_connect = [] { return cs8::LinkError{cs8::LinkErrorKind::kUnreachable, "refused"}; };
  run(session.connect(false));
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_EQ(status.fault().value().code, FaultCode::kControllerUnreachable) << "as it is now";
  status.apply(Event::kDone);
  ASSERT_EQ(status.state(), State::kHeld);
  controller.on_connect = [] { return cs8::Welcome{}; };
  run(session.connect(false));
  EXPECT_EQ(status.fault().value().message(), lost.message()) << "why it is on hold";
}

TEST_F(ControllerSessionTest, GivesUpToConnectForWhatElseIsToBeDone) {
  status.enter(State::kComplete);
  controller.is_connected = false;
  controller.on_connect = [] { return cs8::LinkError{cs8::LinkErrorKind::kUnreachable, "refused"}; };
  const auto is_due = [this] { return controller.asked.size() == 3; };
  EXPECT_EQ(run(session.connect(false, is_due)), 0u);
  EXPECT_THAT(controller.asked, ElementsAre("connect", "connect", "connect"));
}

TEST_F(ControllerSessionTest, AMoveThatDoesNotArriveIsAFaultUnlessSomebodyAskedForAStop) {
  cs8::MoveResult stopped;
  stopped.outcome = cs8::Outcome::kStopped;
  controller.on_move = [&] { return stopped; };
  confirm(7);
  status.enter(State::kStopping);
  EXPECT_FALSE(run(session.travel({})));
  EXPECT_TRUE(faults.empty());
  status.enter(State::kCompleting);
  EXPECT_FALSE(run(session.travel({})));
  EXPECT_THAT(faults, ElementsAre("protocol_error"));
}

}  // namespace
}  // namespace cell
