#include "service/run/touch_command.hpp"

#include <gmock/gmock.h>

#include <map>
#include <random>

#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "tests/service/planned_touch.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

TEST(WireJoints, GoThereAndBackWithoutAStep) {
  std::mt19937_64 chance(1);
  std::uniform_int_distribution<std::int32_t> microdeg(-270'000'000, 270'000'000);
  for (int i = 0; i < 1000; ++i) {
    cs8::JointsMicrodeg wire{};
    for (std::int32_t& joint : wire) joint = microdeg(chance);
    EXPECT_EQ(to_wire(from_wire(wire)), wire) << "seed 1, draw " << i;
  }
}

TEST(WireJoints, AreTheNearestStep) {
  const double step = cs8::radians_from_microdeg(1);
  calib::JointVector joints;
  joints << 0.4 * step, -0.4 * step, 0.6 * step, -0.6 * step, 100.4 * step, -100.6 * step;
  EXPECT_EQ(to_wire(joints), (cs8::JointsMicrodeg{0, 0, 1, -1, 100, -101}));
}

TEST(TouchCommand, CarriesPosturesSpeedsAndDeadlineOfPlanAndCell) {
  const calib::PlannedTouch planned = planned_touch();
  const std::vector<calib::JointVector> via{calib::JointVector::Constant(0.4),
                                            calib::JointVector::Constant(0.5)};
  const cs8::Touch command = touch_command(edf(), planned, via);
  EXPECT_EQ(command.via_count, 2);
  EXPECT_EQ(command.via[0], to_wire(via[0]));
  EXPECT_EQ(command.via[1], to_wire(via[1]));
  EXPECT_EQ(command.via[2], cs8::JointsMicrodeg{}) << "unused postures are zero";
  EXPECT_EQ(command.clear, to_wire(planned.clear_joints));
  EXPECT_EQ(command.approach, to_wire(planned.approach_joints));
  EXPECT_EQ(command.search_end, to_wire(planned.search_end_joints));
  EXPECT_EQ(command.travel_speed_um_s, cs8::um_s_from_metres_per_second(edf().speeds.travel_m_s));
  EXPECT_EQ(command.approach_speed_um_s, cs8::um_s_from_metres_per_second(edf().speeds.approach_m_s));
  EXPECT_EQ(command.search_speed_um_s, cs8::um_s_from_metres_per_second(edf().speeds.search_m_s));
  const SecondTouch second = edf().speeds.second.value();
  EXPECT_EQ(command.second_speed_um_s, cs8::um_s_from_metres_per_second(second.speed_m_s));
  EXPECT_EQ(command.second_backoff_dmm, cs8::dmm_from_metres(second.backoff_m));
  EXPECT_EQ(command.deadline_ms, edf().deadlines.command.count());
}

TEST(TouchCommand, NoSecondTouchIsAskedForWhereTheCellHasNone) {
  Cell cell = edf();
  cell.speeds.second.reset();
  EXPECT_EQ(touch_command(cell, planned_touch(), {}).second_speed_um_s, 0);
}

TEST(TouchCommand, TheLongestWayFits) {
  const std::vector<calib::JointVector> via(cs8::kViaCountMax, calib::JointVector::Constant(0.4));
  const cs8::Touch command = touch_command(edf(), planned_touch(), via);
  EXPECT_EQ(command.via_count, static_cast<std::int32_t>(cs8::kViaCountMax));
  EXPECT_EQ(command.via.back(), to_wire(via.back()));
}

TEST(TravelCommand, GoesThroughViaToTheTarget) {
  const std::vector<calib::JointVector> via{calib::JointVector::Constant(0.4)};
  const cs8::Travel command = travel_command(edf(), edf().park_joints, via);
  EXPECT_EQ(command.via_count, 1);
  EXPECT_EQ(command.via[0], to_wire(via[0]));
  EXPECT_EQ(command.target, to_wire(edf().park_joints));
  EXPECT_EQ(command.travel_speed_um_s, cs8::um_s_from_metres_per_second(edf().speeds.travel_m_s));
  EXPECT_EQ(command.deadline_ms, edf().deadlines.command.count());
}

TEST(RetractCommand, MovesAsSlowlyAsAnApproach) {
  const cs8::Retract command = retract_command(edf());
  EXPECT_EQ(command.approach_speed_um_s, cs8::um_s_from_metres_per_second(edf().speeds.approach_m_s));
  EXPECT_EQ(command.deadline_ms, edf().deadlines.command.count());
}

