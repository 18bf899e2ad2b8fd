#include "config/utc_text.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

using namespace std::chrono_literals;

TEST(UtcText, IsATimeOfTheClock) {
  EXPECT_EQ(time_from_utc("1970-01-01T00:00:00Z"), std::chrono::system_clock::time_point{});
  const std::chrono::sys_days day = std::chrono::year(2028) / 2 / 29;
  EXPECT_EQ(time_from_utc("2028-02-29T23:59:59.250Z"), day + 23h + 59min + 59s + 250ms);
  EXPECT_EQ(time_from_utc("2028-02-29T23:59:59.2Z"), day + 23h + 59min + 59s + 200ms);
  EXPECT_EQ(time_from_utc("2028-02-29T08:00:00.123456789Z"), day + 8h + 123ms);
}

TEST(UtcText, OfAnotherShapeOrOfNoDayIsNone) {
  for (const char* text : {"",
                           "Z",
                           "2026-01-31",
                           "2026-01-31T08:15:30",
                           "2026-01-31T08:15:30+01:00",
                           "2026-01-31 08:15:30Z",
                           "2026-01-31t08:15:30Z",
                           "2026-1-31T08:15:30Z",
                           "2026-01-31T08:15:30.Z",
                           "2026-01-31T08:15:30.25",
                           "2026-01-31T08:15:30.x5Z",
                           "2026-01-31T08:15:30.1234567890Z",
                           "2026-01-31T08:15:30Z ",
                           "2026-02-29T08:15:30Z",
                           "2026-13-01T08:15:30Z",
                           "2026-00-01T08:15:30Z",
                           "2026-01-31T24:00:00Z",
                           "2026-01-31T08:60:00Z",
                           "2026-01-31T08:15:60Z",
                           "1969-12-31T23:59:59Z",
                           "2200-01-01T00:00:00Z",
                           "-026-01-31T08:15:30Z"})
    EXPECT_FALSE(time_from_utc(text)) << text;
}

}  // namespace
}  // namespace cell
