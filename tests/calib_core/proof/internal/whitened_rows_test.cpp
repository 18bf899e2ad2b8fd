#include "calib_core/proof/internal/whitened_rows.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace calib {
namespace {

constexpr double kWhiteRounding = 1e-9;

Eigen::MatrixXd some_covariance() {
  Eigen::MatrixXd root(4, 4);
  root << 2, 0, 0, 0, 1, 3, 0, 0, 0, -1, 1, 0, 1, 1, 1, 2;
  return root * root.transpose();
}

TEST(WhitenedRows, LeaveNothingOfWhatMayBeOfAnySize) {
  const Eigen::MatrixXd free = Eigen::Vector4d(1.0, -2.0, 0.5, 3.0);
  const WhitenedRows white(some_covariance(), free);
  EXPECT_EQ(white.degrees(), 3);
  EXPECT_LT(white.rest(7.0 * free).norm(), kWhiteRounding);
}

TEST(WhitenedRows, HaveUnitVarianceInEachDirectionThatIsLeft) {
  const WhitenedRows white(some_covariance(), Eigen::MatrixXd(Eigen::Vector4d(1.0, 0.0, 1.0, 0.0)));
  const Eigen::MatrixXd root = some_covariance().llt().matrixL();
  // Noise of this covariance is root times unit noise: the expected sum of squares of what is left.
  EXPECT_NEAR(white.rest(root).squaredNorm(), static_cast<double>(white.degrees()), kWhiteRounding);
}

TEST(WhitenedRows, RefuseACovarianceThatIsNone) {
  EXPECT_THROW(WhitenedRows(-some_covariance(), Eigen::MatrixXd(4, 0)), std::logic_error);
}

TEST(WhitenedRows, ChanceOfARestIsByFUnlessTheNoiseIsKnown) {
  constexpr double kDegrees = 12.0, kMuch = 26.0;
  const double known = rest_p(kMuch, kDegrees, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(known, 0.0107, 1e-4) << "of a table of chi-square";
  EXPECT_GT(rest_p(kMuch, kDegrees, 10.0), 2.0 * known);
  EXPECT_NEAR(rest_p(kMuch, kDegrees, 1e6), known, 1e-4);
}

}  // namespace
}  // namespace calib
