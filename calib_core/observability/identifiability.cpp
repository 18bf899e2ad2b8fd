#include "calib_core/observability/identifiability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib_core/numerics/column_loops.hpp"
#include "calib_core/numerics/wide_registers.hpp"

namespace calib {
namespace {

/// The rounding error of a dependent column relative to the longest column. The tolerance of eq. 13 is
/// smaller when there are few rows; the weakest independent direction is nine orders of magnitude larger.
constexpr double kRoundingRelative = 1e-13;

/// Factors below this fraction of the largest are rounding errors.
constexpr double kFactorRelative = 1e-9;

std::vector<int> column_order(const IdentifiabilityOptions& options) {
  const auto listed = [](const std::vector<int>& list, int column) {
    return std::ranges::find(list, column) != list.end();
  };
  std::vector<int> order;
  for (int column = 0; column < kErrorParameterCount; ++column) {
    if (!listed(options.excluded, column) && !listed(options.tried_last, column)) order.push_back(column);
  }
  for (const int column : options.tried_last) {
    if (!listed(options.excluded, column)) order.push_back(column);
  }
  return order;
}

/// Reflectors are the columns of a matrix: number i acts on the rows from i on.
[[gnu::always_inline]] inline void reflect(const Eigen::MatrixXd& reflectors, Eigen::Index count,
                                           double* column) {
  for (Eigen::Index i = 0; i < count; ++i) {
    const double* v = reflectors.data() + i * reflectors.rows() + i;
    const Eigen::Index rows = reflectors.rows() - i;
    column_loops::add_multiple(column + i, v, -2.0 * column_loops::dot_product(v, column + i, rows), rows);
  }
}

[[gnu::flatten]] void reflect_narrow(const Eigen::MatrixXd& reflectors, Eigen::Index count, double* column) {
  reflect(reflectors, count, column);
}

CALIB_FOR_WIDE_REGISTERS void reflect_wide(const Eigen::MatrixXd& reflectors, Eigen::Index count,
                                           double* column) {
  reflect(reflectors, count, column);
}

/// Householder reflectors of the kept columns, in the order they were kept.
class Reflectors {
 public:
  Reflectors(Eigen::Index rows, Eigen::Index count_max) : vectors_(rows, std::min(rows, count_max)) {}

  [[nodiscard]] Eigen::Index count() const { return count_; }

  void apply_to(Eigen::VectorXd& column) const {
    (has_wide_registers() ? reflect_wide : reflect_narrow)(vectors_, count_, column.data());
  }

  /// Keeps a column that apply_to() has transformed; its tail is reflected onto one entry.
  void keep(Eigen::VectorXd& column) {
    auto tail = column.tail(vectors_.rows() - count_);
    const double norm = tail.norm();
    auto v = vectors_.col(count_).tail(tail.size());
    v = tail;
    const double head = v[0] > 0.0 ? -norm : norm;
    v[0] -= head;
    v.normalize();
    tail.setZero();
    tail[0] = head;
    ++count_;
  }

 private:
  Eigen::MatrixXd vectors_;
  Eigen::Index count_ = 0;
};

/// Columns that were kept, reflected, in their order: the leading ones, then candidates.
struct KeptColumns {
  std::vector<int> leading, candidates;
  std::vector<Eigen::VectorXd> reflected;

  void keep_leading(int index, const Eigen::VectorXd& column) {
    leading.push_back(index);
    reflected.push_back(column);
  }
  void keep_candidate(int index, const Eigen::VectorXd& column) {
    candidates.push_back(index);
    reflected.push_back(column);
  }
};

/// Notes the factors f of a dependent column as a combination of the kept ones: R f = top of the reflected
/// column.
void note_combination(const KeptColumns& kept, const Eigen::VectorXd& reflected, CandidateStatus& candidate) {
  const auto count = static_cast<Eigen::Index>(kept.reflected.size());
  if (count == 0) return;
  Eigen::MatrixXd r(count, count);
  for (Eigen::Index j = 0; j < count; ++j) r.col(j) = kept.reflected[static_cast<std::size_t>(j)].head(count);
  const Eigen::VectorXd factors = r.triangularView<Eigen::Upper>().solve(reflected.head(count));
  const double least = kFactorRelative * factors.cwiseAbs().maxCoeff();
  const auto note = [&](const std::vector<int>& indices, Eigen::Index first, auto& list) {
    for (std::size_t j = 0; j < indices.size(); ++j) {
      const double factor = factors[first + static_cast<Eigen::Index>(j)];
      if (std::abs(factor) > least) list.emplace_back(indices[j], factor);
    }
  };
  note(kept.leading, 0, candidate.grouped_with_leading);
  note(kept.candidates, std::ssize(kept.leading), candidate.grouped_with);
}

}  // namespace

IdentifiableSet choose_identifiable(const Eigen::Ref<const Eigen::MatrixXd>& observation_matrix,
                                    const IdentifiabilityOptions& options,
                                    const WeakDiagonals& weak_diagonals, const Eigen::MatrixXd& leading) {
  IdentifiableSet set;
  set.smallest_kept = std::numeric_limits<double>::infinity();
  for (const int column : options.excluded) {
    set.candidates[static_cast<std::size_t>(column)].status = ParameterStatus::kExcluded;
  }

  const double longest = observation_matrix.rows() > 0 ? observation_matrix.colwise().norm().maxCoeff() : 0.0;
  const double rounding =
      std::max(static_cast<double>(observation_matrix.rows()) * std::numeric_limits<double>::epsilon(),
               kRoundingRelative) *
      longest;
  const double tolerance = std::max(options.qr_tolerance.value_or(0.0), rounding);
  const Eigen::Index rows = observation_matrix.rows();

  Reflectors reflectors(rows, leading.cols() + observation_matrix.cols());
  KeptColumns kept;
  for (Eigen::Index i = 0; i < leading.cols() && reflectors.count() < rows; ++i) {
    Eigen::VectorXd reflected = leading.col(i);
    reflectors.apply_to(reflected);
    if (reflected.tail(rows - reflectors.count()).norm() <= rounding) continue;
    reflectors.keep(reflected);
    kept.keep_leading(static_cast<int>(i), reflected);
  }
  for (const int column : column_order(options)) {
    CandidateStatus& candidate = set.candidates[static_cast<std::size_t>(column)];
    Eigen::VectorXd reflected = observation_matrix.col(column);
    if (reflected.norm() <= rounding) continue;  // stays kNoEffect
    reflectors.apply_to(reflected);
    const double diagonal = reflected.tail(rows - reflectors.count()).norm();  // |R_ii|
    if (diagonal > std::max(tolerance, weak_diagonals[static_cast<std::size_t>(column)])) {
      candidate.status = ParameterStatus::kIdentified;
      set.smallest_kept = std::min(set.smallest_kept, diagonal);
      reflectors.keep(reflected);
      kept.keep_candidate(column, reflected);
      continue;
    }
    set.largest_dropped = std::max(set.largest_dropped, diagonal);
    candidate.status = diagonal > rounding ? ParameterStatus::kWeak : ParameterStatus::kGrouped;
    if (candidate.status == ParameterStatus::kGrouped) note_combination(kept, reflected, candidate);
  }
  set.columns = kept.candidates;
  std::ranges::sort(set.columns);
  return set;
}

Eigen::MatrixXd select_columns(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                               const std::vector<int>& columns) {
  Eigen::MatrixXd selected(matrix.rows(), static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index j = 0; j < selected.cols(); ++j)
    selected.col(j) = matrix.col(columns[static_cast<std::size_t>(j)]);
  return selected;
}

}  // namespace calib
