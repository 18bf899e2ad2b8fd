#include "service/acquisition/touch_judgement.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
  result.edges = 2;
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
  touches[0].clear_joints[3] = std::nan("");
  EXPECT_EQ(plan_fault(touches).value().detail, "touch 1");
}

}  // namespace
}  // namespace cell
