#include "calib_core/uncertainty/uncertainty_budget.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/numerics/distributions.hpp"

namespace calib {
namespace {

constexpr double kConfidence = 0.95;
constexpr double kShareMin = 1e-6;  // of the noise: a smaller one leaves a normal distribution

}  // namespace

double UncertaintyBudget::coverage_factor_of(double variance, double noise_variance,
                                             double drift_variance) const {
  const double share = noise_variance / variance;
  double effective = share <= 1.0 ? degrees_of_freedom / std::max(share * share, kShareMin)
                                  : degrees_of_freedom;  // also where nothing is known
  if (drift_variance > 0.0 && drift_degrees_of_freedom > 0.0)
    effective = 1.0 / (1.0 / effective + std::pow(drift_variance / variance, 2) / drift_degrees_of_freedom);
  return student_two_sided_factor(kConfidence, effective);
}

UncertaintyBudget in_arm_frame(const UncertaintyBudget& budget) {
  UncertaintyBudget result;
  result.noise_m = budget.noise_m;
  result.degrees_of_freedom = budget.degrees_of_freedom;
  result.of_noise = budget.of_noise;
  result.identified = budget.identified;
  result.held = budget.held;
  result.unseen = budget.unseen;
  result.of_posture = budget.of_posture;
  result.of_drift = budget.of_drift;
  result.drift_degrees_of_freedom = budget.drift_degrees_of_freedom;
  result.unseen_without_tolerance = budget.unseen_without_tolerance;
  result.unknown_directions = budget.unknown_directions;
  for (int i = 0; i < kArmParameterCount; ++i) {
    if (!is_place_error(i)) continue;
    for (ArmCovariance* part : {&result.of_noise, &result.identified, &result.held, &result.unseen}) {
      part->row(i).setZero();
      part->col(i).setZero();
    }
    result.unknown_directions.row(i).setZero();
  }
  return result;
}

}  // namespace calib
