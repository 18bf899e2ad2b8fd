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

cs8::State standing_at(std::uint32_t flags) {
  cs8::State state;
  state.flags = flags;
  state.joints = {1'000'000, 2'000'000, 3'000'000, 4'000'000, 5'000'000, 6'000'000};
  return state;
}

TEST(HandTouchWatch, AWordTakesThePositionOfAnArmThatStandsWhateverTheProbeReads) {
  HandTouchWatch watch{calib::KinematicModel{}};
  EXPECT_EQ(std::get<std::string>(watch.take_by_word()),
            "the controller has not reported the arm's position");
  watch.on_controller_state(standing_at(cs8::kArmCalibrated));
  EXPECT_EQ(std::get<std::string>(watch.take_by_word()), "the arm moves: stop it first");
  watch.on_controller_state(standing_at(cs8::kSettled));
  EXPECT_EQ(std::get<std::string>(watch.take_by_word()),
            "the joints are not referenced: reference the arm first");
  watch.on_controller_state(standing_at(cs8::kArmCalibrated | cs8::kSettled));
  const auto taken = std::get<HandTouch>(watch.take_by_word());
  EXPECT_EQ(taken.wire_joints[5], 6'000'000);
  EXPECT_FALSE(taken.moved_m);
}

}  // namespace
}  // namespace cell
