#include "calib_core/proof/internal/column_space.hpp"

#include <gtest/gtest.h>

namespace calib {
namespace {

constexpr double kSpaceRounding = 1e-12;

TEST(ColumnSpace, CountsDependentColumnsOnceWhateverTheirUnits) {
  constexpr double kOtherUnit = 1e-9;
  Eigen::MatrixXd columns(5, 4);
  columns << 1, 0, 2, 0, 0, 1, 3, 0, 1, 1, 5, 0, 2, 0, 4, 0, 0, 4, 12, 0;
  columns.col(1) *= kOtherUnit;
  const Eigen::MatrixXd basis = column_space(columns);
  ASSERT_EQ(basis.cols(), 2);
  EXPECT_TRUE((basis.transpose() * basis).isIdentity(kSpaceRounding));
  const Eigen::MatrixXd left = columns - basis * (basis.transpose() * columns);
  EXPECT_LT(left.cwiseAbs().maxCoeff(), kSpaceRounding);
}

TEST(ColumnSpace, OfNoColumnsAndOfZerosIsEmpty) {
  EXPECT_EQ(column_space(Eigen::MatrixXd(3, 0)).cols(), 0);
  EXPECT_EQ(column_space(Eigen::MatrixXd::Zero(3, 2)).cols(), 0);
}

TEST(ColumnSpace, HasNoMoreDirectionsThanRows) {
  EXPECT_EQ(column_space(Eigen::MatrixXd::Identity(2, 2).replicate(1, 3)).cols(), 2);
}

}  // namespace
}  // namespace calib
