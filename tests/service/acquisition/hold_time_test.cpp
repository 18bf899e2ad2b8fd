#include "service/acquisition/hold_time.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

using namespace std::chrono_literals;

constexpr HoldTime::TimePoint kBegin{};

TEST(HoldTime, CountsFromTheFirstStandstillUntilTheArmGoesOn) {
  HoldTime hold;
  hold.on_entered(State::kExecute, kBegin);
  EXPECT_FALSE(hold.exceeds(0min, kBegin + 1h)) << "it moves";
  hold.on_entered(State::kHolding, kBegin + 1h);
  hold.on_entered(State::kHeld, kBegin + 1h + 1min);
  EXPECT_FALSE(hold.exceeds(30min, kBegin + 1h + 30min));
  EXPECT_TRUE(hold.exceeds(30min, kBegin + 1h + 30min + 1ms));
  hold.on_entered(State::kUnholding, kBegin + 2h);
  hold.on_entered(State::kExecute, kBegin + 2h);
  EXPECT_FALSE(hold.exceeds(0min, kBegin + 3h));
}

TEST(HoldTime, AResumptionThatFailsDoesNotBeginItAnew) {
  HoldTime hold;
  for (const State waits : {State::kSuspended, State::kUnsuspending, State::kHolding, State::kHeld,
                            State::kUnholding, State::kHolding, State::kHeld})
    hold.on_entered(waits, kBegin + (waits == State::kSuspended ? 0min : 29min));
  EXPECT_TRUE(hold.exceeds(30min, kBegin + 31min));
}

TEST(HoldTime, ARunThatIsOverHasNone) {
  HoldTime hold;
  hold.on_entered(State::kHeld, kBegin);
  hold.on_entered(State::kStopping, kBegin + 1min);
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
