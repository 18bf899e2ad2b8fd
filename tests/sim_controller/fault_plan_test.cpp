#include "sim_controller/fault_plan.hpp"

#include <gtest/gtest.h>

namespace sim {
namespace {

using cs8::MessageType;
using cs8::Phase;

constexpr double kTick = 0.004;

std::vector<Fault> kinds(const std::vector<LinkFault>& faults) {
  std::vector<Fault> kinds;
  for (const LinkFault& fault : faults) kinds.push_back(fault.kind);
  return kinds;
}

bool comes(FaultPlan& plan, double seconds = kTick) { return !plan.advance(seconds).empty(); }

TEST(FaultPlan, CountsTheMessagesOfEachTypeAndFaultsMeetThatOneOnly) {
  FaultPlan plan({{Fault::kDrop, MessageType::kTouch, 2}});
  EXPECT_TRUE(plan.faults_at(MessageType::kTouch).empty());
  EXPECT_TRUE(plan.faults_at(MessageType::kTravel).empty());
  EXPECT_EQ(kinds(plan.faults_at(MessageType::kTouch)), std::vector{Fault::kDrop});
  EXPECT_TRUE(plan.faults_at(MessageType::kTouch).empty());
}

TEST(FaultPlan, FaultsOfOneMessageComeTogetherInTheirOrder) {
  FaultPlan plan({{Fault::kWrongSequence, MessageType::kTouch}, {Fault::kDuplicate, MessageType::kTouch}});
  EXPECT_EQ(kinds(plan.faults_at(MessageType::kTouch)),
            (std::vector{Fault::kWrongSequence, Fault::kDuplicate}));
}

TEST(FaultPlan, EveryTimeMeansEveryTime) {
  FaultPlan plan({{.what = Fault::kDrop, .on = MessageType::kState, .every = true}});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(plan.faults_at(MessageType::kState).size(), 1U);
}

TEST(FaultPlan, AFaultThatIsAddedLaterCountsFromThen) {
  FaultPlan plan;
  EXPECT_TRUE(plan.faults_at(MessageType::kTouch).empty());
  plan.add({Fault::kDrop, MessageType::kTouch, 1});
  EXPECT_EQ(plan.faults_at(MessageType::kTouch).size(), 1U);
}

TEST(FaultPlan, ATroubleThatComesWithAMessageIsDueAtTheNextTick) {
  FaultPlan plan({{Trouble{TroubleKind::kTaskDies, 150}, MessageType::kTouch}});
  EXPECT_FALSE(comes(plan));
  EXPECT_TRUE(plan.faults_at(MessageType::kTouch).empty()) << "it is none of the link's";
  const auto due = plan.advance(0.0);
  ASSERT_EQ(due.size(), 1U);
  EXPECT_EQ(std::get<Trouble>(due.front()).number, 150);
  EXPECT_FALSE(comes(plan)) << "once";
}

TEST(FaultPlan, SimulatedTimePassesBeforeALateFault) {
  FaultPlan plan({{.what = Fault::kCloseSocket, .on = MessageType::kAccepted, .after_s = 0.1}});
  EXPECT_TRUE(plan.faults_at(MessageType::kAccepted).empty());
  int ticks = 0;
  while (!comes(plan)) ++ticks;
  EXPECT_NEAR(ticks * kTick, 0.1, 1.5 * kTick);
}

TEST(FaultPlan, WhatComesAtOnceIsDueAtTheFirstTick) {
  FaultPlan plan({{Trouble{TroubleKind::kLoopCut}}});
  EXPECT_TRUE(comes(plan, 0.0));
  EXPECT_FALSE(comes(plan));
}

TEST(FaultPlan, CountsConnections) {
  FaultPlan plan({{Fault::kGoSilent, AtConnection{}, 2}});
  EXPECT_TRUE(plan.faults_at_connection().empty());
  EXPECT_EQ(plan.faults_at_connection().size(), 1U);
}

TEST(FaultPlan, FollowsTheTouchesThroughTheirPhases) {
  FaultPlan plan({{Trouble{TroubleKind::kCollision}, AtTouch{Phase::kSearch}, 2}});
  for (const std::uint32_t touch : {4U, 9U}) {
    for (const Phase phase :
         {Phase::kTravel, Phase::kApproach, Phase::kSearch, Phase::kSearch, Phase::kRetract}) {
      plan.on_touch_phase(touch, phase);
      const bool is_new = phase == Phase::kSearch && touch == 9;
      static bool met = false;
      EXPECT_EQ(comes(plan), is_new && !met);
      met = met || is_new;
    }
    plan.on_touch_phase(0, Phase::kIdle);
    EXPECT_FALSE(comes(plan));
  }
}

TEST(FaultPlan, APhaseThatIsNotReachedIsNotWaitedForInTheNextTouch) {
  FaultPlan plan({{Trouble{TroubleKind::kCollision}, AtTouch{Phase::kRetract}, 1}});
  plan.on_touch_phase(1, Phase::kTravel);
  plan.on_touch_phase(0, Phase::kIdle);
  plan.on_touch_phase(2, Phase::kTravel);
  plan.on_touch_phase(2, Phase::kRetract);
  EXPECT_FALSE(comes(plan));
}

TEST(FaultPlan, EveryTouchMeansOnceInEveryTouch) {
  FaultPlan plan({{.what = Trouble{TroubleKind::kVibration}, .on = AtTouch{Phase::kTravel}, .every = true}});
  for (std::uint32_t touch = 1; touch <= 3; ++touch) {  // one right behind the other
    plan.on_touch_phase(touch, Phase::kTravel);
    EXPECT_TRUE(comes(plan));
    plan.on_touch_phase(touch, Phase::kApproach);
    plan.on_touch_phase(touch, Phase::kTravel);
    EXPECT_FALSE(comes(plan));
  }
}

}  // namespace
}  // namespace sim
