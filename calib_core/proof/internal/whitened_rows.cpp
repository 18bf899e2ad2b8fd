#include "calib_core/proof/internal/whitened_rows.hpp"

#include <stdexcept>

#include "calib_core/proof/internal/column_space.hpp"

namespace calib {

WhitenedRows::WhitenedRows(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& free)
    : cholesky_(covariance) {
  if (cholesky_.info() != Eigen::Success)
    throw std::logic_error("the covariance of the distances is not positive definite");
  basis_ = column_space(cholesky_.matrixL().solve(free));
}

Eigen::MatrixXd WhitenedRows::rest(const Eigen::MatrixXd& columns) const {
  const Eigen::MatrixXd white = cholesky_.matrixL().solve(columns);
  return white - basis_ * (basis_.transpose() * white);
}

}  // namespace calib
