#include "calib_core/motion/transfer_path.hpp"

#include <gtest/gtest.h>

#include "calib_core/motion/swept_collision.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr double kClearanceMetres = 0.012;

class Transfer : public testing::Test {
 protected:
  void expect_clear(const JointVector& from, const std::vector<JointVector>& between,
                    const JointVector& to) const {
    JointVector at = from;
    auto stops = between;
    stops.push_back(to);
    for (const JointVector& next : stops) {
      EXPECT_FALSE(find_clash_on_move(scene_, model_, at, next, kClearanceMetres));
      at = next;
    }
  }

  KinematicModel model_ = paper::nominal();
  CollisionScene scene_ = tx90::scene(0.003);
  JointVector park_ = tx90::park_joints();
  TransferSpace space_{model_, scene_, park_, kClearanceMetres};
  // On either side of the block, lower than its top.
  JointVector left_ = tx90::degrees(-30, 15, 90, 0, 70, 0);
  JointVector right_ = tx90::degrees(30, 15, 90, 0, 70, 0);
};

TEST_F(Transfer, IsEmptyWhenTheDirectMoveIsClear) {
  const auto way = find_path(space_, park_, tx90::degrees(40, -10, 60, 20, 80, 0));
  ASSERT_TRUE(way);
  EXPECT_TRUE(way->empty());
}

TEST_F(Transfer, GoesOverTheBlockWhenItStandsInTheWay) {
  ASSERT_TRUE(find_clash_on_move(scene_, model_, left_, right_, kClearanceMetres));
  const auto way = find_path(space_, left_, right_);
  ASSERT_TRUE(way);
  EXPECT_FALSE(way->empty());
  EXPECT_LE(way->size(), kTransferPosturesMax);
  expect_clear(left_, *way, right_);
}

TEST_F(Transfer, LeadsFromOnePostureNearParkToAnyOther) {
  ASSERT_TRUE(can_reach_park(space_, left_));
  ASSERT_TRUE(can_reach_park(space_, right_));
  for (const auto& [from, to] :
       {std::pair(left_, right_), std::pair(right_, left_), std::pair(park_, left_)}) {
    const auto way = find_path(space_, from, to);
    ASSERT_TRUE(way);
    expect_clear(from, *way, to);
  }
}

TEST_F(Transfer, FindsNoWayOutOfACage) {
  const Eigen::Vector3d tip = forward_kinematics(model_, left_).translation();
  scene_.obstacles.push_back(
      {"cage", tip + Eigen::Vector3d(-0.3, -0.1, -0.3), tip + Eigen::Vector3d(0.3, -0.09, 0.3)});
  const TransferSpace caged(model_, scene_, park_, kClearanceMetres);
  EXPECT_FALSE(find_path(caged, left_, right_));
  EXPECT_FALSE(can_reach_park(caged, left_));
}

TEST_F(Transfer, FindsNoWayFromAStartInsideTheClearance) {
  const JointVector near_table = tx90::degrees(0, 60, 90, 0, 0, 0);
  ASSERT_TRUE(find_clash(scene_, forward_chain(model_, near_table), kClearanceMetres));
  EXPECT_FALSE(find_path(space_, near_table, park_));
}

}  // namespace
}  // namespace calib
