#include "calib_core/estimation/outlier_rejection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib_core/estimation/goodness_of_fit.hpp"
#include "calib_core/estimation/internal/least_trimmed_squares.hpp"

namespace calib {
namespace {

/// A selection that has not settled after this many rounds will not settle.
constexpr int kRobustRoundsMax = 20;

/// Standard deviations of the wide prior of the robust start: plausible errors of arm and block.
constexpr double kPlausibleMetres = 0.010;
constexpr double kPlausibleRadians = 0.020;
constexpr double kLargeNoiseMetres = 1e-4;  // noise of a touch when none is declared

/// Seed of the random subsets: fixed, so that the same touches give the same result.
constexpr std::uint64_t kRobustSeed = 20111101;

}  // namespace

bool OutlierRejection::is_consistent() {
  if (!known_noise_) return fit_.residuals_m().cwiseAbs().maxCoeff() < kScatterMinMetres;
  return studentized_residuals(fit_).maxCoeff() <=
         studentized_residual_max(fit_.kept_count(), std::numeric_limits<double>::infinity());
}

void OutlierRejection::run(const std::vector<int>& identifiable) {
  Estimate estimate = iteration_.start();
  const std::vector<bool> core = start(identifiable, estimate);
  std::vector<bool> kept = core;
  // The scatter of the best half is too small to test the others: the half is kept until no touch joins it.
  bool growing = true;
  for (int round = 0; round < kRobustRoundsMax; ++round) {
    fit_.keep(kept);
    if (!iteration_.run(estimate, false)) return;
    const std::vector<bool> good = find_inliers(estimate);
    std::vector<bool> next = good;
    for (std::size_t i = 0; growing && i < next.size(); ++i) next[i] = good[i] || core[i];
    if (growing && next == kept) {
      growing = false;
      next = good;
    }
    if (next == kept) return;
    kept = next;
  }
}

std::vector<bool> OutlierRejection::start(const std::vector<int>& identifiable, Estimate& estimate) {
  std::vector<bool> all(fit_.touches().size(), true);
  fit_.keep(all);
  fit_.linearise(estimate);
  std::mt19937_64 chance(kRobustSeed);
  std::vector<Eigen::Index> positions;
  for (std::size_t i = 0; i < fit_.arm_columns().size(); ++i) {
    if (std::ranges::binary_search(identifiable, fit_.arm_columns()[i])) {
      positions.push_back(static_cast<Eigen::Index>(i));
    }
  }
  const double noise = known_noise_ ? 1.0 : kLargeNoiseMetres / fit_.noise_unit_m();
  Eigen::VectorXd precision(static_cast<Eigen::Index>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const int column = fit_.arm_columns()[static_cast<std::size_t>(positions[i])];
    const double std = error_parameters()[static_cast<std::size_t>(column)].is_length() ? kPlausibleMetres
                                                                                        : kPlausibleRadians;
    precision[static_cast<Eigen::Index>(i)] = noise * noise / (std * std);
  }
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::MatrixXd rows = fit_.rows()(Eigen::all, positions);
    const auto trimmed = least_trimmed_squares(rows, fit_.weighted_targets(), precision, chance);
    if (!trimmed) return all;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      estimate.arm[fit_.arm_columns()[static_cast<std::size_t>(positions[i])]] +=
          trimmed->solution[static_cast<Eigen::Index>(i)];
    }
    all = trimmed->core;
    fit_.linearise(estimate);
  }
  return all;
}

std::vector<bool> OutlierRejection::find_inliers(const Estimate& estimate) {
  const Eigen::VectorXd sizes = studentized_residuals(fit_);
  const auto estimated = estimated_noise_m(fit_, estimate);
  const double scatter = std::max(estimated.value_or(0.0), kScatterMinMetres) / fit_.noise_unit_m();
  const bool noise_as_declared = known_noise_ && scatter <= 1.0;
  const double unit = noise_as_declared ? 1.0 : scatter;
  const double degrees =
      noise_as_declared ? std::numeric_limits<double>::infinity() : std::max(1, fit_.degrees_of_freedom());
  const double limit = unit * studentized_residual_max(static_cast<int>(sizes.size()), degrees);
  std::vector<bool> kept(static_cast<std::size_t>(sizes.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i] = sizes[static_cast<Eigen::Index>(i)] <= limit;
  }
  return kept;
}

}  // namespace calib
