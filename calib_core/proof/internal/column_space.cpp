#include "calib_core/proof/internal/column_space.hpp"

#include <algorithm>

namespace calib {

Eigen::MatrixXd column_space(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd rest = columns;
  for (Eigen::Index k = 0; k < rest.cols(); ++k) {
    const double length = rest.col(k).norm();
    if (length > 0.0) rest.col(k) /= length;
  }
  Eigen::MatrixXd basis(columns.rows(), std::min(columns.rows(), columns.cols()));
  Eigen::Index count = 0;
  while (count < basis.cols()) {
    Eigen::Index next = 0;
    const double length = rest.colwise().norm().maxCoeff(&next);
    if (!(length > kColumnRestMin)) break;
    Eigen::VectorXd direction = rest.col(next) / length;
    // Once more: rounding leaves a little of the others in a column that is almost theirs.
    direction -= basis.leftCols(count) * (basis.leftCols(count).transpose() * direction);
    basis.col(count) = direction.normalized();
    rest -= basis.col(count) * (basis.col(count).transpose() * rest).eval();
    ++count;
  }
  return basis.leftCols(count);
}

}  // namespace calib
