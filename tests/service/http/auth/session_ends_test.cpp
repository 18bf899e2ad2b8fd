#include "service/http/auth/session_ends.hpp"

#include <gtest/gtest.h>

#include "service/base/utc_time.hpp"

namespace cell {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::system_clock::time_point kDated{12h};
constexpr std::chrono::steady_clock::time_point kFirstSeen{1h};

class SessionEndsTest : public ::testing::Test {
 protected:
  SessionEndsTest() { put_user(book_, {.name = "anna", .role = UserRole::kEngineer}); }
  void begin(std::chrono::system_clock::time_point now) { begin_session(book_, "anna", "digest", now); }
  enum class Seen { kValid, kOver, kGone };
  /// By a clock that says so, after this time of a clock that nobody sets.
  Seen seen(std::chrono::system_clock::time_point clock, std::chrono::milliseconds after) {
    const auto sessions = ends_.sessions_at(book_, clock, kFirstSeen + after);
    if (sessions.empty()) return Seen::kGone;
    return sessions.front().is_over ? Seen::kOver : Seen::kValid;
  }

  UserBook book_;
  SessionEnds ends_;
};

TEST_F(SessionEndsTest, ASessionIsOverAtItsEndAndMayStopForADay) {
  begin(kDated);
  EXPECT_EQ(seen(kDated, 0ms), Seen::kValid);
  EXPECT_EQ(ends_.sessions_at(book_, kDated, kFirstSeen).at(0).role, UserRole::kEngineer);
  EXPECT_EQ(seen(kDated + kSessionTime - 1ms, kSessionTime - 1ms), Seen::kValid);
  EXPECT_EQ(seen(kDated + kSessionTime, kSessionTime), Seen::kOver);
  const auto kept = kSessionTime + kOverSessionKept;
  EXPECT_EQ(seen(kDated + kept - 1ms, kept - 1ms), Seen::kOver);
  EXPECT_EQ(seen(kDated + kept, kept), Seen::kGone);
}

TEST_F(SessionEndsTest, AClockThatIsSetBackMakesNoSessionLonger) {
  begin(kDated);
  EXPECT_EQ(seen(kDated, 0ms), Seen::kValid);
  EXPECT_EQ(seen(kDated - 5h, kSessionTime - 1ms), Seen::kValid);
  EXPECT_EQ(seen(kDated - 5h, kSessionTime), Seen::kOver);
  EXPECT_EQ(seen(kDated - 5h, kSessionTime + kOverSessionKept), Seen::kGone);
}

TEST_F(SessionEndsTest, ASessionOfAClockThatStoodAheadIsNoLongerThanAnother) {
  begin(kDated + 100h);
  EXPECT_EQ(seen(kDated, 0ms), Seen::kValid) << "as after a restart";
  EXPECT_EQ(seen(kDated, kSessionTime), Seen::kOver);
}

TEST_F(SessionEndsTest, WhatWasSeenOverIsNotValidAgainWhateverTheClockSays) {
  begin(kDated);
  EXPECT_EQ(seen(kDated, 0ms), Seen::kValid);
  EXPECT_EQ(seen(kDated + kSessionTime, 1s), Seen::kOver);
  EXPECT_EQ(seen(kDated + 1s, 2s), Seen::kOver);
  EXPECT_EQ(seen(kDated + 1000h, 3s), Seen::kGone);
  EXPECT_EQ(seen(kDated + 1s, 4s), Seen::kOver) << "it may stop the arm again";
}

TEST_F(SessionEndsTest, WhatHasEndedIsForgotten) {
  begin(kDated);
  seen(kDated, 0ms);
  end_session(book_, "digest");
  EXPECT_EQ(seen(kDated, 1s), Seen::kGone);
  begin(kDated + 20h);
  EXPECT_EQ(seen(kDated + 20h, 20h), Seen::kValid) << "another one with the same digest";
}

}  // namespace
}  // namespace cell
