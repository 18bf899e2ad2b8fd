#include "calib_core/numerics/scaled_cholesky.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace calib {
namespace {

TEST(ScaledCholesky, KeepsTheDigitsOfUnknownsWithDifferentUnits) {
  Eigen::MatrixXd matrix(2, 2);  // determinant 36 - 4 = 32
  matrix << 4e8, 2.0, 2.0, 9e-8;
  const ScaledCholesky cholesky(matrix);
  ASSERT_TRUE(cholesky.is_positive_definite());
  const Eigen::MatrixXd inverse = cholesky.inverse();
  EXPECT_NEAR(inverse(0, 0) * 32.0 / 9e-8, 1.0, 1e-15);
  EXPECT_NEAR(inverse(1, 0) * 32.0 / -2.0, 1.0, 1e-15);
  EXPECT_NEAR(inverse(1, 1) * 32.0 / 4e8, 1.0, 1e-15);
  EXPECT_NEAR(cholesky.inverse_diagonal_root(0) / std::sqrt(9e-8 / 32.0), 1.0, 1e-15);
  EXPECT_NEAR(cholesky.inverse_log_determinant(), -std::log(32.0), 1e-14);
  const Eigen::VectorXd solution = cholesky.solve(Eigen::Vector2d(6e4, 1.1e-3));
  EXPECT_NEAR(solution[0] / 1e-4, 1.0, 1e-14);
  EXPECT_NEAR(solution[1] / 1e4, 1.0, 1e-14);
}

TEST(ScaledCholesky, SaysThatAMatrixIsNotPositiveDefinite) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << 1.0, 2.0, 2.0, 1.0;
  EXPECT_FALSE(ScaledCholesky(matrix).is_positive_definite());
}

}  // namespace
}  // namespace calib
