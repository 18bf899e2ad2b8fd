#include "service/run/readiness.hpp"

#include <gmock/gmock.h>

#include <set>

#include "cs8_protocol/names.hpp"

namespace cell {
namespace {

using cs8::RejectReason;

constexpr std::uint32_t kTested = cs8::kTouchTested | cs8::kCellClosed | cs8::kProbeLoopClosed;

std::vector<RejectReason> all_reasons() {
  std::vector<RejectReason> reasons;
  for (int value = 0; value < 256; ++value) {
    const auto reason = static_cast<RejectReason>(value);
    if (!cs8::name(reason).empty()) reasons.push_back(reason);
  }
  return reasons;
}

std::string name_after(RejectReason reason, std::uint32_t flags = kTested) {
  const AwaitedAction* awaited = awaited_after_rejection(reason, flags);
  return awaited ? std::string(awaited->name) : "";
}

TEST(Readiness, WhatAPersonAtTheCellCanMendIsWaitedForByItsName) {
  EXPECT_EQ(name_after(RejectReason::kTouchTestMissing), "touch_test");
  EXPECT_EQ(name_after(RejectReason::kCellOpen), "cell_closed");
  EXPECT_EQ(name_after(RejectReason::kNotRemote), "remote_mode");
  EXPECT_EQ(name_after(RejectReason::kNotPowered), "power");
  std::set<std::string> names;
  for (const RejectReason reason : all_reasons()) {
    const AwaitedAction* awaited = awaited_after_rejection(reason, kTested);
    if (!awaited) continue;
    EXPECT_TRUE(names.insert(std::string(awaited->name)).second) << awaited->name;
    EXPECT_EQ(awaited_instruction(awaited->name), awaited->words);
    EXPECT_NE(awaited->words, awaited->name);
  }
  EXPECT_EQ(names.size(), 10u);
}

TEST(Readiness, AnErrorOfTheHostOrADeadApplicationIsNotWaitedFor) {
  for (const RejectReason reason : {RejectReason::kTaskFailed, RejectReason::kBusy, RejectReason::kBadField,
                                    RejectReason::kResultUnacknowledged, RejectReason::kStaleSequence})
    EXPECT_EQ(awaited_after_rejection(reason, 0), nullptr) << cs8::name(reason);
}

TEST(Readiness, TheTouchTestComesFirstAsItIsMadeWithoutPowerOrRemoteMode) {
  const std::uint32_t untested = kTested & ~cs8::kTouchTested;
  EXPECT_EQ(name_after(RejectReason::kNotRemote, untested), "touch_test");
  EXPECT_EQ(name_after(RejectReason::kCellOpen, untested), "touch_test");
  EXPECT_EQ(name_after(RejectReason::kProbeInputs, untested), "probe_inputs") << "no test with a cut cable";
  EXPECT_EQ(name_after(RejectReason::kTaskFailed, untested), "");
}

/// It asked for a touch by hand that nobody can make.
TEST(Readiness, WhereAFaceHoldsTheStylusTheArmIsJoggedOffItFirst) {
  const std::uint32_t untested = kTested & ~cs8::kTouchTested;
  const std::uint32_t at_face = untested | cs8::kRetractDue | cs8::kProbeTouched;
  EXPECT_EQ(name_after(RejectReason::kTouchTestMissing, at_face), "probe_free");
  EXPECT_THAT(std::string(awaited_instruction("probe_free")), ::testing::HasSubstr("jog the arm off it"));
  EXPECT_EQ(name_after(RejectReason::kTouchTestMissing, untested | cs8::kProbeTouched), "touch_test")
      << "a hand";
  EXPECT_EQ(name_after(RejectReason::kProbeInputs, at_face), "probe_inputs");
}

TEST(Readiness, APreconditionOfAStartIsAwaitedAsTheRefusalForTheSameReasonIs) {
  EXPECT_EQ(awaited_by_precondition("not_remote"),
            awaited_after_rejection(RejectReason::kNotRemote, kTested));
  EXPECT_EQ(awaited_by_precondition("emergency_stop"),
            awaited_after_rejection(RejectReason::kEmergencyStop, kTested));
  EXPECT_EQ(awaited_by_precondition("probe_touched"),
            awaited_after_rejection(RejectReason::kProbeTriggered, kTested));
  EXPECT_EQ(awaited_by_precondition("controller_not_connected"), nullptr);
  EXPECT_EQ(awaited_by_precondition("task_error"), nullptr);
}

TEST(Readiness, EachWaitInVainEndsInAFaultThatSaysResumeAndReset) {
  std::set<FaultCode> codes;
  for (const RejectReason reason : all_reasons()) {
    const AwaitedAction* awaited = awaited_after_rejection(reason, kTested);
    if (!awaited) continue;
    const FaultCode code = not_ready_fault(*awaited).code;
    codes.insert(code);
    EXPECT_THAT(std::string(describe(code).next_step), ::testing::HasSubstr("touchcal resume"));
    EXPECT_THAT(std::string(describe(code).next_step), ::testing::HasSubstr("touchcal reset"));
  }
  EXPECT_EQ(codes, (std::set{FaultCode::kTouchTestMissing, FaultCode::kCellOpen, FaultCode::kProbeFault,
                             FaultCode::kNotReady}));
  EXPECT_EQ(not_ready_fault(awaited_confirmation()).code, FaultCode::kNotConfirmed);
}

TEST(Readiness, MotionAndTheClockAreNoPartOfIt) {
  cs8::State state{.flags = kTested, .mode = cs8::WorkingMode::kRemote, .monitor_speed_percent = 100};
  const Readiness before = readiness_of(state);
  state.clock_ms = 20;
  state.flags |= cs8::kSettled | cs8::kQueueEmpty;
  EXPECT_EQ(readiness_of(state), before);
  state.flags &= ~cs8::kCellClosed;
  EXPECT_NE(readiness_of(state), before);
}

}  // namespace
}  // namespace cell
