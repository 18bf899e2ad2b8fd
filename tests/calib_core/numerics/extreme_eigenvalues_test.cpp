#include "calib_core/numerics/extreme_eigenvalues.hpp"

#include <gtest/gtest.h>

#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/uniform_chance.hpp"

namespace calib {
namespace {

/// Symmetric, with these eigenvalues.
Eigen::MatrixXd with_eigenvalues(const Eigen::VectorXd& values, std::uint64_t seed) {
  UniformChance chance(seed);
  const Eigen::MatrixXd random =
      Eigen::MatrixXd::NullaryExpr(values.size(), values.size(), [&] { return chance() - 0.5; });
  SymmetricEigen axes;
  axes.compute(random + random.transpose());
  return axes.vectors() * values.asDiagonal() * axes.vectors().transpose();
}

TEST(ExtremeEigenvalues, AreThoseThatTheMatrixWasMadeWith) {
  ExtremeEigenvalues extremes;  // its buffers are used again for every size
  for (Eigen::Index size = 1; size < 40; ++size) {
    const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(size, 3.0, 700.0);
    ASSERT_TRUE(extremes.compute(with_eigenvalues(values, static_cast<std::uint64_t>(size))));
    EXPECT_NEAR(extremes.smallest(), values.minCoeff(), 1e-12 * values.maxCoeff()) << size;
    EXPECT_NEAR(extremes.largest(), values.maxCoeff(), 1e-13 * values.maxCoeff()) << size;
  }
}

TEST(ExtremeEigenvalues, MayBeFarApartOrSeveralTimesThere) {
  ExtremeEigenvalues extremes;
  Eigen::VectorXd values = Eigen::VectorXd::Constant(25, 1.0);
  values.tail(10).setConstant(1e7);
  values.segment<5>(8).setConstant(30.0);
  ASSERT_TRUE(extremes.compute(with_eigenvalues(values, 2)));
  EXPECT_NEAR(extremes.smallest(), 1.0, 1e-7);
  EXPECT_NEAR(extremes.largest(), 1e7, 1e-6);
}

TEST(ExtremeEigenvalues, OfADiagonalMatrixAreItsElements) {
  ExtremeEigenvalues extremes;
  ASSERT_TRUE(extremes.compute(Eigen::Vector4d(4.0, 0.25, 9.0, 1.0).asDiagonal()));
  EXPECT_NEAR(extremes.smallest(), 0.25, 1e-15);
  EXPECT_NEAR(extremes.largest(), 9.0, 1e-14);
}

TEST(ExtremeEigenvalues, AreRefusedToAMatrixThatIsNotPositiveDefinite) {
  ExtremeEigenvalues extremes;
  EXPECT_FALSE(extremes.compute(with_eigenvalues(Eigen::Vector4d(-0.1, 1.0, 2.0, 3.0), 3)));
  EXPECT_EQ(extremes.smallest(), 0.0);
  EXPECT_FALSE(extremes.compute(Eigen::MatrixXd::Zero(3, 3)));
}

}  // namespace
}  // namespace calib
