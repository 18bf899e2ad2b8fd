#pragma once

#include <span>
#include <string>

#include "calib_core/identification/identify.hpp"

namespace calib {

/// The same touches must give the calibrated arm again: bound on the new errors (metres and radians).
inline constexpr double kSameTouchesErrorMax = 1e-9;

/// A repetition with another set needs this many more touches than parameters.
inline constexpr int kSpareTouchesMin = 5;

/// A second identification of the same columns that starts from the calibrated arm.
struct Repetition {
  IdentificationStatus status = IdentificationStatus::kTooFewTouches;
  std::string message;  // one sentence, unless converged: why there is none
  int touch_count = 0;
  int iteration_count = 0;
  ArmVector new_errors = ArmVector::Zero();      // in addition to those of the calibrated arm
  ArmVector std_new_errors = ArmVector::Zero();  // for independent sets; 0 for the same touches

  [[nodiscard]] bool done() const { return status == IdentificationStatus::kConverged; }
  [[nodiscard]] double new_error_max() const { return new_errors.lpNorm<Eigen::Infinity>(); }
};

/// The four validations of the paper's section V.B.
struct Validation {
  IdentificationResult result;  // distances are B.3 (fitted) and B.4 (held out, and the other touches)
  Repetition same_touches;      // B.1
  Repetition other_touches;     // B.2

  [[nodiscard]] bool passed() const {
    return same_touches.done() && same_touches.new_error_max() < kSameTouchesErrorMax;
  }
};

/// Identifies; on convergence identifies again from the calibrated arm with the same touches and with another
/// set: `other_touches` (of any role), or the held-out touches of the problem when there are none.
Validation validate(const IdentificationProblem& problem, const IdentificationOptions& options,
                    std::span<const Touch> other_touches = {});

/// The same for a known `result` of identify() with this problem and these options.
Validation validate(const IdentificationProblem& problem, const IdentificationOptions& options,
                    IdentificationResult result, std::span<const Touch> other_touches = {});

}  // namespace calib
