#include "calib_core/estimation/repeat_sources.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "calib_core/numerics/uniform_chance.hpp"
#include "tests/calib_core/block_study.hpp"

namespace calib {
namespace {

// Face 0: 1 and 3 about 2, squares 2. Face 1: 10, 10, 13 about 11, squares 6. Three degrees of freedom; a
// touch has half of the variance of a difference.
TEST(TwoSpeedNoise, IsTheScatterAboutTheMeanOfEachFaceAndATouchHasHalfOfItsVariance) {
  const auto noise =
      two_speed_noise(std::vector<PairDifference>{{0, 1.0}, {1, 10.0}, {0, 3.0}, {1, 10.0}, {1, 13.0}});
  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->degrees_of_freedom, 3.0);
  EXPECT_NEAR(noise->std_m, std::sqrt(8.0 / 3.0 / 2.0), 1e-12);
}

TEST(TwoSpeedNoise, IsNothingOfOnePairAFaceNorOfCopies) {
  EXPECT_FALSE(two_speed_noise({}));
  EXPECT_FALSE(two_speed_noise(std::vector<PairDifference>{{0, 1.0}, {1, 2.0}, {2, 3.0}}));
  EXPECT_FALSE(two_speed_noise(std::vector<PairDifference>{{0, 0.0}, {0, 0.0}, {1, 0.0}, {1, 0.0}}));
}

TEST(TwoSpeedNoise, IsNotThatOfAFirstContactThatAKnockSetOff) {
  UniformChance chance(3);
  std::vector<PairDifference> pairs;
  for (int i = 0; i < 150; ++i) pairs.push_back({i % 5, 10.0 * (i % 5) + study::normal(chance)});
  const TouchNoise clean = two_speed_noise(pairs).value();
  EXPECT_EQ(clean.degrees_of_freedom, 145.0);
  EXPECT_NEAR(clean.std_m, std::sqrt(0.5), 0.1);
  pairs[17].difference_m += 60.0;
  const TouchNoise knocked = two_speed_noise(pairs).value();
  EXPECT_EQ(knocked.degrees_of_freedom, 144.0);
  EXPECT_NEAR(knocked.std_m / clean.std_m, 1.0, 0.02) << "it would be five times as large";
}

TEST(TouchedAgainNoise, IsHalfTheMeanSquareOfTheDifferences) {
  const auto noise = touched_again_noise(std::vector<PairDifference>{{0, 3.0}, {4, -4.0}});
  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->degrees_of_freedom, 2.0);
  EXPECT_NEAR(noise->std_m, 2.5, 1e-12);
  EXPECT_FALSE(touched_again_noise({}));
  EXPECT_FALSE(touched_again_noise(std::vector<PairDifference>{{0, 0.0}}));
}

RepeatSources sources(std::optional<TouchNoise> references, std::optional<TouchNoise> two_speed,
                      std::optional<TouchNoise> again = std::nullopt) {
  return {.reference_touches = {references}, .two_speed = {two_speed}, .touched_again = {again}};
}

/// Of this variance.
TouchNoise of_variance(double variance, double degrees) { return {std::sqrt(variance), degrees}; }

// Tables of F: the upper 5 % of (100, 8) are 2.97, so that the lower ones of (8, 100) are 0.337 and touches
// made anew are shown to have less than twice the noise of the pairs below a ratio of 4 * 0.337 = 1.35.
TEST(PureErrorOf, PoolsWhatAnFTestShowsToBeAlike) {
  RepeatSources alike = sources(of_variance(1.32, 8.0), of_variance(1.0, 100.0));
  const TouchNoise both = pure_error_of(alike, 0.0).value();
  EXPECT_EQ(both.degrees_of_freedom, 108.0);
  EXPECT_NEAR(both.std_m, std::sqrt((8.0 * 1.32 + 100.0) / 108.0), 1e-12);
  EXPECT_TRUE(alike.reference_touches.used && alike.two_speed.used);
  RepeatSources open = sources(of_variance(1.38, 8.0), of_variance(1.0, 100.0));
  EXPECT_EQ(pure_error_of(open, 0.0)->degrees_of_freedom, 8.0);
  EXPECT_TRUE(open.reference_touches.used && !open.two_speed.used);
}

TEST(PureErrorOf, DoesNotLetPairsThatSeeLessOutvoteTouchesMadeAnew) {
  RepeatSources blind = sources(of_variance(100.0, 8.0), of_variance(1.0, 130.0));
  EXPECT_NEAR(pure_error_of(blind, 20.0)->std_m, 10.0, 1e-12);
  EXPECT_EQ(pure_error_of(blind, 20.0)->degrees_of_freedom, 8.0);
  EXPECT_FALSE(blind.two_speed.used);
}

