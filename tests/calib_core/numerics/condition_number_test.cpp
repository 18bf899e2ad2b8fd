#include "calib_core/numerics/condition_number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace calib {
namespace {

Eigen::MatrixXd orthogonal_columns() {  // of length 5 and 10
  Eigen::MatrixXd matrix(3, 2);
  matrix << 3.0, -8.0, 4.0, 6.0, 0.0, 0.0;
  return matrix;
}

TEST(SingularValues, OfOrthogonalColumnsAreTheirLengths) {
  const Eigen::VectorXd sigma = singular_values(orthogonal_columns());
  ASSERT_EQ(sigma.size(), 2);
  EXPECT_NEAR(sigma[0], 10.0, 1e-14);
  EXPECT_NEAR(sigma[1], 5.0, 1e-14);
  EXPECT_NEAR(largest_singular_values(orthogonal_columns(), 1)[0], 10.0, 1e-14);
}

TEST(ConditionNumber, IsThatOfTheRowsHoweverItIsComputed) {
  const Eigen::MatrixXd rows = orthogonal_columns();
  const Eigen::MatrixXd information = rows.transpose() * rows;
  EXPECT_NEAR(condition_number(rows), 2.0, 1e-14);
  EXPECT_NEAR(condition_number_of_information(information), 2.0, 1e-14);
  const auto numbers = InformationConditions().of(information);
  ASSERT_TRUE(numbers);
  EXPECT_NEAR(numbers->as_is, 2.0, 1e-14);
  EXPECT_NEAR(numbers->unit_columns, 1.0, 1e-14);
  EXPECT_NEAR(condition_numbers(rows).as_is, 2.0, 1e-14);
  EXPECT_NEAR(condition_numbers(rows).unit_columns, 1.0, 1e-14);
}

TEST(ConditionNumber, OfFewerRowsThanColumnsIsInfinite) {
  EXPECT_EQ(condition_number(Eigen::MatrixXd::Ones(1, 2)), std::numeric_limits<double>::infinity());
}

TEST(ConditionNumber, IsLeftToTheRowsWhereTheInformationHasLostItsDigits) {
  Eigen::MatrixXd rows = orthogonal_columns();
  rows.col(1) *= 1e-6;
  EXPECT_FALSE(InformationConditions().of(rows.transpose() * rows));
  EXPECT_NEAR(condition_numbers(rows).as_is, 5.0 / 10.0e-6, 1e-3);
}

}  // namespace
}  // namespace calib
