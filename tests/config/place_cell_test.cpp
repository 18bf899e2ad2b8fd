#include "config/place_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "calib_core/kinematics/kinematic_model.hpp"
#include "config/touched_places.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

/// The demo cell with a stand; y of R_-1 points down.
class PlaceCell : public CopiedConfig {
 protected:
  PlaceCell() : cell_(read()) { recipe_.places = {0}; }

  Cell at(const Eigen::Isometry3d& first_from_place) {
    cell_.block.places = {
        {.name = "stand", .first_from_place = first_from_place, .std = calib::PlaceDeviation{}}};
    return cell_at_place(cell_, recipe_, 1);
  }
  static const calib::Box* find(const std::vector<calib::Box>& boxes, const std::string& name) {
    const auto found = std::ranges::find(boxes, name, &calib::Box::name);
    return found == boxes.end() ? nullptr : &*found;
  }
  static Eigen::Isometry3d lifted_by(double lift_m) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.0, -lift_m, 0.0));
  }

  Cell cell_;
  Recipe recipe_;
};

TEST_F(PlaceCell, OfTheFirstPlaceIsTheCellItself) {
  at(lifted_by(0.3));
  const Cell first = cell_at_place(cell_, recipe_, 0);
  EXPECT_EQ(first.block.solids.size(), cell_.block.solids.size());
  EXPECT_EQ(first.keep_out_boxes.size(), cell_.keep_out_boxes.size());
}

TEST_F(PlaceCell, MovesTheCubeWithItsFacesAndLeavesPlateAndTable) {
  const Cell there = at(lifted_by(0.3));
  ASSERT_EQ(there.block.solids.size(), 1U);
  EXPECT_EQ(there.block.solids[0].min_m, cell_.block.solids[0].min_m) << "in R_-1 of the place";
  const calib::Box* plate = find(there.keep_out_boxes, "plate");
  ASSERT_TRUE(plate);
  EXPECT_NEAR(plate->min_m.y(), 0.3, 1e-12);
  const calib::Box* table = find(there.keep_out_boxes, "table");
  ASSERT_TRUE(table);
  EXPECT_NEAR(table->min_m.y(), cell_.keep_out_boxes[0].min_m.y() + 0.3, 1e-12);
  const calib::JointVector& joints = cell_.park_joints;
  EXPECT_LT((lifted_by(0.3) * calib::forward_kinematics(there.arm.model, joints).translation() -
             calib::forward_kinematics(cell_.arm.model, joints).translation())
                .norm(),
            1e-9)
      << "the arm has not moved";
}

TEST_F(PlaceCell, KeepsOutOfAllThatIsUnderALiftedBlock) {
  const Cell there = at(lifted_by(0.3));
  const calib::Box* stand = find(there.keep_out_boxes, "stand");
  ASSERT_TRUE(stand);
  EXPECT_NEAR(stand->min_m.y(), cell_.block.solids[0].max_m.y(), 1e-12);
  EXPECT_NEAR(stand->max_m.y() - stand->min_m.y(), 0.3, 1e-12);
  EXPECT_LT(stand->min_m.x(), cell_.block.solids[0].min_m.x());
  EXPECT_FALSE(find(at(Eigen::Isometry3d(Eigen::Translation3d(0.2, 0.0, 0.0))).keep_out_boxes, "stand"))
      << "beside its first place it stands on the same ground";
}

TEST_F(PlaceCell, KeepsOutOfWhereTheBlockStoodBeforeUnlessTheTouchesNeedThatRoom) {
  const auto beside = [this](double shift_m) {
    return at(Eigen::Isometry3d(Eigen::Translation3d(shift_m, 0.0, 0.0)));
  };
  const Cell there = beside(0.2);
  const calib::Box* before = find(there.keep_out_boxes, "block at first");
  ASSERT_TRUE(before);
  EXPECT_NEAR(before->max_m.x(), cell_.block.solids[0].max_m.x() - 0.2, 1e-12);
  EXPECT_FALSE(find(beside(0.16).keep_out_boxes, "block at first")) << "10 mm are between both";
  EXPECT_FALSE(find(beside(0.05).keep_out_boxes, "block at first")) << "they overlap";
}

TEST_F(PlaceCell, TurnsTheSurroundingsTheOtherWay) {
  const Eigen::Isometry3d turned(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY()));
  const Cell there = at(turned);
  const calib::Box* table = find(there.keep_out_boxes, "table");
  ASSERT_TRUE(table);
  const calib::Box& before = cell_.keep_out_boxes[0];  // along x from -0.4 to 0.6, which is along z there
  EXPECT_NEAR(table->min_m.z(), before.min_m.x(), 1e-9);
  EXPECT_NEAR(table->max_m.z(), before.max_m.x(), 1e-9);
}

TEST_F(PlaceCell, TheSolidsThatMoveAreTheFirstOneAndBalls) {
  EXPECT_EQ(solids_that_move(cell_.block), (std::vector<bool>{true, false}));
  Block other = cell_.block;
  calib::Box ball = other.solids[1];
  ball.round_m = 0.01;
  other.solids.push_back(ball);
  EXPECT_EQ(solids_that_move(other), (std::vector<bool>{true, false, true}));
  other.solids.erase(other.solids.begin());
  EXPECT_EQ(solids_that_move(other), (std::vector<bool>{true, true})) << "nobody knows which it stands on";
}

}  // namespace
}  // namespace cell
