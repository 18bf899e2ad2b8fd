#include "calib_core/estimation/internal/least_trimmed_squares.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "calib_core/numerics/decompositions.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

/// rows * x = targets with a unit of noise, the last `bad` of the rows far off.
struct Regression {
  Eigen::MatrixXd rows;
  Eigen::VectorXd targets;
  Eigen::VectorXd solution;
};

Regression regression(Eigen::Index count, Eigen::Index unknowns, Eigen::Index bad, double off,
                      UniformChance& chance) {
  Regression made{Eigen::MatrixXd(count, unknowns), {}, Eigen::VectorXd(unknowns)};
  for (double& value : made.rows.reshaped()) value = study::normal(chance);
  for (double& value : made.solution) value = 10.0 * study::normal(chance);
  made.targets = made.rows * made.solution;
  for (Eigen::Index row = 0; row < count; ++row) {
    made.targets[row] += study::normal(chance) + (row >= count - bad ? off : 0.0);
  }
  return made;
}

double miss(const Regression& made, const std::optional<TrimmedFit>& fit) {
  return fit ? (fit->solution - made.solution).norm() : std::numeric_limits<double>::infinity();
}

TEST(LeastTrimmedSquares, BearsNearlyHalfOfTheRowsWrong) {
  const Eigen::VectorXd no_prior = Eigen::VectorXd::Zero(4);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    UniformChance chance(seed);
    const Regression made = regression(100, 4, 45, 1000.0, chance);
    std::mt19937_64 starts(1);
    const auto fit = least_trimmed_squares(made.rows, made.targets, no_prior, starts);
    EXPECT_LT(miss(made, fit), 3.0) << seed;
    for (std::size_t row = 55; row < 100; ++row) EXPECT_FALSE(fit->core[row]) << seed << " row " << row;
    const Eigen::VectorXd plain = least_squares_solution(made.rows, made.targets);
    EXPECT_GT((plain - made.solution).norm(), 30.0);
  }
}

TEST(LeastTrimmedSquares, BreaksDownOnlyBeyondHalf) {
  UniformChance chance(2);
  const Regression made = regression(100, 4, 60, 1000.0, chance);
  std::mt19937_64 starts(1);
  // Sixty that agree with each other on an offset no x has: nothing in the good forty wins by count.
  EXPECT_GT(miss(made, least_trimmed_squares(made.rows, made.targets, Eigen::VectorXd::Zero(4), starts)),
            3.0);
}

TEST(LeastTrimmedSquares, OfMoreRowsThanTheSampleFindsTheSame) {
  const Eigen::VectorXd no_prior = Eigen::VectorXd::Zero(10);
  for (const Eigen::Index count : {600, 601, 5000}) {
    UniformChance chance(3);
    const Regression made = regression(count, 10, count / 5, 1000.0, chance);
    std::mt19937_64 starts(1);
    const auto fit = least_trimmed_squares(made.rows, made.targets, no_prior, starts);
    EXPECT_LT(miss(made, fit), 1.5) << count;
    ASSERT_EQ(std::ssize(fit->core), count);
    const auto in_core = std::ranges::count(fit->core, true);
    EXPECT_NEAR(static_cast<double>(in_core) / static_cast<double>(count), 0.5, 0.1);
    for (Eigen::Index row = count - count / 5; row < count; ++row) {
      EXPECT_FALSE(fit->core[static_cast<std::size_t>(row)]);
    }
  }
}

TEST(LeastTrimmedSquares, HasNothingToSayWithHardlyMoreRowsThanUnknowns) {
  UniformChance chance(4);
  const Regression made = regression(8, 6, 0, 0.0, chance);
  std::mt19937_64 starts(1);
  EXPECT_FALSE(least_trimmed_squares(made.rows, made.targets, Eigen::VectorXd::Zero(6), starts));
  EXPECT_FALSE(least_trimmed_squares(Eigen::MatrixXd(8, 0), made.targets, Eigen::VectorXd::Zero(0), starts));
}

TEST(LeastTrimmedSquares, IsTheSameForTheSameChance) {
  UniformChance chance(5);
  const Regression made = regression(200, 8, 60, 50.0, chance);
  std::mt19937_64 one(7), other(7);
  const Eigen::VectorXd no_prior = Eigen::VectorXd::Zero(8);
  const auto first = least_trimmed_squares(made.rows, made.targets, no_prior, one);
  const auto second = least_trimmed_squares(made.rows, made.targets, no_prior, other);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->solution, second->solution);
  EXPECT_EQ(first->core, second->core);
}

TEST(RobustIdentification, DoesNotShrinkTheArmIntoTheCornerOfThreePlanes) {
  // An arm that has shrunk to a point in the corner of planes 1 to 3 fits three quarters of these touches
  // without a residual; the fourth plane's would be the bad ones.
  IdentificationProblem problem = drawn::problem(drawn::certain_artefact(4));
  UniformChance chance(6);
  const auto truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd());
  problem.touches = drawn::touches(truth, {.count = 160}, chance);
  for (std::size_t i = 0; i < problem.touches.size(); i += 7) {  // makes the robust search run
    ContactSurface plane = problem.artefact.contact_planes[static_cast<std::size_t>(problem.touches[i].face)];
    plane.offset_m += 1e-3;
    problem.touches[i] = moved_onto_plane(truth.arm, plane, problem.touches[i]);
  }
  const auto result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  std::vector<std::size_t> named, expected;
  for (const RejectedTouch& rejected : result.rejected) named.push_back(rejected.touch);
  for (std::size_t i = 0; i < problem.touches.size(); i += 7) expected.push_back(i);
  EXPECT_EQ(named, expected);
  EXPECT_LT(result.errors.norm(), 2.0 * paper::table3().norm());
}

TEST(LargestExpected, GrowsWithTheCountAndShrinksWithTheDegrees) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_LT(studentized_residual_max(10, kInfinity), studentized_residual_max(1000, kInfinity));
  EXPECT_GT(studentized_residual_max(100, 5.0), studentized_residual_max(100, kInfinity));
  // Seldom exceeded by good touches: one set in 1 / kFalseAlarmsPerSet, to Bonferroni.
  UniformChance chance(8);
  int alarms = 0;
  constexpr int kSets = 20'000, kCount = 20;
  const double limit = studentized_residual_max(kCount, kInfinity);
  for (int set = 0; set < kSets; ++set) {
    double largest = 0.0;
    for (int i = 0; i < kCount; ++i) largest = std::max(largest, std::abs(study::normal(chance)));
    alarms += largest > limit ? 1 : 0;
  }
  EXPECT_NEAR(alarms, kSets * kFalseAlarmsPerSet, 4.0 * std::sqrt(kSets * kFalseAlarmsPerSet));
}

}  // namespace
}  // namespace calib
