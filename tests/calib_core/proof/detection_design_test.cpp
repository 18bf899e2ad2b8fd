#include "calib_core/proof/detection_design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib_core/numerics/uniform_chance.hpp"

namespace calib {
namespace {

/// Touches that see a fault of one direction, beside an offset of any size.
DetectionProblem small_problem(Eigen::Index candidates) {
  UniformChance chance(9);
  Eigen::MatrixXd fault(candidates, 1);
  for (Eigen::Index row = 0; row < candidates; ++row) fault(row, 0) = 2.0 * chance() - 1.0;
  return {.covariance = Eigen::MatrixXd::Identity(candidates, candidates),
          .questions = {{.faults = {fault}, .free = Eigen::MatrixXd::Ones(candidates, 1)}}};
}

TEST(DetectionDesign, ADoubtIsWhatTheTestOfTheFaultLeavesOpen) {
  DetectionProblem problem = small_problem(3);
  problem.questions[0].faults[0] << 1.0, 0.0, -1.0;
  EXPECT_NEAR(doubt_left(problem, {0, 2}), 1.0 / 3.0, 1e-12);  // noncentrality 2
  problem.questions[0].faults[0] << 1.0, 1.0, 1.0;             // as the offset
  EXPECT_NEAR(doubt_left(problem, {0, 1, 2}), 1.0, 1e-12);
}

TEST(DetectionDesign, AFaultInAnyOfItsDirectionsIsSeenByTheirSum) {
  DetectionProblem problem = small_problem(3);
  DetectionQuestion& question = problem.questions[0];
  question.faults[0].resize(3, 2);
  question.faults[0] << 1.0, 1.0, 0.0, 0.0, -1.0, -1.0;
  EXPECT_NEAR(doubt_left(problem, {0, 2}), 1.0 + 1.0 / 5.0, 1e-12);  // alike: only their sum is told
  question.directions = FaultDirections::kAny;
  EXPECT_NEAR(doubt_left(problem, {0, 2}), 1.0 / 5.0, 1e-12);
}

TEST(DetectionDesign, FindsTheBestChoiceWhereAllCanBeTried) {
  const DetectionProblem problem = small_problem(9);
  double least = 1.0;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = i + 1; j < 9; ++j)
      for (std::size_t k = j + 1; k < 9; ++k) least = std::min(least, doubt_left(problem, {i, j, k}));
  const std::vector<std::size_t> chosen = choose_for_detection(problem, 3);
  EXPECT_TRUE(std::ranges::is_sorted(chosen));
  EXPECT_NEAR(doubt_left(problem, chosen), least, 1e-12);
}

TEST(DetectionDesign, LeavesNoPairOfFaultsThatLookAlikeWhereTouchesTellThem) {
  DetectionProblem problem = small_problem(6);
  Eigen::MatrixXd& faults = problem.questions[0].faults[0];
  faults.resize(6, 2);
  faults << 3, 3, 3, 3, -3, -3, -3, -3, 3, -3, -3, 3;
  const auto chosen = choose_for_detection(problem, 3);
  EXPECT_TRUE(std::ranges::find(chosen, 4U) != chosen.end() || std::ranges::find(chosen, 5U) != chosen.end());
}

TEST(DetectionDesign, DeterminesWhatItHasToAlthoughFaultsWouldBeSeenBetterWithout) {
  DetectionProblem problem = small_problem(6);
  DetectionQuestion& question = problem.questions[0];
  question.faults[0] << 3, -3, 3, -3, 0.1, -0.1;
  question.free.resize(6, 2);
  const double share = 1.0 / std::sqrt(6.0);
  // The second column tells candidates apart that show the fault well by a hundredth of what the last two do.
  question.free << share, 0.005, share, 0.005, share, -0.005, share, -0.005, share, std::sqrt(0.49995), share,
      -std::sqrt(0.49995);
  ASSERT_TRUE((question.free.transpose() * question.free).isIdentity(1e-3));
  EXPECT_LT(choose_for_detection(problem, 4).back(), 4U);
  question.free_share_min = 0.1;
  const auto chosen = choose_for_detection(problem, 4);
  EXPECT_GE(chosen.back(), 4U);
  EXPECT_LT(chosen.front(), 4U);  // the fault is seen all the same
}

TEST(DetectionDesign, AChoiceThatLeavesThePoseOpenLeavesMoreThanAllFaultsOpen) {
  DetectionProblem problem = small_problem(4);
  DetectionQuestion& question = problem.questions[0];
  question.faults[0] << 5, -5, 5, -5;
  question.free.resize(4, 1);
  question.free << 1, 0, 0, 0;
  question.free_share_min = 0.1;
  EXPECT_NEAR(doubt_left(problem, {1, 2}), 2.0, 1e-12);
  EXPECT_LT(doubt_left(problem, {0, 1}), 1.0);
}

TEST(DetectionDesign, IsRefusedMoreTouchesThanCandidates) {
  EXPECT_THROW(choose_for_detection(small_problem(2), 3), std::logic_error);
}

}  // namespace
}  // namespace calib
