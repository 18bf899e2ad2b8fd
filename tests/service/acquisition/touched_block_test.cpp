#include "service/acquisition/touched_block.hpp"

#include <gtest/gtest.h>

#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/block_location_bench.hpp"

namespace cell {
namespace {

TouchedBlock touched_at_all_spots(const Cell& cell, const std::optional<BlockPose>& before) {
  TouchedBlock block{Locating(cell), std::nullopt};
  for (const PlaceSpot& spot : place_spots(cell)) {
    EXPECT_FALSE(block.found);
    const calib::JointVector joints = at(spot);
    block.take({to_wire(joints), joints, 1e-5}, cell, before);
  }
  return block;
}

TEST(TouchedBlock, IsFoundBehindTheLastTouchAndNotWithoutIt) {
  TouchedBlock block = touched_at_all_spots(cell_of_owners(), std::nullopt);
  ASSERT_TRUE(block.found);
  EXPECT_EQ(block.found->place.touches.size(), place_spots(cell_of_owners()).size());
  EXPECT_LT(block.found->place.cell_from_block.translation().norm(), 1e-3);
  EXPECT_TRUE(std::holds_alternative<std::vector<calib::JointVector>>(block.found->pass));
  block.undo();
  EXPECT_FALSE(block.found);
}

TEST(TouchedBlock, StandsWhereTheTouchesSayFromThePlaceBefore) {
  BlockPose before{.cell_from_block = Eigen::Isometry3d::Identity(),
                   .covariance = {},
                   .std_block_pose = {},
                   .touches = {},
                   .located_at = {},
                   .digest = {}};
  const auto from_file = touched_at_all_spots(cell_of_owners(), std::nullopt).found.value().place;
  before.cell_from_block.translation().x() = 0.01;
  const auto from_before = touched_at_all_spots(cell_of_owners(), before).found.value().place;
  const Eigen::Vector3d apart_m =
      from_before.cell_from_block.translation() - from_file.cell_from_block.translation();
  EXPECT_NEAR(apart_m.x(), 0.01, 1e-9);
}

}  // namespace
}  // namespace cell
