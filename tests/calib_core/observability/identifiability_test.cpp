#include "calib_core/observability/identifiability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace calib {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(Identifiability, GroupsADependentColumnWithItsFactor) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(6, kErrorParameterCount);
  w(0, 0) = 1.0;
  w(0, 1) = 2.0;  // twice column 0
  w(1, 3) = 3.0;
  const IdentifiableSet set = choose_identifiable(w, {});
  EXPECT_THAT(set.columns, ElementsAre(0, 3));
  EXPECT_EQ(set.candidates[1].status, ParameterStatus::kGrouped);
  EXPECT_THAT(set.candidates[1].grouped_with, ElementsAre(Pair(0, ::testing::DoubleEq(2.0))));
  EXPECT_EQ(set.candidates[2].status, ParameterStatus::kNoEffect);
  EXPECT_DOUBLE_EQ(set.smallest_kept, 1.0);
}

TEST(Identifiability, TriesTheGivenColumnsLastAndLeavesOutTheExcluded) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(6, kErrorParameterCount);
  w(0, 0) = 1.0;
  w(0, 1) = 2.0;
  w(1, 3) = 3.0;
  const IdentifiableSet set = choose_identifiable(w, {.tried_last = {0}, .excluded = {3}});
  EXPECT_THAT(set.columns, ElementsAre(1));
  EXPECT_EQ(set.candidates[0].status, ParameterStatus::kGrouped);
  EXPECT_EQ(set.candidates[3].status, ParameterStatus::kExcluded);
}

TEST(SingularValues, OfRotatedAxesAreTheirLengths) {
  Eigen::MatrixXd matrix(3, 2);  // orthogonal columns of length 5 and 10
  matrix << 3.0, -8.0, 4.0, 6.0, 0.0, 0.0;
  const Eigen::VectorXd sigma = singular_values(matrix);
  ASSERT_EQ(sigma.size(), 2);
  EXPECT_NEAR(sigma[0], 10.0, 1e-14);
  EXPECT_NEAR(sigma[1], 5.0, 1e-14);
  EXPECT_NEAR(largest_singular_values(matrix, 1)[0], 10.0, 1e-14);
  EXPECT_NEAR(condition_number(matrix), 2.0, 1e-14);
}

TEST(ConditionNumber, OfFewerRowsThanColumnsIsInfinite) {
  EXPECT_EQ(condition_number(Eigen::MatrixXd::Ones(1, 2)), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace calib
