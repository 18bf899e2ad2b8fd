#include "service/http/auth/hash_places.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cell {
namespace {

using Taken = std::vector<std::optional<HashPlaces::Place>>;

TEST(HashPlaces, AFloodFromOneNetworkLeavesPlacesForOthers) {
  HashPlaces places;
  Taken flood;
  for (int i = 0; i < 100; ++i) flood.push_back(places.take_as_stranger("flood"));
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(flood[static_cast<std::size_t>(i)].has_value(), i < HashPlaces::kOfNetwork) << i;
  EXPECT_TRUE(places.take_as_stranger("another"));
}

TEST(HashPlaces, FloodsFromManyNetworksLeavePlacesForWhoShowsAToken) {
  HashPlaces places;
  Taken floods;
  for (int i = 0; i < HashPlaces::kOfStrangers; ++i) {
    floods.push_back(places.take_as_stranger(std::to_string(i)));
    EXPECT_TRUE(floods.back()) << i;
  }
  EXPECT_FALSE(places.take_as_stranger("one more"));
  Taken of_tokens;
  for (int i = 0; i < HashPlaces::kOfTokens; ++i) {
    of_tokens.push_back(places.take_by_token());
    EXPECT_TRUE(of_tokens.back()) << i;
  }
  EXPECT_FALSE(places.take_by_token());
}

TEST(HashPlaces, APlaceIsFreeAgainAtTheEndOfItsScope) {
  HashPlaces places;
  for (int i = 0; i < 3; ++i) {
    Taken taken;
    for (int k = 0; k < HashPlaces::kOfNetwork; ++k) taken.push_back(places.take_as_stranger("a"));
    ASSERT_TRUE(taken.back()) << i;
    EXPECT_FALSE(places.take_as_stranger("a")) << i;
    const auto by_token = places.take_by_token();
    EXPECT_TRUE(by_token) << i;
  }
}

}  // namespace
}  // namespace cell
