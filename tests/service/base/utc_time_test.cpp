#include "service/base/utc_time.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

using namespace std::chrono_literals;
using std::chrono::sys_days;

TEST(UtcTime, HasMillisecondsAndTwoDigitsEach) {
  EXPECT_EQ(format_utc(sys_days{}), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(format_utc(sys_days{2026y / 1 / 31} + 8h + 15min + 30s + 250ms), "2026-01-31T08:15:30.250Z");
}

TEST(UtcTime, LeapDaysAndTheLastMillisecondOfAYearAreRight) {
  EXPECT_EQ(format_utc(sys_days{2028y / 2 / 28} + 24h), "2028-02-29T00:00:00.000Z");
  EXPECT_EQ(format_utc(sys_days{2027y / 1 / 1} - 1ms), "2026-12-31T23:59:59.999Z");
}

TEST(UtcTime, LessThanAMillisecondIsCutNeverRoundedIntoTheFuture) {
  EXPECT_EQ(format_utc(sys_days{2026y / 1 / 1} + 999999us), "2026-01-01T00:00:00.999Z");
  EXPECT_EQ(format_utc(sys_days{1970y / 1 / 1} - 1us), "1969-12-31T23:59:59.999Z");
}

TEST(UtcTime, HasComeAtItsOwnMillisecondAndNeverWhereNoneWasSet) {
  const auto at = sys_days{2026y / 12 / 31} + 23h;
  EXPECT_FALSE(has_come(format_utc(at), at - 1ms));
  EXPECT_TRUE(has_come(format_utc(at), at));
  EXPECT_TRUE(has_come(format_utc(at), at + 2h)) << "in the next year";
  EXPECT_FALSE(has_come(std::nullopt, at));
}

}  // namespace
}  // namespace cell
