#include "service/acquisition/touch_judgement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "tests/service/planned_touch.hpp"

namespace cell {
namespace {

using Next = TouchJudgement::Next;

TEST(TouchJudgement, AContactIsKeptAndItsBounceIsTold) {
  cs8::TouchResult result = contact({0, 0, 0});
  result.edges = 1;
  EXPECT_EQ(judge_touch(edf(), planned_touch(), result, {}).next, Next::kKeep);
  EXPECT_TRUE(judge_touch(edf(), planned_touch(), result, {}).warnings.empty());
  result.edges = 3;
  const TouchJudgement judged = judge_touch(edf(), planned_touch(), result, {});
  EXPECT_EQ(judged.next, Next::kKeep);
  ASSERT_EQ(judged.warnings.size(), 1U);
  EXPECT_EQ(judged.warnings.front().code, FaultCode::kProbeBounced);
  result.edges = 2;
  EXPECT_EQ(judge_touch(edf(), planned_touch(), result, {}).warnings.size(), 1U);
}

TEST(TouchJudgement, AContactThatWasPolledIsKeptAndTold) {
  cs8::TouchResult result = contact({0, 0, 0});
  result.source = cs8::CaptureSource::kPolled;
  const TouchJudgement judged = judge_touch(edf(), planned_touch(), result, {});
  EXPECT_EQ(judged.next, Next::kKeep);
  ASSERT_EQ(judged.warnings.size(), 1U);
  EXPECT_EQ(judged.warnings.front().code, FaultCode::kLatchMissing);
}

TEST(TouchJudgement, AnOutcomeWithoutAContactHoldsEndsOrStops) {
  const auto judged = [](cs8::Outcome outcome) {
    return judge_touch(edf(), planned_touch(), {.outcome = outcome}, {});
  };
  EXPECT_EQ(judged(cs8::Outcome::kNoContact).event, Event::kHoldFault);
  EXPECT_EQ(judged(cs8::Outcome::kCollision).next, Next::kFault);
  EXPECT_EQ(judged(cs8::Outcome::kCollision).event, Event::kAbortFault);
  EXPECT_EQ(judged(cs8::Outcome::kStopped).next, Next::kStopped);
}

TEST(TouchJudgement, AProbeOfUnknownOvertravelIsNotJudgedByIt) {
  Cell cell = edf();
  cs8::TouchResult result = contact({0, 0, 0});
  for (const double bend_m : {0.0005, 0.0}) {
    cell.probe.overtravel_m = bend_m;
    result.overtravel_dmm = cs8::dmm_from_metres(0.001);
    EXPECT_EQ(judge_touch(cell, planned_touch(), result, {}).next, bend_m > 0.0 ? Next::kFault : Next::kKeep);
  }
}

TEST(TouchJudgement, WhatTheStylusBendsIsAllowedAndMoreEndsTheRun) {
  Cell cell = edf();
  cs8::TouchResult result = contact({0, 0, 0});
  result.overtravel_dmm = 50;
  cell.probe.overtravel_m = cs8::metres_from_dmm(result.overtravel_dmm);
  EXPECT_EQ(judge_touch(cell, planned_touch(), result, {}).next, Next::kKeep) << "the limit itself";
  ++result.overtravel_dmm;
  EXPECT_EQ(judge_touch(cell, planned_touch(), result, {}).event, Event::kAbortFault);
}

TEST(TouchJudgement, AnAnswerThatCannotBeTrueEndsTheRun) {
  cs8::TouchResult result = contact({0, 0, 0});
  result.edges = 0;
  EXPECT_EQ(judge_touch(edf(), planned_touch(), result, {}).event, Event::kAbortFault);
}

TEST(ContactSpread, LiesBetweenTwoContactsWhereBothWereMade) {
  const calib::PlannedTouch planned = planned_touch();
  cs8::TouchResult result = contact({0, 0, 0});
  result.first_contact = joints_off(0.001 * planned.search_direction);
  EXPECT_NEAR(contact_spread_m(edf(), result).value(), 0.001, 1e-6);
  EXPECT_EQ(first_contact_in(result).value().joints, result.first_contact);
  EXPECT_EQ(first_contact_in(result).value().source, cs8::CaptureSource::kLatched);
  Cell once = edf();
  once.speeds.second.reset();
  EXPECT_FALSE(contact_spread_m(once, result));
  cs8::TouchResult half = result;
  half.source = cs8::CaptureSource::kNone;
  EXPECT_FALSE(contact_spread_m(edf(), half));
  half = result;
  half.first_source = cs8::CaptureSource::kNone;
  EXPECT_FALSE(contact_spread_m(edf(), half));
  EXPECT_FALSE(first_contact_in(half));
}

TEST(TouchJudgement, OneContactOfATouchHasNoSpreadToJudge) {
  Cell once = edf();
  once.speeds.second.reset();
  cs8::TouchResult result = contact({0, 0, 0});
  result.search_speed_um_s = cs8::um_s_from_metres_per_second(once.speeds.contact_m_s());
  EXPECT_EQ(judge_touch(once, planned_touch(), result, {}).next, Next::kKeep);
}

TEST(Agreement, IsFiveDeviationsOfADifferenceAndTheDriftsLimitUnlessTheCellHasOne) {
  Cell cell = edf();
  cell.touch_noise_m = 2e-5;
  EXPECT_NEAR(agreement_max_m(cell), 1.41421356e-4, 1e-12);
  cell.acceptance.reference_drift_max_m.reset();
  EXPECT_EQ(reference_drift_max_m(cell), agreement_max_m(cell));
  cell.acceptance.reference_drift_max_m = 3e-4;
  EXPECT_EQ(reference_drift_max_m(cell), 3e-4);
}

TEST(TouchJudgement, AnAnswerThatContradictsItselfOrTheCommandIsNoContact) {
  const auto code_of = [](const auto& change) {
    cs8::TouchResult result = contact({0, 0, 0});
    change(result);
    const TouchJudgement judged = judge_touch(edf(), planned_touch(), result, {});
    return judged.next == Next::kFault ? std::optional(judged.fault.code) : std::nullopt;
  };
  EXPECT_EQ(code_of([](auto&) {}), std::nullopt);
  EXPECT_EQ(code_of([](auto& result) { result.overtravel_dmm = -1; }), FaultCode::kImplausibleTouch);
  EXPECT_EQ(code_of([](auto& result) { result.edges = 0; }), FaultCode::kImplausibleTouch);
  EXPECT_EQ(code_of([](auto& result) { result.phase = cs8::Phase::kRetract; }), FaultCode::kImplausibleTouch);
  EXPECT_EQ(code_of([](auto& result) { result.search_speed_um_s += 1; }), FaultCode::kImplausibleTouch);
  ASSERT_GT(edf().probe.overtravel_m, 0.0);
  const std::int32_t most_dmm = cs8::dmm_from_metres(edf().probe.overtravel_m);
  EXPECT_EQ(code_of([most_dmm](auto& result) { result.overtravel_dmm = most_dmm; }), std::nullopt);
  EXPECT_EQ(code_of([most_dmm](auto& result) { result.overtravel_dmm = most_dmm + 1; }),
            FaultCode::kOvertravel);
}

TEST(TouchJudgement, TwoContactsTooFarApartAreMadeAgainUntilAPersonIsAsked) {
  const calib::PlannedTouch planned = planned_touch();
  cs8::TouchResult result = contact({0, 0, 0});
  result.first_contact = joints_off(0.9 * kContactSpreadMaxMetres * planned.search_direction);
  EXPECT_EQ(judge_touch(edf(), planned, result, {}).next, Next::kKeep);
  result.first_contact = joints_off(1.1 * kContactSpreadMaxMetres * planned.search_direction);
  for (int attempts = 0; attempts <= kRetriesMax; ++attempts) {
    const TouchJudgement judged = judge_touch(edf(), planned, result, {.attempts = attempts});
    EXPECT_EQ(judged.fault.code, FaultCode::kTouchSpread);
    EXPECT_EQ(judged.next, attempts < kRetriesMax ? Next::kAgain : Next::kFault);
  }
  const TouchJudgement worse =
      judge_touch(edf(), planned, result, {.attempts = 1, .spread_m = kContactSpreadMaxMetres});
  EXPECT_EQ(worse.fault.code, FaultCode::kRetriesWorse);
  EXPECT_EQ(worse.event, Event::kHoldFault);
  const double spread_m = contact_spread_m(edf(), result).value();
  for (const double before_m : {spread_m, 2 * spread_m}) {
    const TouchJudgement better = judge_touch(edf(), planned, result, {.attempts = 1, .spread_m = before_m});
    EXPECT_EQ(better.next, Next::kAgain) << "no worse than before";
  }
}

TEST(TouchJudgement, AContactAtTheBeginningOfItsSearchIsTooEarly) {
  const calib::PlannedTouch planned = planned_touch();
  const double half_m = planned.search_length_m / 2;
  const auto at = [&](double along_m) {
    return judge_touch(edf(), planned, contact((along_m - half_m) * planned.search_direction), {});
  };
  EXPECT_EQ(at(1.5 * kEarlyContactMetres).next, Next::kKeep);
  EXPECT_EQ(at(0.5 * kEarlyContactMetres).fault.code, FaultCode::kEarlyContact);
  EXPECT_EQ(at(0.5 * kEarlyContactMetres).event, Event::kHoldFault);
}

TEST(TouchJudgement, TheSameJointsOnceMoreAreMadeAgainOnceAndThenHold) {
  const cs8::TouchResult result = contact({0, 0, 0});
  TouchHistory history{.last_contact = result.contact};
  EXPECT_EQ(judge_touch(edf(), planned_touch(), result, history).next, Next::kAgain);
  history.attempts = 1;
  const TouchJudgement judged = judge_touch(edf(), planned_touch(), result, history);
  EXPECT_EQ(judged.fault.code, FaultCode::kRepeatedTouch);
  EXPECT_EQ(judged.event, Event::kHoldFault);
}

TEST(TouchJudgement, NoiseInFreeAirIsToldFromASearchThatMetNothing) {
  cs8::TouchResult result{.outcome = cs8::Outcome::kNoContact};
  EXPECT_EQ(judge_touch(edf(), planned_touch(), result, {}).fault.code, FaultCode::kNoContact);
  result.edges = 1;
  EXPECT_EQ(judge_touch(edf(), planned_touch(), result, {}).next, Next::kAgain);
  const TouchJudgement judged = judge_touch(edf(), planned_touch(), result, {.attempts = 1});
  EXPECT_EQ(judged.fault.code, FaultCode::kFalseTrigger);
  EXPECT_EQ(judged.event, Event::kHoldFault);
}

TEST(TouchJudgement, AnotherMonitorSpeedSuspends) {
  cs8::TouchResult result = contact({0, 0, 0});
  result.monitor_speed_percent = 50;
  const TouchJudgement judged = judge_touch(edf(), planned_touch(), result, {});
  EXPECT_EQ(judged.fault.code, FaultCode::kMonitorSpeedChanged);
  EXPECT_EQ(judged.event, Event::kSuspendFault);
}

TEST(PlanFault, ATouchWithoutLengthOrNumberIsNamed) {
  std::vector<calib::PlannedTouch> touches(2, planned_touch());
  EXPECT_FALSE(plan_fault(touches));
  touches[1].search_end_joints = touches[1].approach_joints;
  EXPECT_EQ(plan_fault(touches).value().detail, "touch 2");
  EXPECT_EQ(plan_fault(touches).value().code, FaultCode::kPlanInvalid);
  touches[0].clear_joints[3] = std::nan("");
  EXPECT_EQ(plan_fault(touches).value().detail, "touch 1");
  for (const auto joints : {&calib::PlannedTouch::clear_joints, &calib::PlannedTouch::approach_joints,
                            &calib::PlannedTouch::search_end_joints, &calib::PlannedTouch::joints}) {
    std::vector<calib::PlannedTouch> one(1, planned_touch());
    (one[0].*joints)[3] = std::nan("");
    EXPECT_TRUE(plan_fault(one));
  }
}

TEST(StylusFault, ARadiusFarFromThatOfTheFileIsAnotherStylus) {
  calib::IdentificationProblem problem;
  problem.artefact.parameters = {{.kind = calib::ArtefactKind::kPretravel},
                                 {.kind = calib::ArtefactKind::kStylusRadius}};
  const auto fault = [&problem](double pretravel_m, double radius_m, std::optional<double> std_m) {
    problem.artefact.parameters[1].std = std_m;
    calib::IdentificationResult result;
    result.artefact_errors = Eigen::Vector2d(pretravel_m, radius_m);
    return stylus_fault(problem, result);
  };
  EXPECT_FALSE(fault(0.0, 1e-4, std::nullopt)) << "the limit itself";
  EXPECT_EQ(fault(0.0, -2e-4, std::nullopt).value().code, FaultCode::kWrongStylus);
  EXPECT_EQ(fault(0.0, -2e-4, std::nullopt).value().detail, "by -0.200 mm");
  EXPECT_FALSE(fault(0.0, 4.9e-4, 1e-4)) << "five deviations of what the file says";
  EXPECT_TRUE(fault(0.0, 5.1e-4, 1e-4));
  EXPECT_FALSE(fault(1.0, 0.0, std::nullopt)) << "the pre-travel is no radius";
  EXPECT_FALSE(stylus_fault(problem, {})) << "nothing is known unless converged";
  std::swap(problem.artefact.parameters[0], problem.artefact.parameters[1]);
  calib::IdentificationResult first;
  first.artefact_errors = Eigen::Vector2d(1.0, 0.0);
  EXPECT_TRUE(stylus_fault(problem, first)) << "wherever it stands";
}

TEST(StylusFault, ABallOfAStarFartherOffThanTheFileSaysIsNamed) {
  calib::IdentificationProblem problem;
  problem.artefact.parameters = {{.name = "tip_left_radius", .kind = calib::ArtefactKind::kStylusRadius},
                                 {.name = "tip_left_x", .kind = calib::ArtefactKind::kTipCenter},
                                 {.name = "tip_left_y", .kind = calib::ArtefactKind::kTipCenter},
                                 {.name = "tip_left_z", .kind = calib::ArtefactKind::kTipCenter}};
  for (auto& parameter : problem.artefact.parameters) parameter.within_m = 1e-3;
  calib::IdentificationResult result;
  result.artefact_errors = Eigen::Vector4d(0.0, 0.6e-3, 0.6e-3, 0.6e-3);
  EXPECT_FALSE(stylus_fault(problem, result)) << "1.04 mm, with a tenth to spare";
  result.artefact_errors[3] = -0.9e-3;
  ASSERT_TRUE(stylus_fault(problem, result));
  EXPECT_EQ(stylus_fault(problem, result)->code, FaultCode::kWrongStylus);
  EXPECT_EQ(stylus_fault(problem, result)->detail,
            "tip_left: 1.237 mm from where it is drawn, and the probe's file says within 1.000");
}

TEST(FaceWarning, NamesTheFacesThatFitWorseThanChanceAllows) {
  calib::IdentificationResult result;
  EXPECT_FALSE(face_warning(result, 0.01));
  result.lack_of_fit.emplace().p_of_face = {0.5, 0.01};
  EXPECT_FALSE(face_warning(result, 0.01)) << "the limit itself";
  result.lack_of_fit->p_of_face = {0.001, 0.5, 0.009};
  EXPECT_EQ(face_warning(result, 0.01).value().code, FaultCode::kFaceBias);
  EXPECT_EQ(face_warning(result, 0.01).value().detail, "plane 1, plane 3");
}

}  // namespace
}  // namespace cell
