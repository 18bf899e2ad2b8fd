#include "service/http/auth/guess_counts.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

using namespace std::chrono_literals;

constexpr GuessCounts::TimePoint kBegin{1h};

TEST(GuessCounts, TheWaitIsUntilOneMoreIsForgiven) {
  GuessCounts counts;
  EXPECT_EQ(counts.wait("a", kBegin), 0s) << "who has not guessed";
  for (int i = 1; i < GuessCounts::kAtOnce; ++i) {
    EXPECT_FALSE(counts.add("a", kBegin));
    EXPECT_EQ(counts.wait("a", kBegin), 0s) << i;
  }
  EXPECT_FALSE(counts.add("a", kBegin));
  EXPECT_EQ(counts.wait("a", kBegin), GuessCounts::kForgetOne);
  EXPECT_EQ(counts.wait("a", kBegin + 20s), GuessCounts::kForgetOne - 20s);
  EXPECT_EQ(counts.wait("a", kBegin + GuessCounts::kForgetOne), 0s);
  EXPECT_EQ(counts.wait("b", kBegin), 0s) << "somebody else";
}

TEST(GuessCounts, AFloodIsForgottenInTimeAndARightGuessAtOnce) {
  GuessCounts counts;
  for (int i = 0; i < 1000; ++i) counts.add("a", kBegin);
  EXPECT_EQ(counts.wait("a", kBegin),
            GuessCounts::kForgetAllMax - (GuessCounts::kAtOnce - 1) * GuessCounts::kForgetOne);
  counts.forgive("a");
  EXPECT_EQ(counts.wait("a", kBegin), 0s);
}

TEST(GuessCounts, WhoIsForgottenSoonestMakesRoomAndNotWhoGuessedMost) {
  GuessCounts counts;
  for (int i = 0; i < GuessCounts::kAtOnce; ++i) counts.add("guesser", kBegin);
  for (std::size_t i = 0; i < 2 * GuessCounts::kKeysMax; ++i) counts.add(std::to_string(i), kBegin + 1s);
  EXPECT_EQ(counts.size(), GuessCounts::kKeysMax);
  EXPECT_GT(counts.wait("guesser", kBegin + 1s), 0s) << "made-up keys do not free it";
  EXPECT_TRUE(counts.knows("guesser", kBegin + 1s));
  EXPECT_FALSE(counts.knows("0", kBegin + 1s));
}

TEST(GuessCounts, OneThatIsTakenBackIsOneLess) {
  GuessCounts counts;
  for (int i = 0; i < GuessCounts::kAtOnce; ++i) counts.add("a", kBegin);
  counts.take_back("a");
  counts.take_back("nobody");
  EXPECT_EQ(counts.wait("a", kBegin), 0s);
  counts.add("a", kBegin);
  EXPECT_EQ(counts.wait("a", kBegin), GuessCounts::kForgetOne);
}

/// What the class tells of six digits.
TEST(GuessCounts, ADayLetsOneInSevenHundredPinsOfSixDigitsBeTried) {
  GuessCounts counts;
  int tried = 0;
  const auto day = kBegin + 24h;
  for (auto now = kBegin; now < day; now += 1s) {
    for (; counts.wait("a", now) == 0s; ++tried) counts.add("a", now);
  }
  EXPECT_NEAR(tried, 1445, 5);
}

}  // namespace
}  // namespace cell
