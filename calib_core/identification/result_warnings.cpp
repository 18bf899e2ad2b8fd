#include "calib_core/identification/result_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace calib {
namespace {

void warn_of_weak(IdentificationResult& result) {
  std::string names;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const auto& candidate = result.identifiable.candidates[static_cast<std::size_t>(i)];
    if (candidate.status != ParameterStatus::kWeak) continue;
    names += (names.empty() ? "" : ", ") + error_parameters()[static_cast<std::size_t>(i)].name();
  }
  if (names.empty()) return;
  result.warnings.push_back("held at nominal because these touches hardly show it: " + names +
                            "; spread the touches over more postures and tilts");
}

/// Masses without the deviation of a compliance: the droop is neither in the model nor in an uncertainty.
void warn_of_droop(const IdentificationProblem& problem, IdentificationResult& result) {
  const auto has_mass = [](const PointMass& mass) { return mass.mass_kg > 0.0; };
  if (std::ranges::none_of(problem.nominal.masses, has_mass)) return;
  if (!estimable_compliances(problem.nongeometric_std).empty()) return;
  result.warnings.emplace_back(
      "the arm has masses but no standard deviation of a compliance of joints 1 to 3, so that its droop is "
      "in no uncertainty; add std_compliance_rad_per_nm to \"gravity\" in the arm's file");
}

void warn_of_drift(const IdentificationProblem& problem, IdentificationResult& result) {
  if (problem.drift_m == 0.0) return;
  result.warnings.push_back(
      "the reference place moved by " + std::to_string(std::lround(1e6 * problem.drift_m)) +
      " um while the touches were made: the arm was still warming up, or block or probe moved. The result is "
      "of the middle of that, and half of it is in the uncertainty; warm the arm up longer and calibrate "
      "again");
}

void warn_of_declared_noise(const IdentificationProblem& problem, IdentificationResult& result) {
  if (!result.is_declared_noise_too_large || !result.uncertainty) return;
  const auto micrometres = [](double metres) { return std::to_string(std::lround(1e6 * metres)) + " um"; };
  result.warnings.push_back(
      "the declared noise of a touch, " + micrometres(problem.touch_noise_m) +
      ", is too large: the residuals show " + micrometres(*result.noise_estimated_m) +
      ", which chance makes of it in less than 1 of 1,000 runs; " + micrometres(result.uncertainty->noise_m) +
      " were used. Write \"touch_noise_mm\" in the cell's file as small as the touches are");
}

}  // namespace

void add_warnings(const IdentificationProblem& problem, const IdentificationOptions& options,
                  IdentificationResult& result) {
  if (!options.prior) warn_of_weak(result);
  if (result.status == IdentificationStatus::kConverged) {
    warn_of_droop(problem, result);
    if (options.measure_noise) warn_of_declared_noise(problem, result);
    warn_of_drift(problem, result);
  }
  if (result.scale && !result.scale->warning.empty()) result.warnings.push_back(result.scale->warning);
}

}  // namespace calib
