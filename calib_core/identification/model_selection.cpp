#include "calib_core/identification/model_selection.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/numerics/distributions.hpp"

namespace calib {
namespace {

std::string words_of(const NestedTest& test) {
  std::ostringstream figures;
  figures.precision(2);
  figures << " (F " << test.f << ", p " << test.p << ")";
  return figures.str();
}

std::string words_of(const HeldOutTest& test) {
  std::ostringstream figures;
  figures.precision(3);
  figures << " (" << test.touch_count << " of rms " << 1e6 * test.smaller_rms_m << " um, with them "
          << 1e6 * test.larger_rms_m << " um, p ";
  figures.precision(2);
  figures << test.p << ")";
  return figures.str();
}

/// Residuals of these touches at the arm and the artefact of a result, in units of the declared noise's
/// touch.
Eigen::VectorXd residuals_m(const IdentificationProblem& problem, const IdentificationResult& result,
                            const std::vector<Touch>& touches) {
  std::vector<ContactSurface> planes;
  correct_contact_planes(problem.artefact, result.artefact_errors, planes);
  Eigen::VectorXd distances_m = signed_distances_m(result.calibrated, planes, touches);
  for (std::size_t i = 0; i < touches.size(); ++i)
    distances_m[static_cast<Eigen::Index>(i)] /= noise_factor(touches[i], problem.touch_noise_m);
  return distances_m;
}

/// With those that were rejected: one bad touch does not change what is tried of a plan.
int touches_to_fit(const IdentificationResult& result) {
  return result.fitted_touch_count + static_cast<int>(std::ssize(result.rejected));
}

bool has_deviation_among(const IdentificationProblem& problem, bool (*is_one)(int)) {
  for (int position = 0; position < kNongeometricCount; ++position)
    if (is_one(position) && problem.nongeometric_std[static_cast<std::size_t>(position)]) return true;
  return false;
}

std::optional<std::string> against_few(int touches, int least) {
  if (touches >= least) return std::nullopt;
  return std::to_string(touches) + " touches to fit are too few, it takes " + std::to_string(least);
}

}  // namespace

std::optional<NestedTest> test_nested(const ResidualSum& smaller, const ResidualSum& larger) {
  const double added = smaller.noise_degrees() - larger.noise_degrees();
  const double left = larger.noise_degrees();
  constexpr double kDegreesMin = 0.5;
  if (added < kDegreesMin || left < kDegreesMin || larger.sum_of_squares <= 0.0) return std::nullopt;
  const double explained = std::max(0.0, smaller.sum_of_squares - larger.sum_of_squares);
  const double f = (explained / added) / (larger.sum_of_squares / left);
  return NestedTest{f, f_survival(f, added, left)};
}

std::optional<HeldOutTest> test_held_out(const Eigen::VectorXd& smaller_m, const Eigen::VectorXd& larger_m) {
  const Eigen::Index count = smaller_m.size();
  if (count < kHeldOutTouchesMin) return std::nullopt;
  const Eigen::ArrayXd decrease = smaller_m.array().square() - larger_m.array().square();
  const auto touches = static_cast<double>(count);
  const double variance = (decrease - decrease.mean()).square().sum() / (touches - 1.0);
  if (!(variance > 0.0)) return std::nullopt;
  const double t = decrease.mean() / std::sqrt(variance / touches);
  const double two_sided = f_survival(t * t, 1.0, touches - 1.0);
  return HeldOutTest{.touch_count = static_cast<int>(count),
                     .smaller_rms_m = smaller_m.norm() / std::sqrt(touches),
                     .larger_rms_m = larger_m.norm() / std::sqrt(touches),
                     .t = t,
                     .p = t > 0.0 ? 0.5 * two_sided : 1.0 - 0.5 * two_sided};
}

std::optional<HeldOutTest> test_held_out(const IdentificationProblem& problem,
                                         const IdentificationResult& smaller,
                                         const IdentificationResult& larger) {
  std::vector<Touch> held_out;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    if (problem.touches[i].role != TouchRole::kHeldOut) continue;
    const bool is_rejected =
        std::ranges::find(larger.rejected, i, &RejectedTouch::touch) != larger.rejected.end();
    if (!is_rejected) held_out.push_back(problem.touches[i]);
  }
  if (std::ssize(held_out) < kHeldOutTouchesMin) return std::nullopt;
  return test_held_out(residuals_m(problem, smaller, held_out), residuals_m(problem, larger, held_out));
}

ModelChoice choose_model(const std::string& what, const IdentificationProblem& problem,
                         const IdentificationResult& smaller, const IdentificationResult& larger) {
  if (larger.status != IdentificationStatus::kConverged)
    return {false, what + " left out: with them the fit did not converge"};
  const auto of_fitted = test_nested(smaller.residual_sum, larger.residual_sum);
  if (!of_fitted) return {false, what + " left out: the touches cannot tell them"};
  const auto of_held_out = test_held_out(problem, smaller, larger);
  const bool fitted_ask = of_fitted->p < kLargerModelP;
  const bool held_out_ask = of_held_out && of_held_out->p < kLargerModelP;
  const std::string fitted = words_of(*of_fitted);
  const std::string held_out = of_held_out ? words_of(*of_held_out) : "";
  if (!of_held_out) {
    return {fitted_ask, what +
                            (fitted_ask ? " taken: the fitted touches ask for them"
                                        : " left out: the fitted touches do not ask for them") +
                            fitted};
  }
  if (fitted_ask) {
    return {true, what + " taken: the fitted touches ask for them" + fitted +
                      (held_out_ask ? ", so do the held-out ones" : ", the held-out ones do not") + held_out};
  }
  if (held_out_ask) {
    return {true, what + " taken: the held-out touches ask for them" + held_out + ", the fitted ones do not" +
                      fitted};
  }
  return {false, what + " left out: the fitted touches do not ask for them" + fitted +
                     ", nor do the held-out ones" + held_out};
}

std::optional<std::string> against_harmonics(const IdentificationProblem& problem,
                                             const IdentificationOptions& options,
                                             const IdentificationResult& without) {
  const bool is_wanted = options.harmonics == Harmonics::kWhenShown && !options.nongeometric &&
                         without.status == IdentificationStatus::kConverged;
  if (!is_wanted || !has_deviation_among(problem, is_harmonic)) return "";
  if (!options.stiffness) return "alone they would take up the droop, and no compliance is estimated";
  return against_few(touches_to_fit(without), kHarmonicTouchesMin);
}

std::optional<std::string> against_ripple(const IdentificationProblem& problem,
                                          const IdentificationOptions& options,
                                          const IdentificationResult& without) {
  const bool is_wanted = options.ripple == Ripple::kWhenShown && !options.nongeometric &&
                         without.status == IdentificationStatus::kConverged;
  if (!is_wanted || !has_deviation_among(problem, is_ripple)) return "";
  if (!(problem.touch_noise_m > 0.0)) return "the noise of a touch is given as 0";
  return against_few(touches_to_fit(without), kRippleTouchesMin);
}

bool is_reweighed(const IdentificationProblem& problem, const IdentificationOptions& options,
                  const IdentificationResult& declared) {
  if (!declared.uncertainty || !options.measure_noise) return false;
  if (!has_priors(problem, options) && declared.nongeometric.empty()) return false;
  const double ratio = declared.uncertainty->noise_m / problem.touch_noise_m;
  return std::max(ratio, 1.0 / ratio) >= kReweighRatio;
}

IdentificationOptions settled_options(IdentificationOptions options, const IdentificationResult& result) {
  options.robust = false;
  options.nongeometric = result.nongeometric;
  return options;
}

}  // namespace calib
