#pragma once

#include <optional>
#include <string>

#include "calib_core/identification/identification_result.hpp"

namespace calib {

/// Harmonics are tried from this many fitted touches on: with fewer they cost more than they bring.
inline constexpr int kHarmonicTouchesMin = 60;

/// A fit is repeated when the measured noise differs from the declared one by more than this factor.
inline constexpr double kReweighRatio = 1.1;

/// The larger model is taken when chance alone would reduce the residuals as much less often than this.
inline constexpr double kLargerModelP = 0.01;

/// Nested F-test of the residuals of two converged fits to the same touches, the second with more parameters.
struct NestedTest {
  double f = 0.0;
  double p = 1.0;
};

/// Nothing when the second has no more parameters, or no degree of freedom is left. Parameters with a prior
/// count for the share that the touches determine.
std::optional<NestedTest> test_nested(const ResidualSum& smaller, const ResidualSum& larger);

/// Whether to take the larger model, and the sentence for the result.
struct ModelChoice {
  bool take_larger = false;
  std::string reason;
};
ModelChoice choose_harmonics(const IdentificationResult& without, const IdentificationResult& with);

/// Whether harmonics are tried after the result without them. Beside the compliance only: alone they take up
/// the droop of an arm with even gears.
bool tries_harmonics(const IdentificationProblem& problem, const IdentificationOptions& options,
                     const IdentificationResult& without);

/// Whether the touches are so much better or worse than declared that they are weighed anew against the
/// priors.
bool is_reweighed(const IdentificationProblem& problem, const IdentificationOptions& options,
                  const IdentificationResult& declared);

/// The options that solve for the model of a converged result once more: without a search for outliers and
/// without a choice of harmonics.
IdentificationOptions settled_options(IdentificationOptions options, const IdentificationResult& result);

}  // namespace calib
