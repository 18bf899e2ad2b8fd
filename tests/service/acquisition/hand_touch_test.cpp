#include "service/acquisition/hand_touch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cell {
namespace {

constexpr double kDeclaredMetres = 20e-6;

HandTouch moved(double metres) { return {.moved_m = metres}; }

TEST(HandTouchNoise, IsThatOfTheWayBetweenTheReadingsWithThatOfATrip) {
  EXPECT_DOUBLE_EQ(own_noise_um(moved(0.2e-3), kDeclaredMetres).value(), 117.2);
  EXPECT_DOUBLE_EQ(own_noise_um(moved(0.04e-3), kDeclaredMetres).value(), 30.6);
}

TEST(HandTouchNoise, IsNoOtherForATouchWithoutAWay) {
  EXPECT_FALSE(own_noise_um(moved(0.0), kDeclaredMetres));
  EXPECT_FALSE(own_noise_um(moved(1e-6), kDeclaredMetres)) << "it rounds to the declared noise";
  EXPECT_FALSE(own_noise_um({}, kDeclaredMetres)) << "a touch that was taken by word";
  EXPECT_FALSE(own_noise_um(moved(0.2e-3), 0.0)) << "there is nothing to weigh it against";
}

}  // namespace
}  // namespace cell
