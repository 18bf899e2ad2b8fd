#include "service/offline_programs/trsf_pose.hpp"

#include <gmock/gmock.h>

#include <random>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

void expect_near(const SixNumbers& found, const SixNumbers& wanted, double within) {
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i], wanted[i], within) << kTrsfNames[i];
}

// R = Rx Ry Rz: turned about z by a quarter, x becomes y; then tilted about the first x.
TEST(TrsfPose, TurnsAboutXThenTheNewYThenTheNewZ) {
  const Eigen::Isometry3d pose = pose_of_trsf({1, 2, 3, 90, 0, 90}, 1.0);
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1e-3, 2e-3, 3e-3)));
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitY()));
}

TEST(TrsfPose, GivesBackTheNumbersOfEveryWriting) {
  std::mt19937_64 chance(7);
  std::uniform_real_distribution<double> length(-2000, 2000), angle(-500, 500);
  for (int i = 0; i < 2000; ++i) {
    const SixNumbers trsf{length(chance), length(chance), length(chance),
                          angle(chance),  angle(chance),  angle(chance)};
    expect_near(trsf_of_pose(pose_of_trsf(trsf, 25.4), trsf, 25.4), trsf, 1e-9);
  }
}

TEST(TrsfPose, KeepsTheFirstAngleWhereTwoTurnAboutOneAxis) {
  for (const double ry : {90.0, -90.0, 270.0}) {
    const SixNumbers trsf{1, 2, 3, 33, ry, -77};
    expect_near(trsf_of_pose(pose_of_trsf(trsf, 1.0), trsf, 1.0), trsf, 1e-9);
    const SixNumbers turned{1, 2, 3, 33, ry, -76};
    expect_near(trsf_of_pose(pose_of_trsf(turned, 1.0), trsf, 1.0), turned, 1e-9);
  }
}

TEST(TrsfPose, ChangesAsLittleAsItCan) {
  const SixNumbers near{0, 0, 0, 180, 0, 0};
  expect_near(trsf_of_pose(pose_of_trsf({0, 0, 0, -179.9, 0, 0}, 1.0), near, 1.0), {0, 0, 0, 180.1, 0, 0},
              1e-9);
}

}  // namespace
}  // namespace cell
