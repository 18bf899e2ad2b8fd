#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace calib {

// Eigen's decompositions of matrices of any size. Each is instantiated once, in decompositions.cpp: one of
// them takes the compiler up to twenty seconds.

/// Eigenvalues and eigenvectors of symmetric matrices. The buffers are reused from one matrix to the next.
class SymmetricEigen {
 public:
  void compute(const Eigen::MatrixXd& matrix);
  void compute_values(const Eigen::MatrixXd& matrix);

  /// Ascending.
  [[nodiscard]] const Eigen::VectorXd& values() const { return solver_.eigenvalues(); }
  /// Column i belongs to value i. After compute() only.
  [[nodiscard]] const Eigen::MatrixXd& vectors() const { return solver_.eigenvectors(); }

 private:
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver_;
};

/// The square R of the QR decomposition of a matrix that has at least as many rows as columns.
Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& matrix);

/// The shortest of the least squares solutions of matrix * x = right.
Eigen::VectorXd least_squares_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// The Moore-Penrose inverse.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

/// The number of pivots above `threshold` times the largest, by QR with column pivoting.
Eigen::Index rank(const Eigen::MatrixXd& matrix, double threshold);

/// Singular values, descending.
Eigen::VectorXd singular_values(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace calib
