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

TEST(GuessCounts, WhoHasBeenQuietLongestMakesRoom) {
  GuessCounts counts;
  for (int i = 0; i < GuessCounts::kAtOnce; ++i) counts.add("oldest", kBegin);
  for (std::size_t i = 0; i < GuessCounts::kKeysMax; ++i) counts.add(std::to_string(i), kBegin + 1s);
  EXPECT_EQ(counts.size(), GuessCounts::kKeysMax);
  EXPECT_EQ(counts.wait("oldest", kBegin + 1s), 0s) << "forgotten";
}

}  // namespace
}  // namespace cell
