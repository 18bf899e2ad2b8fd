#include "calib_core/numerics/decompositions.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>

namespace calib {

void SymmetricEigen::compute(const Eigen::MatrixXd& matrix) { solver_.compute(matrix); }

void SymmetricEigen::compute_values(const Eigen::MatrixXd& matrix) {
  solver_.compute(matrix, Eigen::EigenvaluesOnly);
}

Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& matrix) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(matrix);
  return qr.matrixQR().topRows(matrix.cols()).triangularView<Eigen::Upper>();
}

Eigen::VectorXd least_squares_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::Index rank(const Eigen::MatrixXd& matrix, double threshold) {
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(matrix).setThreshold(threshold).rank();
}

Eigen::VectorXd singular_values(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  if (matrix.rows() == 0 || matrix.cols() == 0) return {};
  // R has the singular values of the matrix, or of its transpose, and is square: no further preparation is
  // needed.
  const Eigen::MatrixXd r = upper_triangle(matrix.rows() < matrix.cols() ? Eigen::MatrixXd(matrix.transpose())
                                                                         : Eigen::MatrixXd(matrix));
  return Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner>(r).singularValues();
}

}  // namespace calib
