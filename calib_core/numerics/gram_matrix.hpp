#pragma once

#include <Eigen/Core>

namespace calib {

/// Sets `gram` to rows^T rows, all of it. Allocates no memory when `gram` has that size. Faster than Eigen's
/// product for the few columns of an identification.
void gram_matrix(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::MatrixXd& gram);

}  // namespace calib
