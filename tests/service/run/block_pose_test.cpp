#include "service/run/block_pose.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "calib_core/motion/collision.hpp"
#include "service/run/planning_problem.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

using Covariance = Eigen::Matrix<double, 6, 6>;

/// The block where the cell's file has it, to this standard deviation along each axis.
BlockPose known_to(double std_m) {
  BlockPose place{.cell_from_block = Eigen::Isometry3d::Identity()};
  place.covariance.topLeftCorner<3, 3>().setIdentity();
  place.covariance *= std_m * std_m;
  return place;
}

calib::PlanningProblem problem_at(const BlockPose& place) {
  const Cell there = cell_with_block_pose(cell_of_owners(), place);
  return planning_problem(there, there.recipes.at("few"));
}

TEST(BlockPoseError, IsThreeSigmaOfTheCornerThatIsKnownLeast) {
  const std::vector<calib::Face>& faces = cell_of_owners().block.faces;
  EXPECT_NEAR(place_error_m(known_to(0.002).covariance, faces), 0.006, 1e-12) << "a shift moves all corners";
  double farthest_m = 0.0;  // from the axis of the turn
  for (const calib::Face& face : faces) {
    for (const double u : {-1.0, 1.0})
      for (const double v : {-1.0, 1.0}) {
        const Eigen::Vector3d corner_m = face.center_m + u * face.half_extent_m.x() * face.edge_u +
                                         v * face.half_extent_m.y() * face.edge_v();
        farthest_m = std::max(farthest_m, Eigen::Vector2d(corner_m.x(), corner_m.z()).norm());
      }
  }
  constexpr double kTurnStd = 0.01;
  Covariance turned = Covariance::Zero();
  turned(4, 4) = kTurnStd * kTurnStd;
  EXPECT_NEAR(place_error_m(turned, faces), 3.0 * kTurnStd * farthest_m, 1e-9);
}

TEST(BlockPoseError, IsNoPartOfWhatTheCellsFileSaysOfTheArm) {
  const Cell there = cell_with_block_pose(cell_of_owners(), known_to(0.007));
  EXPECT_NEAR(there.place_error_m, 0.021, 1e-12);
  EXPECT_NEAR(there.face_error_m(), 0.021, 1e-12);
  EXPECT_EQ(there.nominal_position_error_m, cell_of_owners().nominal_position_error_m);
}

TEST(BlockPoseError, ThatIsSmallerThanTheNominalMissChangesNoPlan) {
  const double nominal_m = cell_of_owners().nominal_position_error_m;
  const Cell there = cell_with_block_pose(cell_of_owners(), known_to(nominal_m / 3.1));
  EXPECT_EQ(there.face_error_m(), nominal_m);
  const auto made = calib::plan_touches(problem_at(known_to(nominal_m / 3.1)));
  const auto& plan = std::get<calib::TouchPlan>(made).touches;
  const auto& configured = plan_of_owners().touches.touches;
  ASSERT_EQ(plan.size(), configured.size());
  for (std::size_t i = 0; i < plan.size(); ++i)
    EXPECT_LT((plan[i].joints - configured[i].joints).cwiseAbs().maxCoeff(), 1e-6) << i;
}

TEST(BlockPoseError, ThatIsLargerIsKeptFromTheBlockAndSearched) {
  const calib::PlanningProblem problem = problem_at(known_to(0.007));
  const auto made = calib::plan_touches(problem);
  ASSERT_TRUE(std::holds_alternative<calib::TouchPlan>(made));
  const calib::CollisionScene travel = calib::travel_scene(problem);
  const auto& first = std::get<calib::TouchPlan>(made).touches.front();
  EXPECT_NEAR(first.predicted_position_error_m, 0.021, 1e-12);
  EXPECT_GE(first.search_length_m, 2.0 * 0.021);
  EXPECT_FALSE(calib::find_clash(travel, calib::forward_chain(problem.nominal, first.clear_joints), 0.021))
      << "the path ends that far off the slow zone";
}

}  // namespace
}  // namespace cell
