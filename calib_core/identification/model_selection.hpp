#pragma once

#include <optional>
#include <string>

#include "calib_core/identification/identification_result.hpp"

/// Whether the gears' errors that repeat with a joint's position are estimated: first harmonics, then ripple
/// at the maker's periods. Each is fitted beside what is there and kept when one of two voices asks for it:
/// the fitted touches by a nested F-test, or the held-out touches by a paired test of their squares.
///
/// The held-out touches are never fitted, but a choice between two models by them is a use of them: the model
/// that they prefer looks better at them than it is. This is bounded twice. They choose between two models,
/// not among many, and only where chance alone does so in less than 1 of 100 runs: even gears are taken for
/// eccentric ones by them alone in 1 of 1,000 runs, and their mean square is too small by 0.013 % in the mean
/// over runs (tests/figures/gear_model_test). So the verdict judges the arm that was taken by all that was
/// held out, with the limits as they are; the reason in the result names the voice, and proof touches
/// (TouchRole::kProof), which choose nothing, judge without it.
namespace calib {

/// Harmonics are tried from this many touches to fit on, the rejected ones with them: with fewer they cost
/// more than they bring.
inline constexpr int kHarmonicTouchesMin = 60;

/// Ripple likewise.
inline constexpr int kRippleTouchesMin = 100;

/// Fewer held-out touches are not asked.
inline constexpr int kHeldOutTouchesMin = 20;

/// A fit is repeated when the measured noise differs from the declared one by more than this factor.
inline constexpr double kReweighRatio = 1.1;

/// The larger model is taken when chance alone would reduce the residuals as much less often than this: of
/// the fitted touches, or of the held-out ones.
inline constexpr double kLargerModelP = 0.01;

/// Nested F-test of the residuals of two converged fits to the same touches, the second with more parameters.
struct NestedTest {
  double f = 0.0;
  double p = 1.0;
};

/// Nothing when the second has no more parameters, or no degree of freedom is left. A parameter with a prior
/// counts for what the noise of the touches makes of it in the sum of squares (ResidualSum::noise_degrees()):
/// 2 h - h^2 where the touches determine a share h of it. So the test alarms in 0.4 of 100 runs of even gears
/// (tests/figures/gear_model_test); counted as h it did in 1.7.
std::optional<NestedTest> test_nested(const ResidualSum& smaller, const ResidualSum& larger);

/// Paired test of the held-out residuals of two arms, each divided by its noise_factor(): Student's t of the
/// mean decrease of the squares, one-sided.
struct HeldOutTest {
  int touch_count = 0;
  double smaller_rms_m = 0.0;
  double larger_rms_m = 0.0;
  double t = 0.0;
  double p = 1.0;
};

/// `smaller_m`, `larger_m`: residuals of the same touches. Nothing with fewer than kHeldOutTouchesMin, or
/// where both are the same.
std::optional<HeldOutTest> test_held_out(const Eigen::VectorXd& smaller_m, const Eigen::VectorXd& larger_m);

/// Of the held-out touches of the problem that no fit rejected.
std::optional<HeldOutTest> test_held_out(const IdentificationProblem& problem,
                                         const IdentificationResult& smaller,
                                         const IdentificationResult& larger);

/// Whether to take the larger model, and the sentence for the result: which of the two voices asks for it.
struct ModelChoice {
  bool take_larger = false;
  std::string reason;
};
/// `what` the larger one has more: "first harmonics of the joints".
ModelChoice choose_model(const std::string& what, const IdentificationProblem& problem,
                         const IdentificationResult& smaller, const IdentificationResult& larger);

/// Why harmonics are not tried after the result without them; nothing where they are, no words where nobody
/// asks for them. They are beside the compliance only: alone they take up the droop of an arm with even
/// gears.
std::optional<std::string> against_harmonics(const IdentificationProblem& problem,
                                             const IdentificationOptions& options,
                                             const IdentificationResult& without);

/// The same of the ripple.
std::optional<std::string> against_ripple(const IdentificationProblem& problem,
                                          const IdentificationOptions& options,
                                          const IdentificationResult& without);

/// Whether the touches are so much better or worse than declared that they are weighed anew against the
/// priors.
bool is_reweighed(const IdentificationProblem& problem, const IdentificationOptions& options,
                  const IdentificationResult& declared);

/// The options that solve for the model of a converged result once more: without a search for outliers and
/// without a choice of what is beside rigid kinematics.
IdentificationOptions settled_options(IdentificationOptions options, const IdentificationResult& result);

}  // namespace calib
