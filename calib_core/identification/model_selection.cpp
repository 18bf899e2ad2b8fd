#include "calib_core/identification/model_selection.hpp"

#include <algorithm>
#include <sstream>

#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/numerics/distributions.hpp"

namespace calib {

std::optional<NestedTest> test_nested(const ResidualSum& smaller, const ResidualSum& larger) {
  const double added = larger.effective_parameters - smaller.effective_parameters;
  const double left = larger.touch_count - larger.effective_parameters;
  constexpr double kDegreesMin = 0.5;
  if (added < kDegreesMin || left < kDegreesMin || larger.sum_of_squares <= 0.0) return std::nullopt;
  const double explained = std::max(0.0, smaller.sum_of_squares - larger.sum_of_squares);
  const double f = (explained / added) / (larger.sum_of_squares / left);
  return NestedTest{f, f_survival(f, added, left)};
}

ModelChoice choose_harmonics(const IdentificationResult& without, const IdentificationResult& with) {
  if (with.status != IdentificationStatus::kConverged)
    return {false, "first harmonics of the joints left out: with them the fit did not converge"};
  const auto test = test_nested(without.residual_sum, with.residual_sum);
  if (!test) return {false, "first harmonics of the joints left out: the touches cannot tell them"};
  std::ostringstream figures;
  figures.precision(2);
  figures << " (F " << test->f << ", p " << test->p << ")";
  if (test->p < kLargerModelP)
    return {true, "first harmonics of the joints taken: the touches ask for them" + figures.str()};
  return {false, "first harmonics of the joints left out: the touches do not ask for them" + figures.str()};
}

bool tries_harmonics(const IdentificationProblem& problem, const IdentificationOptions& options,
                     const IdentificationResult& without) {
  bool is_declared = false;
  for (int position = harmonic_position(0); is_harmonic(position); ++position)
    is_declared = is_declared || problem.nongeometric_std[static_cast<std::size_t>(position)];
  return options.harmonics == Harmonics::kWhenShown && options.stiffness && is_declared &&
         without.status == IdentificationStatus::kConverged &&
         without.fitted_touch_count >= kHarmonicTouchesMin;
}

bool is_reweighed(const IdentificationProblem& problem, const IdentificationOptions& options,
                  const IdentificationResult& declared) {
  if (!declared.uncertainty || !options.measure_noise || !has_priors(problem, options)) return false;
  const double ratio = declared.uncertainty->noise_m / problem.touch_noise_m;
  return std::max(ratio, 1.0 / ratio) >= kReweighRatio;
}

IdentificationOptions settled_options(IdentificationOptions options, const IdentificationResult& result) {
  const bool has_harmonics =
      std::ranges::any_of(result.nongeometric, [](int position) { return is_harmonic(position); });
  options.robust = false;
  options.harmonics = has_harmonics ? Harmonics::kEstimate : Harmonics::kLeaveOut;
  return options;
}

}  // namespace calib
