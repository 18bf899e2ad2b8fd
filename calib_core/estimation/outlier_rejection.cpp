#include "calib_core/estimation/outlier_rejection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib_core/estimation/internal/least_trimmed_squares.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {
namespace {

/// More robust rounds than this do not settle.
constexpr int kRobustRoundsMax = 20;

/// What an arm may well be off by, or its block: the wide prior of the robust start.
constexpr double kPlausibleMetres = 0.010;
constexpr double kPlausibleRadians = 0.020;
constexpr double kLargeNoiseMetres = 1e-4;  // of a touch, where none is declared

/// The chance of the robust start's random subsets: fixed, so that the same touches give the same result.
constexpr std::uint64_t kRobustSeed = 20111101;

}  // namespace

bool RobustSearch::nothing_suspect() {
  if (!known_noise_) return fit_.residuals_m().cwiseAbs().maxCoeff() < kScatterMinMetres;
  return studentized(fit_).maxCoeff() <=
         largest_expected(fit_.kept_count(), std::numeric_limits<double>::infinity());
}

void RobustSearch::run(const std::vector<int>& identifiable) {
  Estimate estimate = iterations_.nominal();
  const std::vector<bool> core = start(identifiable, estimate);
  std::vector<bool> kept = core;
  // The half that agrees best scatters too little to judge the others by: it is kept until no more join it.
  bool growing = true;
  for (int round = 0; round < kRobustRoundsMax; ++round) {
    fit_.keep(kept);
    if (!iterations_.run(estimate, false)) return;
    const std::vector<bool> good = judged(estimate);
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

std::vector<bool> RobustSearch::start(const std::vector<int>& identifiable, Estimate& estimate) {
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

std::vector<bool> RobustSearch::judged(const Estimate& estimate) {
  const Eigen::VectorXd sizes = studentized(fit_);
  const auto estimated = estimated_noise_m(fit_, estimate);
  const double scatter = std::max(estimated.value_or(0.0), kScatterMinMetres) / fit_.noise_unit_m();
  const bool declared_holds = known_noise_ && scatter <= 1.0;
  const double unit = declared_holds ? 1.0 : scatter;
  const double degrees =
      declared_holds ? std::numeric_limits<double>::infinity() : std::max(1, fit_.degrees_of_freedom());
  const double limit = unit * largest_expected(static_cast<int>(sizes.size()), degrees);
  std::vector<bool> kept(static_cast<std::size_t>(sizes.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i] = sizes[static_cast<Eigen::Index>(i)] <= limit;
  }
  return kept;
}

}  // namespace calib
