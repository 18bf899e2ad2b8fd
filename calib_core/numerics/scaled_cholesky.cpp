#include "calib_core/numerics/scaled_cholesky.hpp"

#include <cmath>

namespace calib {

ScaledCholesky::ScaledCholesky(const Eigen::MatrixXd& matrix)
    : scale_(matrix.diagonal().cwiseSqrt().cwiseInverse()),
      cholesky_(scale_.asDiagonal() * matrix * scale_.asDiagonal()) {}

Eigen::VectorXd ScaledCholesky::solve(const Eigen::VectorXd& right) const {
  return scale_.asDiagonal() * cholesky_.solve(scale_.asDiagonal() * right);
}

Eigen::MatrixXd ScaledCholesky::inverse() const {
  return scale_.asDiagonal() *
         cholesky_.solve(Eigen::MatrixXd::Identity(cholesky_.rows(), cholesky_.cols())) * scale_.asDiagonal();
}

double ScaledCholesky::inverse_diagonal_root(Eigen::Index index) const {
  const Eigen::VectorXd column = cholesky_.solve(Eigen::VectorXd::Unit(scale_.size(), index));
  return scale_[index] * std::sqrt(column[index]);
}

double ScaledCholesky::inverse_log_determinant() const {
  const Eigen::MatrixXd& factor = cholesky_.matrixLLT();
  return 2.0 * (scale_.array().log().sum() - factor.diagonal().array().log().sum());
}

}  // namespace calib
