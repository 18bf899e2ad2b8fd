#include "sim_controller/val3_pace.hpp"

#include <gtest/gtest.h>

#include "sim_controller/controller.hpp"
#include "sim_controller/planned_move.hpp"

namespace sim {
namespace {

using std::chrono::milliseconds;
using Time = Val3Pace::TimePoint;

constexpr Time kBegin{std::chrono::hours(1)};

/// A pace and the simulated clock that it moves.
struct PacedRun {
  explicit PacedRun(double speed) : pace(speed, kBegin) {}

  /// Ticks until it waits, or `most` of them; asked in steps of a millisecond of wall time.
  int ticks_within(milliseconds wall, bool is_busy, int most = 1'000'000) {
    int ticks = 0;
    for (const Time end = now + wall; now <= end; now += milliseconds(1)) {
      while (ticks < most && pace.tick(is_busy, clock_s, now)) {
        clock_s += kTickSeconds;
        ++ticks;
      }
    }
    return ticks;
  }

  Val3Pace pace;
  Time now = kBegin;
  double clock_s = 0.0;
};

TEST(Val3Pace, GoesBySpeedWhileSomethingHappensAndByWallTimeElse) {
  for (const double speed : {0.5, 1.0, 10.0}) {
    PacedRun run(speed);
    EXPECT_NEAR(run.ticks_within(milliseconds(1000), true), 250 * speed, 3 * speed) << speed;
  }
  PacedRun fast(10.0);
  EXPECT_NEAR(fast.ticks_within(milliseconds(1000), false), 250, 3);
  PacedRun slow(0.5);
  EXPECT_NEAR(slow.ticks_within(milliseconds(1000), false), 125, 3);
}

TEST(Val3Pace, AsFastAsItCanIsWithoutEndWhileNoHostIsThere) {
  PacedRun run(kSpeedMax);
  EXPECT_EQ(run.ticks_within(milliseconds(0), true, 10'000), 10'000);
}

TEST(Val3Pace, WaitsForTheHostWhenAHeartbeatIsDue) {
  for (const double speed : {20.0, kSpeedMax}) {
    PacedRun run(speed);
    run.pace.host_connected(run.clock_s, run.now);
    run.ticks_within(milliseconds(100), true);
    EXPECT_NEAR(run.clock_s, Val3Pace::kHeartbeatSeconds, 1.01 * kTickSeconds);
    EXPECT_GT(run.pace.wake_at(), run.now);
    run.pace.host_heard(run.clock_s, run.now);
    run.ticks_within(milliseconds(100), true);
    EXPECT_NEAR(run.clock_s, 2.0 * Val3Pace::kHeartbeatSeconds, 2.02 * kTickSeconds);
  }
}

TEST(Val3Pace, GoesOnWithoutAHostThatIsSilentForTheHeartbeatTimeout) {
  PacedRun run(kSpeedMax);
  run.pace.host_connected(run.clock_s, run.now);
  run.pace.set_heartbeat_timeout(milliseconds(500));
  run.ticks_within(milliseconds(490), true);
  EXPECT_LT(run.clock_s, 0.11);
  EXPECT_EQ(run.pace.wake_at(), kBegin + milliseconds(500));
  EXPECT_EQ(run.ticks_within(milliseconds(20), true, 1000), 1000);
}

TEST(Val3Pace, AHostThatIsNotHeardAtWallTimeHoldsNothingUp) {
  PacedRun run(1.0);
  run.pace.host_connected(run.clock_s, run.now);
  EXPECT_NEAR(run.ticks_within(milliseconds(400), true), 100, 3);
}

TEST(Val3Pace, AHostThatLeftIsNotWaitedFor) {
  PacedRun run(kSpeedMax);
  run.pace.host_connected(run.clock_s, run.now);
  run.ticks_within(milliseconds(10), true);
  run.pace.host_left();
  EXPECT_EQ(run.ticks_within(milliseconds(10), true, 1000), 1000);
}

TEST(Val3Pace, AProgramThatWasHeldUpDoesNotCatchUpForEver) {
  PacedRun run(1.0);
  run.now += std::chrono::hours(1);
  EXPECT_LE(run.ticks_within(milliseconds(0), true), 27);
}

TEST(Val3Pace, WorkThatComesWhileNothingHappenedBeginsAtOnce) {
  PacedRun run(kSpeedMax);
  run.ticks_within(milliseconds(20), false);
  EXPECT_EQ(run.ticks_within(milliseconds(0), true, 1000), 1000);
}

}  // namespace
}  // namespace sim