TEST(PureErrorOf, DoesNotTakeWhatThreeReferenceTouchesCannotTellApartForAgreement) {
  constexpr int kRuns = 2000;
  UniformChance chance(5);
  int pooled = 0;
  for (int run = 0; run < kRuns; ++run) {
    RepeatSources few =
        sources(TouchNoise{10.0 * std::abs(study::normal(chance)), 1.0}, TouchNoise{1.0, 100.0});
    (void)pure_error_of(few, 20.0);
    pooled += few.two_speed.used ? 1 : 0;
  }
  EXPECT_LT(pooled, 0.02 * kRuns);
}

TEST(PureErrorOf, CountsAQualificationWithWhatTheRunMadeAnewWhereItIsAlikeAndAloneWhereThereIsNothingElse) {
  RepeatSources alike = sources(of_variance(1.0, 8.0), std::nullopt);
  alike.qualification.noise = of_variance(1.5, 9.0);
  EXPECT_EQ(pure_error_of(alike, 0.0)->degrees_of_freedom, 16.0) << "no more than its own again";
  EXPECT_NEAR(pure_error_of(alike, 0.0)->std_m, std::sqrt((1.0 + 1.5) / 2.0), 1e-12);
  EXPECT_TRUE(alike.qualification.used);
  RepeatSources other = sources(of_variance(100.0, 8.0), std::nullopt);
  other.qualification.noise = of_variance(1.0, 9.0);
  EXPECT_EQ(pure_error_of(other, 0.0)->degrees_of_freedom, 8.0);
  EXPECT_TRUE(other.reference_touches.used && !other.qualification.used);
  RepeatSources alone = sources(std::nullopt, std::nullopt);
  alone.qualification.noise = of_variance(4.0, 9.0);
  EXPECT_EQ(pure_error_of(alone, 0.0)->std_m, 2.0);
}

// The upper 2.5 % of F (100, 8) are 3.74.
TEST(PureErrorOf, IsThatOfThePairsWhereTouchesMadeAnewAgreeByChance) {
  RepeatSources lucky = sources(of_variance(1.0, 8.0), of_variance(3.9, 100.0));
  EXPECT_NEAR(pure_error_of(lucky, 0.0)->std_m, std::sqrt(3.9), 1e-12);
  EXPECT_TRUE(lucky.two_speed.used && !lucky.reference_touches.used);
  RepeatSources open = sources(of_variance(1.0, 8.0), of_variance(3.6, 100.0));
  EXPECT_EQ(pure_error_of(open, 0.0)->degrees_of_freedom, 108.0) << "not told apart, and surely not twice it";
}

TEST(PureErrorOf, PairsAloneSayOnlyThatTheDeclaredNoiseIsTooSmall) {
  RepeatSources alone = sources(std::nullopt, TouchNoise{1.0, 100.0});
  EXPECT_FALSE(pure_error_of(alone, 20.0)) << "a lower bound";
  EXPECT_FALSE(pure_error_of(alone, 0.0)) << "of something unknown";
  EXPECT_FALSE(alone.two_speed.used);
  EXPECT_EQ(pure_error_of(alone, 0.5)->degrees_of_freedom, 100.0);
  EXPECT_TRUE(alone.two_speed.used);
}

// The upper 2.5 % of F (1, 10) are 6.94.
TEST(PureErrorOf, CountsTouchesMadeAgainBesideReferenceTouchesUnlessTheyStandOut) {
  RepeatSources agree = sources(of_variance(1.0, 10.0), std::nullopt, of_variance(6.8, 1.0));
  EXPECT_NEAR(pure_error_of(agree, 0.0)->std_m, std::sqrt(16.8 / 11.0), 1e-12);
  RepeatSources apart = sources(of_variance(1.0, 10.0), std::nullopt, of_variance(7.1, 1.0));
  EXPECT_EQ(pure_error_of(apart, 0.0)->degrees_of_freedom, 10.0);
  EXPECT_TRUE(apart.reference_touches.used && !apart.touched_again.used);
  RepeatSources alone = sources(std::nullopt, std::nullopt, of_variance(7.1, 1.0));
  EXPECT_TRUE(pure_error_of(alone, 0.0));
  EXPECT_TRUE(alone.touched_again.used);
}

TEST(PureErrorOf, IsNothingOfNothing) {
  RepeatSources none;
  EXPECT_FALSE(pure_error_of(none, 20.0));
  EXPECT_FALSE(none.reference_touches.used || none.two_speed.used || none.touched_again.used);
}

}  // namespace
}  // namespace calib
