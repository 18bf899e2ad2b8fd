#include "service/documents/place_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "calib_core/numerics/halton.hpp"
#include "config/arm_file.hpp"
#include "config/moved_cell.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

constexpr double kQuarterTurn = std::numbers::pi / 2.0;

Eigen::Isometry3d old_from_new(const BlockDisplacement& place) {
  return Eigen::Translation3d(place.shift_m) * Eigen::AngleAxisd(place.yaw_rad, Eigen::Vector3d::UnitY());
}

const std::vector<BlockDisplacement> kPlaces{{.shift_m = {0.1, 0.0, 0.0}},
                                             {.shift_m = {0.0, -0.3, 0.0}},
                                             {.shift_m = {0.2, -0.1, -0.4}},
                                             {.yaw_rad = 0.7},
                                             {.shift_m = {-0.3, 0.2, 0.5}, .yaw_rad = -2.0}};

/// The largest entry by which two poses differ.
double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(BlockPlaces, TheArmStaysInTheRoomWhateverItsShape) {
  for (const char* arm : {"tx90", "tx60", "three-parallel"}) {
    Cell cell = edf();
    cell.arm = read_arm(kSourceDir / "config/arms" / (std::string(arm) + ".json"));
    for (const BlockDisplacement& place : kPlaces) {
      const Cell there = with_block_displaced(cell, place);
      for (int i = 1; i <= 20; ++i) {
        const calib::JointVector joints = calib::halton_posture(i, cell.arm.joint_ranges);
        const auto now = calib::forward_kinematics(cell.arm.model, joints);
        const auto then = old_from_new(place) * calib::forward_kinematics(there.arm.model, joints);
        EXPECT_LT(difference(then, now), 1e-12) << arm;
      }
    }
  }
}

TEST(BlockPlaces, AnArmWhoseFirstAxisIsAlongTheBlocksZStaysInTheRoomToo) {
  Cell cell = edf();
  cell.arm.model.links[1].alpha_rad = 0.0;
  for (const BlockDisplacement& place : kPlaces) {
    if (place.yaw_rad != 0.0) continue;
    const Cell there = with_block_displaced(cell, place);
    const calib::JointVector joints = calib::halton_posture(1, cell.arm.joint_ranges);
    EXPECT_LT(difference(old_from_new(place) * calib::forward_kinematics(there.arm.model, joints),
                         calib::forward_kinematics(cell.arm.model, joints)),
              1e-12);
  }
}

TEST(BlockPlaces, BoxesOfTheRoomStayAndThoseOfTheBlockGoWithIt) {
  const BlockDisplacement place{.shift_m = {0.1, -0.2, 0.3}};
  const Cell there = with_block_displaced(edf(), place);
  ASSERT_FALSE(edf().keep_out_boxes.empty());
  EXPECT_LT((there.keep_out_boxes[0].min_m + place.shift_m - edf().keep_out_boxes[0].min_m).norm(), 1e-12);
  EXPECT_LT((there.workspace_box.max_m + place.shift_m - edf().workspace_box.max_m).norm(), 1e-12);
  EXPECT_EQ(there.block.solids[0].min_m, edf().block.solids[0].min_m);
  EXPECT_EQ(there.block.faces[0].center_m, edf().block.faces[0].center_m);
}

TEST(BlockPlaces, ABoxThatIsTurnedIsHeldByTheOneThatStandsForIt) {
  const calib::Box& now = edf().workspace_box;
  for (const double yaw : {0.3, kQuarterTurn, -1.0}) {
    const BlockDisplacement place{.yaw_rad = yaw};
    const calib::Box then = with_block_displaced(edf(), place).workspace_box;
    Eigen::Vector3d min_m = Eigen::Vector3d::Constant(1e9), max_m = -min_m;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d at_m(corner & 1 ? now.min_m.x() : now.max_m.x(),
                                 corner & 2 ? now.min_m.y() : now.max_m.y(),
                                 corner & 4 ? now.min_m.z() : now.max_m.z());
      const Eigen::Vector3d seen_m = old_from_new(place).inverse() * at_m;
      min_m = min_m.cwiseMin(seen_m);
      max_m = max_m.cwiseMax(seen_m);
    }
    EXPECT_LT((then.min_m - min_m).norm() + (then.max_m - max_m).norm(), 1e-12) << "the smallest one";
  }
}

TEST(BlockPlaces, PiecesOfATurnedTableHoldAllOfItAndLittleElse) {
  const calib::Box& table = edf().keep_out_boxes.at(0);
  const BlockDisplacement place{.yaw_rad = 0.4};
  const auto pieces = with_block_displaced(edf(), place).keep_out_boxes;
  const auto is_held = [&](const Eigen::Vector3d& in_room_m) {
    const Eigen::Vector3d point_m = old_from_new(place).inverse() * in_room_m;
    return std::ranges::any_of(pieces, [&](const calib::Box& piece) {
      return ((point_m - piece.min_m).array() > -1e-9).all() &&
             ((piece.max_m - point_m).array() > -1e-9).all();
    });
  };
  const Eigen::Vector3d extent_m = table.max_m - table.min_m;
  for (int i = 1; i <= 200; ++i) {
    const Eigen::Vector3d share(calib::van_der_corput(i, 2), calib::van_der_corput(i, 3),
                                calib::van_der_corput(i, 5));
    EXPECT_TRUE(is_held(table.min_m + share.cwiseProduct(extent_m)));
  }
  const Eigen::Vector3d beside_m(0.1, 0.0, 0.0);  // less than half of a piece
  EXPECT_FALSE(is_held(table.max_m + beside_m));
  EXPECT_FALSE(is_held(table.min_m - beside_m));
}

TEST(PlaceSearchFigures, RanksPlacesBySmallestErrorAndTellsWhyOthersWillNotDo) {
  const Cell& cell = edf();
  const Recipe& recipe = cell.recipes.at("edf-25");
  // From where the block is to where the arm does not come.
  const PlaceRange range{.min = {.shift_m = {0.0, 0.0, -0.1}}, .max = {.shift_m = {1.5, 0.0, 0.1}}};
  const PlaceSearchOptions options{.place_count = 3, .full_count = 1};
  std::vector<double> shares;
  const auto findings = search_places(cell, recipe, range, options,
                                      [&](std::string_view, double share) { shares.push_back(share); });
  ASSERT_EQ(findings.size(), 4u);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_TRUE(findings.front().fully_planned);
  double last_m = 0.0;
  int infeasible = 0;
  for (const PlaceCandidate& finding : findings) {
    if (finding.figures) {
      EXPECT_EQ(infeasible, 0) << "those without a plan come last";
      EXPECT_GE(finding.figures->workspace_box_rms_m.value(), last_m);
      last_m = *finding.figures->workspace_box_rms_m;
    } else {
      ++infeasible;
      EXPECT_THAT(finding.reason, HasSubstr("plane"));
    }
  }
  EXPECT_GT(last_m, 0.0);
  EXPECT_GT(infeasible, 0);
}

}  // namespace
}  // namespace cell
