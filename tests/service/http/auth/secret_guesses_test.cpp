#include "service/http/auth/secret_guesses.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cell {
namespace {

using namespace std::chrono_literals;
using Guess = SecretGuesses::Guess;

constexpr SecretGuesses::TimePoint kFirstGuess{1h};

class SecretGuessesTest : public ::testing::Test {
 protected:
  bool may(const Guess& guess, SecretGuesses::TimePoint now = kFirstGuess) const {
    return guesses_.wait_of_name(guess, now) == 0s && guesses_.wait_of_network(guess, now) == 0s;
  }
  /// How many of so many names from one network may be tried, each with a wrong secret.
  int tried_of(int count, const std::string& network, SecretGuesses::TimePoint now = kFirstGuess) {
    int tried = 0;
    for (int i = 0; i < count; ++i) {
      const Guess guess{.network = network, .name = "made up " + std::to_string(made_up_++)};
      if (!may(guess, now)) continue;
      static_cast<void>(guesses_.begin(guess, now));
      ++tried;
    }
    return tried;
  }

  SecretGuesses guesses_;
  int made_up_ = 0;
};

TEST_F(SecretGuessesTest, MadeUpNamesOfOneNetworkAreRefusedBeforeAHashAndThoseOfOthersAreNot) {
  EXPECT_EQ(tried_of(1000, "flood"), GuessCounts::kAtOnce);
  EXPECT_EQ(tried_of(1000, "flood", kFirstGuess + GuessCounts::kForgetOne), 1) << "one a minute";
  EXPECT_TRUE(may({.network = "another", .name = "otto"}));
}

TEST_F(SecretGuessesTest, ANameThatIsTriedAlreadyWaitsForItselfAlone) {
  const Guess otto{.network = "a", .name = "otto"};
  for (int i = 0; i < GuessCounts::kAtOnce; ++i) {
    ASSERT_TRUE(may(otto)) << i;
    static_cast<void>(guesses_.begin(otto, kFirstGuess));
    tried_of(10, "a");
  }
  EXPECT_GT(guesses_.wait_of_name(otto, kFirstGuess), 0s);
  EXPECT_EQ(guesses_.wait_of_network(otto, kFirstGuess), 0s);
}

TEST_F(SecretGuessesTest, WhoHasSignedInFromThereOrShowsATokenIsNotHeldUpByAFlood) {
  const Guess eva{.network = "a", .name = "eva"};
  guesses_.was_right(guesses_.begin(eva, kFirstGuess));
  EXPECT_EQ(tried_of(1000, "a"), GuessCounts::kAtOnce) << "the right one has cost nothing";
  EXPECT_TRUE(may(eva));
  EXPECT_FALSE(may({.network = "a", .name = "otto"})) << "nobody learns whether there is one";
  EXPECT_TRUE(may({.network = "a", .name = "otto", .is_known = true}));
}

TEST_F(SecretGuessesTest, WhatWasNotComparedDoesNotCountAndForgivesNothing) {
  const Guess otto{.network = "a", .name = "otto"};
  for (int i = 0; i < 100; ++i) guesses_.was_none(guesses_.begin(otto, kFirstGuess));
  EXPECT_TRUE(may(otto));
  EXPECT_EQ(tried_of(1000, "a"), GuessCounts::kAtOnce);
  for (int i = 0; i < GuessCounts::kAtOnce - 1; ++i)
    static_cast<void>(guesses_.begin({.network = "b", .name = "otto"}, kFirstGuess));
  guesses_.was_none(guesses_.begin({.network = "b", .name = "otto"}, kFirstGuess));
  EXPECT_TRUE(may({.network = "b", .name = "otto"}));
  static_cast<void>(guesses_.begin({.network = "b", .name = "otto"}, kFirstGuess));
  EXPECT_FALSE(may({.network = "b", .name = "otto"})) << "those before it still count";
}

}  // namespace
}  // namespace cell
