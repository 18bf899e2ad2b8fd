#pragma once

#include <Eigen/Core>
#include <optional>

#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/extreme_eigenvalues.hpp"

namespace calib {

/// sigma_max / sigma_min (eq. 16); infinite when sigma_min is 0.
double condition_number(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// The same of the rows whose information (Gram) matrix rows^T rows this is. Squaring costs half of the
/// digits.
double condition_number_of_information(const Eigen::MatrixXd& information);

/// The `count` largest singular values, descending. Faster than singular_values() unless they differ by
/// orders of magnitude.
Eigen::VectorXd largest_singular_values(const Eigen::Ref<const Eigen::MatrixXd>& matrix, int count);

/// The condition number of a set of rows by each scaling of their columns.
struct ConditionNumbers {
  double as_is = 0.0;         // columns in metres per metre and metres per radian
  double unit_columns = 0.0;  // every column scaled to unit norm
};

/// Computes condition numbers from information matrices; the buffers are reused from one to the next.
class InformationConditions {
 public:
  /// Nothing when the information matrix has not kept digits enough; the rows are needed then.
  std::optional<ConditionNumbers> of(const Eigen::MatrixXd& information);

 private:
  double extreme_ratio(const Eigen::MatrixXd& information);

  Eigen::VectorXd scale_;
  Eigen::MatrixXd unit_;
  ExtremeEigenvalues eigenvalues_;
};

/// Slower and right for every condition number.
ConditionNumbers condition_numbers(const Eigen::MatrixXd& rows);

}  // namespace calib
