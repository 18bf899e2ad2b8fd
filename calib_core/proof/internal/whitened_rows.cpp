#include "calib_core/proof/internal/whitened_rows.hpp"

#include <cmath>
#include <stdexcept>

#include "calib_core/numerics/distributions.hpp"
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

double rest_p(double chi_square, double degrees, double noise_degrees) {
  return std::isfinite(noise_degrees) ? f_survival(chi_square / degrees, degrees, noise_degrees)
                                      : chi_square_survival(chi_square, degrees);
}

}  // namespace calib
