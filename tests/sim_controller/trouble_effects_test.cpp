// What each fault of probe, controller and people makes of a touch.
#include "sim_controller/trouble_effects.hpp"

#include <gtest/gtest.h>

#include "bench.hpp"
#include "config/fault_file.hpp"
#include "sim_controller/fault_names.hpp"

namespace sim {
namespace {

using cs8::Outcome;
using cs8::PermitReason;
using cs8::PermitState;
using cs8::Phase;
using testing::Bench;

class Troubles : public testing::DemoTouch {
 protected:
  static void add(Bench& bench, const std::string& fault) {
    bench.state.plan.add(planned(std::get<cell::DeclaredFault>(cell::parse_control_line(fault))));
  }

  /// The first touch, with the fault in it.
  static cs8::TouchResult touch_with(Bench& bench, const std::string& fault) {
    add(bench, fault);
    bench.answer<cs8::Accepted>(1, touch());
    return bench.result<cs8::TouchResult>();
  }

  static cs8::TouchResult touch_with(const std::string& fault) {
    Bench bench = Bench::ready(plant());
    return touch_with(bench, fault);
  }

  /// Whatever becomes of asking for a run in a cell with this fault.
  static cs8::Permit permit_with(Bench& bench) {
    bench.connect();
    for (int i = 0; i < 400; ++i) bench.pass(milliseconds(20));  // power, if anybody gives it
    for (int i = 0; i < 3; ++i) {
      bench.send(0, cs8::Begin{.run = 1, .confirm_within_ms = 30'000});
      for (int k = 0; k < 2000 && bench.state.permit.permit.state != PermitState::kGranted; ++k)
        bench.pass(milliseconds(20));
    }
    return bench.state.permit.permit;
  }

  static cs8::Permit permit_with_fault(const std::string& fault) {
    Bench bench(plant());
    add(bench, fault);
    return permit_with(bench);
  }

  static cs8::Permit permit_without(OperatorDuties duties) {
    Bench bench(plant(), {.duties = duties});
    return permit_with(bench);
  }

  using milliseconds = std::chrono::milliseconds;
};

TEST_F(Troubles, EndATouchWithTheirOutcome) {
  struct Case {
    std::string fault;
    Outcome outcome;
    Phase phase = Phase::kIdle;
  };
  const std::vector<Case> cases{
      {R"({"fault":"probe_stuck","touch":1})", Outcome::kProbeStuck},
      {R"({"fault":"probe_stuck","touch":1,"phase":"travel"})", Outcome::kProbeStuck},
      {R"({"fault":"probe_touched","touch":1,"phase":"retract"})", Outcome::kProbeStuck},
      {R"({"fault":"probe_touched","touch":1,"phase":"travel"})", Outcome::kUnexpectedContact,
       Phase::kTravel},
      {R"({"fault":"touch_stylus","touch":1,"phase":"approach"})", Outcome::kUnexpectedContact,
       Phase::kApproach},
      {R"({"fault":"probe_bounces","touch":1,"times":3})", Outcome::kContact},
      {R"({"fault":"latch_lost","touch":1})", Outcome::kContact},
      {R"({"fault":"vibration","touch":1,"ms":1})", Outcome::kNoContact},
      {R"({"fault":"vibration","touch":1,"phase":"travel","ms":1,"after_ms":20})",
       Outcome::kUnexpectedContact, Phase::kTravel},
      {R"({"fault":"contact_cut","touch":1})", Outcome::kProbeFault, Phase::kSearch},
      {R"({"fault":"loop_short","touch":1})", Outcome::kProbeFault, Phase::kSearch},
      {R"({"fault":"contact_short","touch":1,"phase":"travel"})", Outcome::kProbeFault, Phase::kTravel},
      {R"({"fault":"loop_cut","touch":1,"phase":"approach"})", Outcome::kProbeFault, Phase::kApproach},
      {R"({"fault":"task_dies","touch":1,"error":123})", Outcome::kTaskFailed, Phase::kSearch},
      {R"({"fault":"motion_error","touch":1,"phase":"travel","error":150})", Outcome::kMotionError,
       Phase::kTravel},
      {R"({"fault":"never_settles","touch":1})", Outcome::kMotionError, Phase::kSearch},
      {R"({"fault":"collision","touch":1,"phase":"approach"})", Outcome::kCollision, Phase::kApproach},
      {R"({"fault":"hold","touch":1})", Outcome::kPermissionLost, Phase::kSearch},
      {R"({"fault":"emergency_stop","touch":1})", Outcome::kPermissionLost, Phase::kSearch},
      {R"({"fault":"power_off","touch":1,"phase":"retract"})", Outcome::kPermissionLost, Phase::kRetract},
      {R"({"fault":"manual_mode","touch":1})", Outcome::kPermissionLost, Phase::kSearch},
      {R"({"fault":"local_mode","touch":1})", Outcome::kPermissionLost, Phase::kSearch},
      {R"({"fault":"open_cell","touch":1})", Outcome::kPermissionLost, Phase::kSearch},
      {R"({"fault":"jog_home","touch":1})", Outcome::kPermissionLost, Phase::kSearch},
      {R"({"fault":"press_confirm","touch":1})", Outcome::kContact},
      {R"({"fault":"close","touch":1})", Outcome::kHeartbeatLost, Phase::kSearch},
  };
  for (const Case& trouble : cases) {
    SCOPED_TRACE(trouble.fault);
    const cs8::TouchResult result = touch_with(trouble.fault);
    EXPECT_EQ(cs8::name(result.outcome), cs8::name(trouble.outcome));
    EXPECT_EQ(cs8::name(result.phase), cs8::name(trouble.phase));
  }
}

TEST_F(Troubles, AMotionErrorStrikesAMoveAndNothingElse) {
  Bench bench = Bench::ready(plant());
  bench.answer<cs8::Accepted>(1, touch());
  const auto brakes = [&bench] {
    return bench.state.motion.running->stage == Stage::kTripped && bench.state.cabinet.drives.braking;
  };
  while (bench.state.motion.running && !brakes()) bench.pass(milliseconds(4));
  ASSERT_TRUE(bench.state.motion.running);
  apply(Trouble{TroubleKind::kMotionError, 150}, bench.state);
  EXPECT_EQ(bench.result<cs8::TouchResult>().outcome, Outcome::kContact);
}

TEST_F(Troubles, ACollisionNearAFaceLeavesTheWayBackDue) {
  Bench bench = Bench::ready(plant());
  touch_with(bench, R"({"fault":"collision","touch":1,"phase":"approach"})");
  bench.pass(milliseconds(20));
  EXPECT_TRUE(bench.flag(cs8::kRetractDue));
}

TEST_F(Troubles, AreToldInTheResult) {
  EXPECT_EQ(touch_with(R"({"fault":"latch_lost","touch":1})").source, cs8::CaptureSource::kPolled);
  EXPECT_EQ(touch_with(R"({"fault":"probe_bounces","touch":1,"times":3})").edges, 4U);
  EXPECT_EQ(touch_with(R"({"fault":"monitor_speed","touch":1,"percent":50})").monitor_speed_percent, 50);
  EXPECT_EQ(touch_with(R"({"fault":"task_dies","touch":1,"error":123})").error_number, 123);
  EXPECT_EQ(touch_with(R"({"fault":"motion_error","touch":1,"error":150})").error_number, 150);
}

TEST_F(Troubles, AProbeThatIsNotThereGivesNoContact) {
  const cs8::TouchResult result = touch_with(R"({"fault":"probe_dead","touch":1,"phase":"travel"})");
  EXPECT_NE(result.outcome, Outcome::kContact);
  EXPECT_EQ(result.source, cs8::CaptureSource::kNone);
}

TEST_F(Troubles, EndThePermitWithTheTouch) {
  struct Case {
    std::string fault;
    PermitReason reason;
  };
  for (const Case& trouble : {Case{R"({"fault":"emergency_stop","touch":1})", PermitReason::kPermissionLost},
                              Case{R"({"fault":"open_cell","touch":1})", PermitReason::kPermissionLost},
                              Case{R"({"fault":"task_dies","touch":1,"error":20})", PermitReason::kBrokenOff},
                              Case{R"({"fault":"collision","touch":1})", PermitReason::kBrokenOff},
                              Case{R"({"fault":"loop_cut","touch":1})", PermitReason::kProbeFault}}) {
    SCOPED_TRACE(trouble.fault);
    Bench bench = Bench::ready(plant());
    touch_with(bench, trouble.fault);
    bench.pass(milliseconds(100));
    EXPECT_EQ(bench.state.permit.permit.state, PermitState::kNone);
    EXPECT_EQ(bench.state.permit.permit.reason, trouble.reason);
  }
}

TEST_F(Troubles, LeaveTheControllerUnfitForTheNextCommand) {
  struct Case {
    std::string fault;
    cs8::RejectReason reason;
  };
  for (const Case& trouble :
       {Case{R"({"fault":"references_lost","touch":1})", cs8::RejectReason::kNotCalibrated},
        Case{R"({"fault":"monitor_speed","touch":1,"percent":10})", cs8::RejectReason::kMonitorSpeed},
        Case{R"({"fault":"task_dies","touch":1,"phase":"retract","error":20})",
             cs8::RejectReason::kTaskFailed},
        Case{R"({"fault":"probe_touched","touch":1,"phase":"retract"})", cs8::RejectReason::kProbeTriggered},
        Case{R"({"fault":"loop_cut"})", cs8::RejectReason::kProbeInputs}}) {
    SCOPED_TRACE(trouble.fault);
    Bench bench = Bench::ready(plant());
    if (trouble.fault.find("touch\"") != std::string::npos) {
      touch_with(bench, trouble.fault);
      bench.send(0, cs8::ResultAcknowledge{1});
    } else {
      add(bench, trouble.fault);
    }
    bench.pass(milliseconds(100));
    bench.send(0, cs8::Begin{.run = 2, .confirm_within_ms = 1'000});
    EXPECT_EQ(bench.state.permit.permit.reason, PermitReason::kRefused);
    EXPECT_EQ(bench.state.permit.permit.detail, static_cast<std::int32_t>(trouble.reason));
  }
}

TEST_F(Troubles, ARestartForgetsTheCommandAndSaysGoodbye) {
  Bench bench = Bench::ready(plant());
  const std::uint32_t session = bench.state.session;
  add(bench, R"({"fault":"restart","touch":1})");
  bench.answer<cs8::Accepted>(1, touch());
  while (bench.state.motion.running) bench.pass(milliseconds(20));
  EXPECT_EQ(bench.state.session, session + 1);
  EXPECT_FALSE(bench.state.stored_result);
  EXPECT_FALSE(bench.state.connected);
  bool told = false;
  for (const cs8::Message& message : bench.sent) {
    const auto* fault = std::get_if<cs8::Fault>(&message.payload);
    told = told || (fault != nullptr && fault->code == cs8::FaultCode::kStopping);
  }
  EXPECT_TRUE(told);
  EXPECT_EQ(bench.connect().last_sequence, 0U);
}

TEST_F(Troubles, OverrunsAreCounted) {
  Bench bench = Bench::ready(plant());
  touch_with(bench, R"({"fault":"overruns","touch":1,"times":7})");
  bench.pass(milliseconds(40));
  EXPECT_EQ(bench.last_state()->overruns, 7U);
}

TEST_F(Troubles, MendedProbeTouchesAgain) {
  Bench bench = Bench::ready(plant());
  EXPECT_EQ(touch_with(bench, R"({"fault":"probe_stuck","touch":1})").outcome, Outcome::kProbeStuck);
  bench.send(0, cs8::ResultAcknowledge{1});
  add(bench, R"({"fault":"probe_mended"})");
  bench.pass(milliseconds(100));
  if (bench.state.permit.permit.state != PermitState::kGranted) bench.permit();
  bench.answer<cs8::Accepted>(2, touch());
  EXPECT_EQ(bench.result<cs8::TouchResult>().outcome, Outcome::kContact);
}

TEST_F(Troubles, AnEmergencyStopIsReleasedAndAcknowledgedByPeople) {
  Bench bench = Bench::ready(plant());
  add(bench, R"({"fault":"emergency_stop"})");
  bench.pass(milliseconds(40));
  EXPECT_EQ(bench.last_state()->emergency_stop, 2);
  add(bench, R"({"fault":"release_emergency_stop"})");
  bench.pass(milliseconds(40));
  EXPECT_EQ(bench.last_state()->emergency_stop, 1);
  add(bench, R"({"fault":"acknowledge_emergency_stop"})");
  bench.pass(milliseconds(40));
  EXPECT_EQ(bench.last_state()->emergency_stop, 0);
  EXPECT_FALSE(bench.flag(cs8::kPowered));
}

TEST_F(Troubles, NobodyDoesWhatTheOperatorLeavesUndone) {
  const auto refused = [](const cs8::Permit& permit, cs8::RejectReason reason) {
    return permit.reason == PermitReason::kRefused && permit.detail == static_cast<std::int32_t>(reason);
  };
  EXPECT_EQ(permit_without({}).state, PermitState::kGranted);
  EXPECT_TRUE(refused(permit_without({.powers_up = false}), cs8::RejectReason::kNotPowered));
  EXPECT_TRUE(refused(permit_without({.touches_probe = false}), cs8::RejectReason::kTouchTestMissing));
  EXPECT_EQ(permit_without({.confirms = false}).reason, PermitReason::kNotConfirmed);
}

TEST_F(Troubles, AConfirmationThatComesTooLateOrHangsIsNone) {
  EXPECT_EQ(permit_with_fault(R"({"fault":"confirms_late","ms":20000})").state, PermitState::kGranted);
  EXPECT_EQ(permit_with_fault(R"({"fault":"confirms_late","ms":31000})").reason, PermitReason::kNotConfirmed);
  EXPECT_EQ(permit_with_fault(R"({"fault":"confirmation_key_stuck"})").reason, PermitReason::kNotConfirmed);
}

TEST_F(Troubles, AnArmThatNobodyFreesStaysWithoutPower) {
  for (const bool frees : {true, false}) {
    Bench bench = Bench::ready(plant(), {.duties = {.frees_arm = frees}});
    EXPECT_EQ(touch_with(bench, R"({"fault":"collision","touch":1})").outcome, Outcome::kCollision);
    EXPECT_FALSE(bench.state.cabinet.panel.powered);
    bench.happen(ConnectionClosed{});
    bench.connect();
    bench.pass(milliseconds(5000));
    EXPECT_EQ(bench.state.cabinet.panel.powered, frees);
  }
}

}  // namespace
}  // namespace sim
