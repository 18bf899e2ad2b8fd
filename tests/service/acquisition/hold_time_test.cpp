#include "service/acquisition/hold_time.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

using namespace std::chrono_literals;

constexpr HoldTime::TimePoint kBegin{};

TEST(HoldTime, CountsFromTheFirstStandstillUntilTheArmGoesOn) {
  HoldTime hold;
  hold.on_entered(State::kExecute, 7, kBegin);
  EXPECT_FALSE(hold.exceeds(0min, kBegin + 1h)) << "it moves";
  hold.on_entered(State::kHolding, 7, kBegin + 1h);
  hold.on_entered(State::kHeld, 7, kBegin + 1h + 1min);
  EXPECT_FALSE(hold.exceeds(30min, kBegin + 1h + 30min));
  EXPECT_TRUE(hold.exceeds(30min, kBegin + 1h + 30min + 1ms));
  hold.on_entered(State::kUnholding, 7, kBegin + 2h);
  hold.on_entered(State::kExecute, 7, kBegin + 2h);
  EXPECT_FALSE(hold.exceeds(0min, kBegin + 3h));
}

TEST(HoldTime, AMomentOfExecuteWithoutATouchDoesNotBeginItAnew) {
  HoldTime hold;
  for (const auto at : {0min, 9min, 18min, 27min}) {  // resumed, and paused before the next touch
    hold.on_entered(State::kHolding, 7, kBegin + at);
    hold.on_entered(State::kHeld, 7, kBegin + at);
    hold.on_entered(State::kUnholding, 7, kBegin + at + 8min);
    hold.on_entered(State::kExecute, 7, kBegin + at + 8min);
  }
  hold.on_entered(State::kHolding, 7, kBegin + 28min);
  EXPECT_TRUE(hold.exceeds(HoldTime::kReferenceMax, kBegin + 28min));
  EXPECT_FALSE(hold.exceeds(30min, kBegin + 30min));
  EXPECT_TRUE(hold.exceeds(30min, kBegin + 30min + 1ms));
}

TEST(HoldTime, ATouchBeginsItAnew) {
  HoldTime hold;
  hold.on_entered(State::kHeld, 7, kBegin);
  hold.on_entered(State::kUnholding, 7, kBegin + 29min);
  hold.on_entered(State::kExecute, 7, kBegin + 29min);
  hold.on_entered(State::kHolding, 7, kBegin + 30min);  // a pause: the touch under way is made
  hold.on_entered(State::kHeld, 8, kBegin + 31min);
  EXPECT_FALSE(hold.exceeds(30min, kBegin + 61min));
  EXPECT_TRUE(hold.exceeds(30min, kBegin + 61min + 1ms));
}

TEST(HoldTime, APermitIsNotOlderThanItsConfirmation) {
  HoldTime hold;
  hold.on_entered(State::kHeld, 7, kBegin);
  hold.on_entered(State::kUnholding, 7, kBegin + 1h);
  EXPECT_TRUE(hold.outlives_permit(30min, kBegin + 1h));
  hold.on_confirmed(kBegin + 1h);
  hold.on_entered(State::kExecute, 7, kBegin + 1h);
  hold.on_entered(State::kHeld, 7, kBegin + 1h + 1min);
  EXPECT_TRUE(hold.exceeds(30min, kBegin + 1h + 1min)) << "the reference place was not touched meanwhile";
  EXPECT_FALSE(hold.outlives_permit(30min, kBegin + 1h + 30min));
  EXPECT_TRUE(hold.outlives_permit(30min, kBegin + 1h + 30min + 1ms));
}

TEST(HoldTime, ATouchThatIsWithdrawnIsNoTouch) {
  HoldTime hold;
  hold.on_entered(State::kExecute, 6, kBegin - 1min);
  hold.on_entered(State::kHeld, 8, kBegin);
  hold.on_entered(State::kUnholding, 8, kBegin + 29min);
  hold.on_entered(State::kExecute, 7, kBegin + 29min);  // it was skipped
  hold.on_entered(State::kHeld, 7, kBegin + 29min);
  EXPECT_TRUE(hold.exceeds(30min, kBegin + 31min));
  hold.on_entered(State::kExecute, 7, kBegin + 31min);
  hold.on_entered(State::kHeld, 8, kBegin + 32min);
  EXPECT_FALSE(hold.exceeds(30min, kBegin + 33min)) << "one was made";
}

TEST(HoldTime, AResumptionThatFailsDoesNotBeginItAnew) {
  HoldTime hold;
  for (const State waits : {State::kSuspended, State::kUnsuspending, State::kHolding, State::kHeld,
                            State::kUnholding, State::kHolding, State::kHeld})
    hold.on_entered(waits, 7, kBegin + (waits == State::kSuspended ? 0min : 29min));
  EXPECT_TRUE(hold.exceeds(30min, kBegin + 31min));
}

TEST(HoldTime, ARunThatIsOverHasNone) {
  HoldTime hold;
  hold.on_entered(State::kHeld, 7, kBegin);
  hold.on_entered(State::kStopping, 7, kBegin + 1min);
  EXPECT_FALSE(hold.exceeds(0min, kBegin + 1h));
}

TEST(WorkTime, IsThatOfTouchingWithoutTheHolds) {
  WorkTime worked(10s);
  worked.on_entered(State::kHeld, kBegin);
  EXPECT_EQ(worked.until(kBegin + 1h), 10s);
  worked.on_entered(State::kUnholding, kBegin + 1h);
  worked.on_entered(State::kExecute, kBegin + 1h + 5s);
  EXPECT_EQ(worked.until(kBegin + 1h + 8s), 13s);
  worked.on_entered(State::kHolding, kBegin + 1h + 9s);
  worked.on_entered(State::kHeld, kBegin + 1h + 10s);
  worked.on_entered(State::kExecute, kBegin + 3h);
  worked.on_entered(State::kCompleting, kBegin + 3h + 1s);
  EXPECT_EQ(worked.until(kBegin + 3h + 2s), 16s);
}

}  // namespace
}  // namespace cell