TEST(FaultOf, EveryOutcomeThatIsNoSuccessIsItsFault) {
  const std::map<cs8::Outcome, FaultCode> faults{
      {cs8::Outcome::kNoContact, FaultCode::kNoContact},
      {cs8::Outcome::kUnexpectedContact, FaultCode::kUnexpectedContact},
      {cs8::Outcome::kProbeStuck, FaultCode::kProbeStuck},
      {cs8::Outcome::kHeartbeatLost, FaultCode::kLinkLost},
      {cs8::Outcome::kPermissionLost, FaultCode::kPermissionLost},
      {cs8::Outcome::kCollision, FaultCode::kCollision},
      {cs8::Outcome::kMotionError, FaultCode::kMotionError},
      {cs8::Outcome::kDeadline, FaultCode::kTouchDeadline},
      {cs8::Outcome::kOvertravel, FaultCode::kOvertravel},
      {cs8::Outcome::kProbeFault, FaultCode::kProbeFault},
      {cs8::Outcome::kTaskFailed, FaultCode::kTaskFailed}};
  std::size_t successes = 0;
  std::size_t outcomes = 0;
  for (int value = 0; value < 256; ++value) {
    const auto outcome = static_cast<cs8::Outcome>(value);
    if (cs8::name(outcome).empty()) continue;
    ++outcomes;
    const auto fault = fault_of(outcome, cs8::Phase::kSearch, 0);
    if (!fault) {
      ++successes;
      continue;
    }
    ASSERT_TRUE(faults.contains(outcome)) << cs8::name(outcome);
    EXPECT_EQ(fault->fault.code, faults.at(outcome)) << cs8::name(outcome);
  }
  EXPECT_EQ(successes, 3u) << "contact, arrived, stopped";
  EXPECT_EQ(outcomes, faults.size() + successes);
}

TEST(FaultOf, WhatAPersonCanMendOnTheSpotHoldsAndItsNextStepSaysResume) {
  for (int value = 0; value < 256; ++value) {
    const auto outcome = static_cast<cs8::Outcome>(value);
    if (cs8::name(outcome).empty()) continue;
    const auto fault = fault_of(outcome, cs8::Phase::kSearch, 0);
    if (!fault) continue;
    EXPECT_THAT(std::string(describe(fault->fault.code).next_step),
                HasSubstr(fault->holds ? "touchcal resume" : "touchcal clear"))
        << cs8::name(outcome);
  }
}

TEST(FaultOf, SaysWhereInTheTouchAndWhichRunTimeError) {
  const auto fault = fault_of(cs8::Outcome::kMotionError, cs8::Phase::kApproach, 4711);
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->fault.detail, HasSubstr("4711"));
  EXPECT_THAT(fault->fault.detail, HasSubstr(std::string(cs8::name(cs8::Phase::kApproach))));
}

TEST(FaultOf, AnOutcomeThatIsNotListedEndsTheRun) {
  const auto fault = fault_of(static_cast<cs8::Outcome>(99), cs8::Phase::kSearch, 0);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->fault.code, FaultCode::kMotionError);
  EXPECT_EQ(fault->event(), Event::kAbortFault);
}

TEST(FaultOf, ARefusalHoldsWhatAPersonCanMendAndEndsTheRest) {
  using enum cs8::RejectReason;
  struct Refusal {
    FaultCode code;
    Event event;
  };
  constexpr Refusal kMended{FaultCode::kTouchRejected, Event::kHoldFault};
  constexpr Refusal kPermission{FaultCode::kPermissionLost, Event::kHoldFault};
  constexpr Refusal kPlan{FaultCode::kPlanInvalid, Event::kAbortFault};
  const std::map<cs8::RejectReason, Refusal> refusals{
      {kProbeInputs, {FaultCode::kProbeFault, Event::kHoldFault}},
      {kCellOpen, {FaultCode::kCellOpen, Event::kHoldFault}},
      {kTouchTestMissing, {FaultCode::kTouchTestMissing, Event::kHoldFault}},
      {kTaskFailed, {FaultCode::kTaskFailed, Event::kHoldFault}},
      {kProbeTriggered, {FaultCode::kProbeTriggered, Event::kHoldFault}},
      {kMonitorSpeed, {FaultCode::kMonitorSpeedChanged, Event::kSuspendFault}},
      {kBadField, kPlan},
      {kSearchTooLong, kPlan},
      {kSearchTooFast, kPlan},
      {kNotRemote, kPermission},
      {kNotPowered, kPermission},
      {kHold, kPermission},
      {kEmergencyStop, kPermission},
      {kNotCalibrated, kPermission},
      {kNotPermitted, kPermission},
      {kResultUnacknowledged, kMended},
      {kBusy, kMended},
      {kStaleSequence, kMended},
      {kOutOfRange, kPlan},
      {kNothingToRetract, kMended},
      {kRetractPending, kMended}};
  for (int value = 0; value < 256; ++value) {
    const auto reason = static_cast<cs8::RejectReason>(value);
    if (cs8::name(reason).empty()) continue;
    ASSERT_TRUE(refusals.contains(reason)) << cs8::name(reason);
    const OutcomeFault fault = fault_of(cs8::Rejected{reason, 7});
    EXPECT_EQ(fault.fault.code, refusals.at(reason).code) << cs8::name(reason);
    EXPECT_EQ(fault.event(), refusals.at(reason).event) << cs8::name(reason);
  }
  EXPECT_EQ(fault_of(cs8::Rejected{kOutOfRange, 6}).fault.detail, "out_of_range (detail 6)");
  EXPECT_EQ(fault_of(cs8::Rejected{kMonitorSpeed, 50}).fault.detail, "to 50 %");
  EXPECT_EQ(fault_of(cs8::Rejected{static_cast<cs8::RejectReason>(99), 0}).event(), Event::kHoldFault);
}

