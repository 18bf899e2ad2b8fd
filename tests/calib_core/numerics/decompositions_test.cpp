#include "calib_core/numerics/decompositions.hpp"

#include <gtest/gtest.h>

namespace calib {
namespace {

constexpr double kRounding = 1e-14;

Eigen::MatrixXd tall() {
  Eigen::MatrixXd matrix(4, 2);
  matrix << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 9.0;
  return matrix;
}

TEST(Decompositions, SymmetricEigenTakesAMatrixApart) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << 2.0, 1.0, 1.0, 2.0;
  SymmetricEigen eigen;
  eigen.compute(matrix);
  EXPECT_NEAR(eigen.values()[0], 1.0, kRounding);
  EXPECT_NEAR(eigen.values()[1], 3.0, kRounding);
  const Eigen::MatrixXd again = eigen.vectors() * eigen.values().asDiagonal() * eigen.vectors().transpose();
  EXPECT_LT((again - matrix).norm(), kRounding);
  eigen.compute_values(3.0 * matrix);
  EXPECT_NEAR(eigen.values()[1], 9.0, 1e-13);
}

TEST(Decompositions, UpperTriangleHasTheInformationOfItsMatrix) {
  const Eigen::MatrixXd r = upper_triangle(tall());
  ASSERT_EQ(r.rows(), 2);
  EXPECT_EQ(r(1, 0), 0.0);
  EXPECT_LT((r.transpose() * r - tall().transpose() * tall()).norm(), 1e-12);
}

TEST(Decompositions, LeastSquaresSolutionLeavesAResidualAcrossTheColumns) {
  const Eigen::Vector4d right(1.0, 0.0, 2.0, -1.0);
  const Eigen::VectorXd x = least_squares_solution(tall(), right);
  EXPECT_LT((tall().transpose() * (tall() * x - right)).norm(), 1e-12);
}

TEST(Decompositions, OfManySolutionsTheShortestIsTaken) {
  const Eigen::MatrixXd wide = Eigen::RowVector2d(1.0, 1.0);
  EXPECT_LT(
      (least_squares_solution(wide, Eigen::VectorXd::Constant(1, 2.0)) - Eigen::Vector2d(1.0, 1.0)).norm(),
      kRounding);
  EXPECT_LT((pseudo_inverse(wide) - Eigen::Vector2d(0.5, 0.5)).norm(), kRounding);
}

TEST(Decompositions, RankCountsWhatIsNotRounding) {
  Eigen::MatrixXd matrix(4, 3);
  matrix << tall(), tall().col(0) + tall().col(1);
  EXPECT_EQ(rank(matrix, 1e-10), 2);
  matrix(0, 2) += 1e-3;
  EXPECT_EQ(rank(matrix, 1e-10), 3);
}

}  // namespace
}  // namespace calib
