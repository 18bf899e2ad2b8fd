#include "calib_core/numerics/condition_number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib_core/numerics/gram_matrix.hpp"

namespace calib {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Eigenvalues of W^T W below this fraction of the largest are not accurate enough for singular values.
constexpr double kGramRelative = 1e-7;

/// For a larger condition number the smallest eigenvalue of W^T W is not accurate.
constexpr double kGramConditionMax = 1e4;

double root_of_ratio(const Eigen::VectorXd& ascending) {
  if (ascending[0] <= 0.0) return kInfinite;
  return std::sqrt(ascending[ascending.size() - 1] / ascending[0]);
}

}  // namespace

double condition_number(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const Eigen::VectorXd sigma = singular_values(matrix);
  if (sigma.size() < matrix.cols() || sigma.size() == 0 || sigma[sigma.size() - 1] <= 0.0) return kInfinite;
  return sigma[0] / sigma[sigma.size() - 1];
}

double condition_number_of_information(const Eigen::MatrixXd& information) {
  SymmetricEigen eigen;
  eigen.compute_values(information);
  return root_of_ratio(eigen.values());
}

Eigen::VectorXd largest_singular_values(const Eigen::Ref<const Eigen::MatrixXd>& matrix, int count) {
  if (count > 0 && count <= std::min(matrix.rows(), matrix.cols())) {
    SymmetricEigen eigen;
    Eigen::MatrixXd gram;
    gram_matrix(matrix, gram);
    eigen.compute_values(gram);
    const Eigen::VectorXd values = eigen.values().tail(count).reverse();
    // Squaring costs half of the digits.
    if (values[count - 1] > kGramRelative * values[0]) return values.cwiseSqrt();
  }
  const Eigen::VectorXd all = singular_values(matrix);
  return all.head(std::min<Eigen::Index>(count, all.size()));
}

double InformationConditions::extreme_ratio(const Eigen::MatrixXd& information) {
  if (!eigenvalues_.compute(information)) return kInfinite;
  return std::sqrt(eigenvalues_.largest() / eigenvalues_.smallest());
}

std::optional<ConditionNumbers> InformationConditions::of(const Eigen::MatrixXd& information) {
  scale_ = information.diagonal().cwiseSqrt().cwiseInverse();
  unit_.noalias() = scale_.asDiagonal() * information * scale_.asDiagonal();
  const ConditionNumbers numbers{extreme_ratio(information), extreme_ratio(unit_)};
  if (numbers.as_is < kGramConditionMax && numbers.unit_columns < kGramConditionMax) return numbers;
  return std::nullopt;
}

ConditionNumbers condition_numbers(const Eigen::MatrixXd& rows) {
  return {condition_number(rows), condition_number(rows.colwise().normalized())};
}

}  // namespace calib
