#include "calib_core/geometry/rotation.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace calib {
namespace {

void expect_turns(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double angle_rad) {
  const Eigen::Quaterniond turn = shortest_rotation(from, to);
  EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-15);
  EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(), angle_rad, 1e-15);
}

TEST(Rotation, TakesOneDirectionToTheOtherByTheAngleBetweenThem) {
  expect_turns(Eigen::Vector3d::UnitX(), {3.0, 3.0, 0.0}, std::numbers::pi / 4.0);
  expect_turns({0.0, 0.0, -2.0}, {0.1, 0.0, 0.0}, std::numbers::pi / 2.0);
}

TEST(Rotation, OfTheSameDirectionIsNone) { expect_turns({1.0, 2.0, 3.0}, {2.0, 4.0, 6.0}, 0.0); }

TEST(Rotation, OfOppositeDirectionsIsAHalfTurn) {
  expect_turns({1.0, 2.0, 3.0}, {-1.0, -2.0, -3.0}, std::numbers::pi);
}

}  // namespace
}  // namespace calib
