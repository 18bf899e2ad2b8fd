#include "service/http/auth/wrong_tokens.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

using namespace std::chrono_literals;

constexpr WrongTokens::TimePoint kStart{1h};

class WrongTokensTest : public ::testing::Test {
 protected:
  bool guess(const std::string& remote, WrongTokens::TimePoint now = kStart) {
    return wrong_.is_too_often(remote, now);
  }
  void guess_much(const std::string& remote, int count = 1000) {
    for (int i = 0; i < count; ++i) guess(remote);
  }

  WrongTokens wrong_;
};

TEST_F(WrongTokensTest, SomeAreAnsweredAtOnceThenOneAMinute) {
  for (int i = 0; i < WrongTokens::kAtOnce; ++i) EXPECT_FALSE(guess("192.0.2.1")) << i;
  EXPECT_TRUE(guess("192.0.2.1"));
  EXPECT_FALSE(guess("192.0.2.2")) << "another address";
  EXPECT_TRUE(guess("192.0.2.1", kStart + WrongTokens::kForgetOne)) << "that was the sixth";
  EXPECT_FALSE(guess("192.0.2.1", kStart + 3 * WrongTokens::kForgetOne));
  EXPECT_TRUE(guess("192.0.2.1", kStart + 3 * WrongTokens::kForgetOne));
}

TEST_F(WrongTokensTest, HoweverManyTheyAreForgottenInTime) {
  guess_much("192.0.2.1");
  EXPECT_TRUE(guess("192.0.2.1", kStart + WrongTokens::kForgetAllMax / 2));
  const auto later = kStart + 2 * WrongTokens::kForgetAllMax;
  for (int i = 0; i < WrongTokens::kAtOnce; ++i) EXPECT_FALSE(guess("192.0.2.1", later)) << i;
}

TEST_F(WrongTokensTest, AnIpv6NetworkIsOneGuesser) {
  for (int i = 0; i < WrongTokens::kAtOnce; ++i) guess("2001:db8::" + std::to_string(i + 1));
  EXPECT_TRUE(guess("2001:db8::ffff"));
  EXPECT_TRUE(guess("2001:db8:0:0:1:2:3:4"));
  EXPECT_FALSE(guess("2001:db8:0:1::1"));
  EXPECT_EQ(wrong_.network_count(), 2U);
}

TEST_F(WrongTokensTest, ManyAddressesForgetWhoGuessedLeastAndNotAll) {
  const auto address = [](int i) {
    return "10.0." + std::to_string(i / 256) + "." + std::to_string(i % 256);
  };
  guess_much("192.0.2.1");
  guess_much("192.0.2.2");
  for (int i = 0; i < 5000; ++i) {
    const auto now = kStart + std::chrono::milliseconds(i + 1);
    guess(address(i), now);
    EXPECT_TRUE(guess("192.0.2.2", now)) << i;
  }
  EXPECT_EQ(wrong_.network_count(), WrongTokens::kNetworksMax);
  EXPECT_TRUE(guess("192.0.2.1", kStart + 6s)) << "it is not rid of its guesses by those of others";
  EXPECT_FALSE(guess(address(0), kStart + 6s));
}

TEST_F(WrongTokensTest, WhatIsNoAddressIsCountedTooAndTakesOnePlace) {
  guess_much("unix");
  EXPECT_TRUE(guess("unix"));
  EXPECT_EQ(wrong_.network_count(), 1U);
}

}  // namespace
}  // namespace cell
