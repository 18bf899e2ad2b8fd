#include "calib_core/numerics/extreme_eigenvalues.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "calib_core/numerics/column_loops.hpp"
#include "calib_core/numerics/wide_registers.hpp"

namespace calib {
namespace {

using column_loops::add_multiple;
using column_loops::add_multiples;
using column_loops::dot_product;

/// About six are needed, as the method converges with the third order; more where eigenvalues coincide: then
/// a third of what is left goes with each.
constexpr int kRootStepsMax = 200;
constexpr double kStepRelative = 4.0 * std::numeric_limits<double>::epsilon();

/// A symmetric matrix of which both halves are stored: its columns are contiguous.
struct Square {
  double* first;
  Eigen::Index size;

  [[nodiscard]] double* column(Eigen::Index index) const { return first + index * size; }
};

/// Applies I - scale v v^T from both sides to the columns and rows from `first` on; v and `change` begin
/// there.
[[gnu::always_inline]] inline void reflect(const Square& matrix, Eigen::Index first, double scale,
                                           const double* v, double* change) {
  const Eigen::Index count = matrix.size - first;
  std::fill(change, change + count, 0.0);
  for (Eigen::Index j = 0; j < count; ++j)
    add_multiple(change, matrix.column(first + j) + first, scale * v[j], count);
  add_multiple(change, v, -0.5 * scale * dot_product(change, v, count), count);
  for (Eigen::Index j = 0; j < count; ++j)
    add_multiples(matrix.column(first + j) + first, v, -change[j], change, -v[j], count);
}

[[gnu::always_inline]] inline void tridiagonalise(const Square& matrix, double* v, double* change,
                                                  double* diagonal, double* squares_beside) {
  for (Eigen::Index k = 0; k < matrix.size; ++k) {
    double* below = matrix.column(k) + k + 1;
    const Eigen::Index count = matrix.size - k - 1;
    diagonal[k] = below[-1];
    if (count == 0) break;
    const double square = dot_product(below, below, count);
    squares_beside[k] = square;
    if (count == 1 || square == 0.0) continue;
    std::copy(below, below + count, v);
    v[0] += std::copysign(std::sqrt(square), v[0]);
    const double length = square + std::abs(below[0]) * std::sqrt(square);  // half of v . v
    reflect(matrix, k + 1, 1.0 / length, v, change);
  }
}

[[gnu::flatten]] void tridiagonalise_narrow(const Square& matrix, double* v, double* change, double* diagonal,
                                            double* squares_beside) {
  tridiagonalise(matrix, v, change, diagonal, squares_beside);
}

CALIB_FOR_WIDE_REGISTERS void tridiagonalise_wide(const Square& matrix, double* v, double* change,
                                                  double* diagonal, double* squares_beside) {
  tridiagonalise(matrix, v, change, diagonal, squares_beside);
}

/// From x below all eigenvalues of sign * T to the smallest: each step ends below it again. Nothing when x is
/// not below.
std::optional<double> smallest_from(double x, double sign, const Eigen::VectorXd& diagonal,
                                    const Eigen::VectorXd& squares_beside) {
  const auto count = static_cast<double>(diagonal.size());
  for (int step = 0; step < kRootStepsMax; ++step) {
    // The pivots of T - x and their derivatives by x: first and second derivative of log det(T - x), which
    // are minus the sums of 1 / (eigenvalue - x) and of its square.
    double inverse = 0.0, first = 0.0, second = 0.0, sum = 0.0, sum_of_squares = 0.0;
    for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
      const double beside = i == 0 ? 0.0 : squares_beside[i - 1] * inverse * inverse;
      const double pivot = sign * diagonal[i] - x - (i == 0 ? 0.0 : squares_beside[i - 1] * inverse);
      if (!(pivot > 0.0)) return step == 0 ? std::nullopt : std::optional(x);
      second = beside * (second - 2.0 * inverse * first * first);
      first = beside * first - 1.0;
      inverse = 1.0 / pivot;
      sum -= first * inverse;
      sum_of_squares -= second * inverse - first * first * inverse * inverse;
    }
    const double spread = std::max(0.0, (count - 1.0) * (count * sum_of_squares - sum * sum));
    const double by = count / (sum + std::sqrt(spread));
    x += by;
    if (by <= kStepRelative * std::abs(x)) break;
  }
  return x;
}

}  // namespace

bool ExtremeEigenvalues::compute(const Eigen::MatrixXd& symmetric) {
  const Eigen::Index size = symmetric.rows();
  reduced_ = symmetric;
  reflector_.resize(size, 2);
  diagonal_.resize(size);
  squares_beside_.resize(size);
  (has_wide_registers() ? tridiagonalise_wide : tridiagonalise_narrow)(
      {reduced_.data(), size}, reflector_.col(0).data(), reflector_.col(1).data(), diagonal_.data(),
      squares_beside_.data());
  // No eigenvalue is above the largest sum of a row's sizes (Gershgorin).
  double above = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) {
    const double before = i == 0 ? 0.0 : std::sqrt(squares_beside_[i - 1]);
    const double after = i + 1 == size ? 0.0 : std::sqrt(squares_beside_[i]);
    above = std::max(above, std::abs(diagonal_[i]) + before + after);
  }
  constexpr double kJustBeyond = 1.0 + 1e-6;
  smallest_ = smallest_from(0.0, 1.0, diagonal_, squares_beside_).value_or(0.0);
  largest_ = -smallest_from(-above * kJustBeyond, -1.0, diagonal_, squares_beside_).value_or(0.0);
  return smallest_ > 0.0;
}

}  // namespace calib
