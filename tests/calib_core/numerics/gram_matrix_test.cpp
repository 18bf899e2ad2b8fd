#include "calib_core/numerics/gram_matrix.hpp"

#include <gtest/gtest.h>

#include "calib_core/numerics/uniform_chance.hpp"

namespace calib {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns) {
  UniformChance chance(1);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return chance() - 0.5; });
}

TEST(GramMatrix, IsTheProductForEveryNumberOfRowsAndColumns) {
  for (Eigen::Index rows = 0; rows < 14; ++rows) {
    for (Eigen::Index columns = 0; columns < 14; ++columns) {
      const Eigen::MatrixXd matrix = random_matrix(rows, columns);
      Eigen::MatrixXd gram;
      gram_matrix(matrix, gram);
      ASSERT_EQ(gram.rows(), columns);
      ASSERT_EQ(gram.cols(), columns);
      for (Eigen::Index i = 0; i < columns; ++i) {
        for (Eigen::Index j = 0; j < columns; ++j)
          EXPECT_NEAR(gram(i, j), matrix.col(i).dot(matrix.col(j)), 1e-15);
      }
    }
  }
}

TEST(GramMatrix, TakesAPartOfALargerMatrix) {
  const Eigen::MatrixXd whole = random_matrix(40, 12);
  Eigen::MatrixXd gram;
  gram_matrix(whole.block(3, 2, 31, 7), gram);
  EXPECT_LT((gram - whole.block(3, 2, 31, 7).transpose() * whole.block(3, 2, 31, 7)).norm(), 1e-14);
}

}  // namespace
}  // namespace calib
