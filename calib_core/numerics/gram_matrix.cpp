#include "calib_core/numerics/gram_matrix.hpp"

#include <algorithm>
#include <array>

#include "calib_core/numerics/column_loops.hpp"
#include "calib_core/numerics/wide_registers.hpp"

// Everything that takes or gives registers is inlined: how they would be passed does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace calib {
namespace {

constexpr Eigen::Index kRowsAtOnce = column_loops::kAtOnce;
constexpr Eigen::Index kTile = 4;  // columns: the sums of a tile stay in registers

using FourRows = column_loops::Numbers;
using column_loops::load;

using Columns = std::array<const double*, kTile>;

/// The products of two tiles of columns.
[[gnu::always_inline]] inline void multiply_tiles(const Columns& left, const Columns& right,
                                                  Eigen::Index rows, double (&products)[kTile][kTile]) {
  FourRows sums[kTile][kTile] = {};
  Eigen::Index row = 0;
  for (; row + kRowsAtOnce <= rows; row += kRowsAtOnce) {
    FourRows of_right[kTile];
    for (std::size_t j = 0; j < kTile; ++j) of_right[j] = load(right[j] + row);
    for (std::size_t i = 0; i < kTile; ++i) {
      const FourRows of_left = load(left[i] + row);
      for (std::size_t j = 0; j < kTile; ++j) sums[i][j] += of_left * of_right[j];
    }
  }
  for (std::size_t i = 0; i < kTile; ++i) {
    for (std::size_t j = 0; j < kTile; ++j) {
      double sum = (sums[i][j][0] + sums[i][j][1]) + (sums[i][j][2] + sums[i][j][3]);
      for (Eigen::Index rest = row; rest < rows; ++rest) sum += left[i][rest] * right[j][rest];
      products[i][j] = sum;
    }
  }
}

[[gnu::always_inline]] inline void multiply(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                                            Eigen::MatrixXd& gram) {
  const Eigen::Index count = rows.cols();
  const auto columns_from = [&](Eigen::Index first) {
    Columns columns;  // beyond the last column once more the last
    for (std::size_t j = 0; j < kTile; ++j)
      columns[j] =
          rows.data() + std::min(first + static_cast<Eigen::Index>(j), count - 1) * rows.outerStride();
    return columns;
  };
  double products[kTile][kTile];
  for (Eigen::Index j = 0; j < count; j += kTile) {
    const Columns right = columns_from(j);
    for (Eigen::Index i = 0; i <= j; i += kTile) {
      multiply_tiles(columns_from(i), right, rows.rows(), products);
      for (Eigen::Index b = j; b < std::min(j + kTile, count); ++b) {
        for (Eigen::Index a = i; a < std::min(i + kTile, count); ++a)
          gram(a, b) = gram(b, a) = products[a - i][b - j];
      }
    }
  }
}

[[gnu::flatten]] void multiply_narrow(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::MatrixXd& gram) {
  multiply(rows, gram);
}

CALIB_FOR_WIDE_REGISTERS void multiply_wide(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                                            Eigen::MatrixXd& gram) {
  multiply(rows, gram);
}

}  // namespace

void gram_matrix(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::MatrixXd& gram) {
  gram.resize(rows.cols(), rows.cols());
  (has_wide_registers() ? multiply_wide : multiply_narrow)(rows, gram);
}

}  // namespace calib
