#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace calib {

/// Cholesky decomposition of a positive definite matrix whose unknowns have different units, such as an
/// information matrix. Rows and columns are scaled to a unit diagonal first, which keeps the digits.
class ScaledCholesky {
 public:
  /// `matrix` must have a positive diagonal.
  explicit ScaledCholesky(const Eigen::MatrixXd& matrix);

  /// Whether the matrix is positive definite; else the other functions must not be called.
  [[nodiscard]] bool is_positive_definite() const { return cholesky_.info() == Eigen::Success; }

  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  [[nodiscard]] Eigen::MatrixXd inverse() const;
  /// The square root of a diagonal element of the inverse: of a covariance, the standard deviation.
  [[nodiscard]] double inverse_diagonal_root(Eigen::Index index) const;
  /// The logarithm of the determinant of the inverse.
  [[nodiscard]] double inverse_log_determinant() const;

 private:
  Eigen::VectorXd scale_;
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
};

}  // namespace calib
