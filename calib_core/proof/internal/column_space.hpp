#pragma once

#include <Eigen/Core>

namespace calib {

/// An orthonormal basis of the columns of a matrix, a column each; columns of 0 and those that depend on
/// others by more than 1 - kColumnRestMin of their length bring none. The columns may have different units.
Eigen::MatrixXd column_space(const Eigen::MatrixXd& columns);

/// A column adds a direction when this share of it is not in the others.
inline constexpr double kColumnRestMin = 1e-6;

}  // namespace calib