TEST(FaultOf, WhatTheTableSaysOfATouchThatWasRefusedIsWhatBecomesOfTheRun) {
  for (int value = 0; value < 256; ++value) {
    const OutcomeFault fault = fault_of(cs8::Rejected{static_cast<cs8::RejectReason>(value), 0});
    const FaultKind kind = describe(fault.fault.code).kind;
    EXPECT_EQ(fault.event() == Event::kAbortFault, kind == FaultKind::kAborted) << value;
  }
}

TEST(Implausible, AContactHasAnEdgeHoweverItWasSeen) {
  cs8::TouchResult result = contact({0, 0, 0});
  result.edges = 0;
  EXPECT_THAT(implausibility_reason(edf(), planned_touch(), result).value_or(""), HasSubstr("no edge"));
  result.source = cs8::CaptureSource::kPolled;
  EXPECT_THAT(implausibility_reason(edf(), planned_touch(), result).value_or(""), HasSubstr("no edge"));
  result.edges = 1;
  EXPECT_EQ(implausibility_reason(edf(), planned_touch(), result), std::nullopt);
}

TEST(Implausible, AContactOnTheWayOfTheSearchIsTaken) {
  const calib::PlannedTouch planned = planned_touch();
  for (const double along_m : {-0.01505, -0.005, 0.0, 0.005, 0.01505}) {
    EXPECT_EQ(implausibility_reason(edf(), planned, contact(along_m * planned.search_direction)),
              std::nullopt)
        << along_m;
  }
}

TEST(Implausible, AContactWithoutCapturedJointsIsNone) {
  cs8::TouchResult result = contact({0, 0, 0});
  result.source = cs8::CaptureSource::kNone;
  EXPECT_THAT(implausibility_reason(edf(), planned_touch(), result).value_or(""),
              HasSubstr("no captured joints"));
}

TEST(Implausible, AContactAtAnotherMonitorSpeedIsNone) {
  cs8::TouchResult result = contact({0, 0, 0});
  result.monitor_speed_percent = 50;
  EXPECT_THAT(implausibility_reason(edf(), planned_touch(), result).value_or(""),
              HasSubstr("monitor speed was 50 %"));
}

TEST(Implausible, AContactBesideTheLineIsTold) {
  const calib::PlannedTouch planned = planned_touch();
  const Eigen::Vector3d aside = planned.search_direction.unitOrthogonal();
  EXPECT_EQ(implausibility_reason(edf(), planned, contact(5e-5 * aside)), std::nullopt);
  EXPECT_THAT(implausibility_reason(edf(), planned, contact(0.001 * aside)).value_or(""),
              HasSubstr("1.000 mm beside the search line"));
}

TEST(Implausible, AFirstTouchThatIsMissingOrElsewhereIsTold) {
  const calib::PlannedTouch planned = planned_touch();
  cs8::TouchResult result = contact({0, 0, 0});
  result.first_contact = joints_off(0.001 * planned.search_direction.unitOrthogonal());
  EXPECT_THAT(implausibility_reason(edf(), planned, result).value_or(""), HasSubstr("in its first contact"));
  result.first_source = cs8::CaptureSource::kNone;
  EXPECT_THAT(implausibility_reason(edf(), planned, result).value_or(""),
              HasSubstr("the first of its two contacts is missing"));
  Cell once = edf();
  once.speeds.second.reset();
  result.search_speed_um_s = cs8::um_s_from_metres_per_second(once.speeds.search_m_s);
  EXPECT_EQ(implausibility_reason(once, planned, result), std::nullopt);
}

TEST(Implausible, AContactBeyondEitherEndOfTheSearchIsTold) {
  const calib::PlannedTouch planned = planned_touch();
  for (const double along_m : {-0.0152, 0.0152}) {
    EXPECT_THAT(
        implausibility_reason(edf(), planned, contact(along_m * planned.search_direction)).value_or(""),
        HasSubstr(along_m < 0 ? "-15.200 mm from" : " 15.200 mm from"))
        << along_m;
  }
}

}  // namespace
}  // namespace cell
