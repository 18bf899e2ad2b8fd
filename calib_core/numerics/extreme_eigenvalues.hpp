#pragma once

#include <Eigen/Core>

namespace calib {

/// The smallest and the largest eigenvalue of positive definite matrices, without the others: Householder's
/// tridiagonal form, then Laguerre's method from either side of the spectrum. The buffers are reused from one
/// matrix to the next.
class ExtremeEigenvalues {
 public:
  /// False when the matrix is not positive definite up to rounding; smallest() is then 0.
  bool compute(const Eigen::MatrixXd& symmetric);

  [[nodiscard]] double smallest() const { return smallest_; }
  [[nodiscard]] double largest() const { return largest_; }

 private:
  Eigen::MatrixXd reduced_, reflector_;  // two columns: the reflector and the change by it
  Eigen::VectorXd diagonal_,
      squares_beside_;  // of the tridiagonal form; squares of what is beside its diagonal
  double smallest_ = 0.0, largest_ = 0.0;
};

}  // namespace calib
