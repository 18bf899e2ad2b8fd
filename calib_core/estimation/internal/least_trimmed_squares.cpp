#include "calib_core/estimation/internal/least_trimmed_squares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib_core/numerics/distributions.hpp"
#include "calib_core/numerics/scaled_cholesky.hpp"

namespace calib {
namespace {

constexpr int kStarts = 500;  // 36 without outliers when one touch in ten is one and there are 25 unknowns
constexpr int kRefined = 10;
constexpr int kConcentrationsMax = 30;
constexpr Eigen::Index kSpareRowsMin = 5;
constexpr Eigen::Index kRowsMax = 600;  // a sample of more rows is enough for a start

/// Moves `count` random indices to the front.
void draw(std::vector<Eigen::Index>& indices, Eigen::Index count, std::mt19937_64& chance) {
  const auto size = indices.size();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    std::swap(indices[i], indices[i + chance() % (size - i)]);
  }
}

/// Concentration steps: fit, select the rows that fit best, repeat.
class Concentration {
 public:
  Concentration(const Eigen::MatrixXd& rows, const Eigen::VectorXd& targets, const Eigen::VectorXd& precision)
      : rows_(rows),
        targets_(targets),
        precision_(precision),
        half_((rows.rows() + rows.cols() + 1) / 2),
        indices_(static_cast<std::size_t>(rows.rows())) {}

  /// Starts from `cols` random rows and makes two steps; false when these do not determine a solution.
  bool start(std::mt19937_64& chance, Eigen::VectorXd& solution) {
    std::iota(indices_.begin(), indices_.end(), 0);
    draw(indices_, rows_.cols(), chance);
    return solve(rows_.cols(), solution) && step(solution) && step(solution);
  }

  /// One concentration step; objective() is that of the given solution.
  bool step(Eigen::VectorXd& solution) {
    squares_ = (targets_ - rows_ * solution).cwiseAbs2();
    std::iota(indices_.begin(), indices_.end(), 0);
    std::nth_element(indices_.begin(), indices_.begin() + half_, indices_.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return squares_[a] < squares_[b]; });
    objective_ = precision_.dot(solution.cwiseAbs2());
    for (Eigen::Index i = 0; i < half_; ++i) objective_ += squares_[indices_[static_cast<std::size_t>(i)]];
    return solve(half_, solution);
  }

  [[nodiscard]] double objective() const { return objective_; }
  [[nodiscard]] std::vector<bool> core() const {
    std::vector<bool> core(indices_.size(), false);
    for (Eigen::Index i = 0; i < half_; ++i) {
      core[static_cast<std::size_t>(indices_[static_cast<std::size_t>(i)])] = true;
    }
    return core;
  }

 private:
  /// Least squares of the first `count` rows of indices_, with the prior.
  bool solve(Eigen::Index count, Eigen::VectorXd& solution) {
    chosen_rows_.resize(count, rows_.cols());
    chosen_targets_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index row = indices_[static_cast<std::size_t>(i)];
      chosen_rows_.row(i) = rows_.row(row);
      chosen_targets_[i] = targets_[row];
    }
    Eigen::MatrixXd gram = chosen_rows_.transpose() * chosen_rows_;
    gram.diagonal() += precision_;
    const ScaledCholesky cholesky(gram);
    if (!cholesky.is_positive_definite()) return false;
    solution = cholesky.solve(chosen_rows_.transpose() * chosen_targets_);
    return solution.allFinite();
  }

  const Eigen::MatrixXd& rows_;
  const Eigen::VectorXd& targets_;
  const Eigen::VectorXd& precision_;
  Eigen::Index half_;
  std::vector<Eigen::Index> indices_;
  Eigen::MatrixXd chosen_rows_;
  Eigen::VectorXd chosen_targets_, squares_;
  double objective_ = 0.0;
};

/// The fit to a sample of the rows. Its core: all rows with residuals below the median of the sample.
std::optional<TrimmedFit> from_sample(const Eigen::MatrixXd& rows, const Eigen::VectorXd& targets,
                                      const Eigen::VectorXd& precision, std::mt19937_64& chance) {
  std::vector<Eigen::Index> indices(static_cast<std::size_t>(rows.rows()));
  std::iota(indices.begin(), indices.end(), 0);
  draw(indices, kRowsMax, chance);
  indices.resize(static_cast<std::size_t>(kRowsMax));
  const Eigen::MatrixXd sample = rows(indices, Eigen::all);
  const Eigen::VectorXd sample_targets = targets(indices);
  auto fit = least_trimmed_squares(sample, sample_targets, precision, chance);
  if (!fit) return fit;
  Eigen::VectorXd residuals = (sample_targets - sample * fit->solution).cwiseAbs();
  const auto middle = residuals.size() / 2;
  std::nth_element(residuals.begin(), residuals.begin() + middle, residuals.end());
  const Eigen::VectorXd all = (targets - rows * fit->solution).cwiseAbs();
  fit->core.assign(static_cast<std::size_t>(rows.rows()), false);
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    fit->core[static_cast<std::size_t>(row)] = all[row] <= residuals[middle];
  }
  return fit;
}

}  // namespace

std::optional<TrimmedFit> least_trimmed_squares(const Eigen::MatrixXd& rows, const Eigen::VectorXd& targets,
                                                const Eigen::VectorXd& precision, std::mt19937_64& chance) {
  if (rows.rows() > kRowsMax) return from_sample(rows, targets, precision, chance);
  if (rows.rows() < rows.cols() + kSpareRowsMin || rows.cols() == 0) return std::nullopt;
  Concentration concentration(rows, targets, precision);
  std::vector<std::pair<double, Eigen::VectorXd>> best;
  for (int start = 0; start < kStarts; ++start) {
    Eigen::VectorXd solution;
    if (!concentration.start(chance, solution)) continue;
    best.emplace_back(concentration.objective(), solution);
    std::ranges::sort(best, {}, [](const auto& candidate) { return candidate.first; });
    if (best.size() > kRefined) best.pop_back();
  }
  std::optional<TrimmedFit> winner;
  double least = 0.0;
  for (auto& [objective, solution] : best) {
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kConcentrationsMax && concentration.step(solution); ++i) {
      if (concentration.objective() >= before * (1.0 - 1e-9)) break;
      before = concentration.objective();
    }
    if (!solution.allFinite() || (winner && concentration.objective() >= least)) continue;
    least = concentration.objective();
    winner = TrimmedFit{solution, concentration.core()};
  }
  return winner;
}

Eigen::VectorXd studentized_residuals(LeastSquares& fit) {
  const Eigen::VectorXd& leverages = fit.leverages();
  Eigen::VectorXd result(leverages.size());
  for (Eigen::Index row = 0; row < result.size(); ++row) {
    const bool kept = fit.kept()[static_cast<std::size_t>(row)];
    // The residual of a touch that alone determines a direction is always 0.
    const double remaining = std::max(kept ? 1.0 - leverages[row] : 1.0 + leverages[row], 1e-6);
    result[row] = std::abs(fit.residuals_m()[row]) / fit.noise_unit_m() / fit.noise_factors()[row] /
                  std::sqrt(remaining);
  }
  return result;
}

double studentized_residual_max(int count, double degrees_of_freedom) {
  return student_two_sided_factor(1.0 - kFalseAlarmsPerSet / std::max(count, 1), degrees_of_freedom);
}

}  // namespace calib
