#pragma once

#include <span>
#include <string>

#include "calib_core/identification/identify.hpp"

namespace calib {

/// The same touches must give the calibrated arm again: no new error beyond this (metres and radians).
inline constexpr double kSameTouchesErrorMax = 1e-9;

/// Another set repeats the identification only with so many touches more than parameters.
inline constexpr int kSpareTouchesMin = 5;

/// The same columns identified anew from the calibrated arm.
struct Repetition {
  IdentificationStatus status = IdentificationStatus::kTooFewTouches;
  std::string message;  // why there is none, one sentence, unless converged
  int touch_count = 0;
  int iteration_count = 0;
  ArmVector new_errors = ArmVector::Zero();      // added to those of the calibrated arm
  ArmVector std_new_errors = ArmVector::Zero();  // both sets taken for independent; 0 for the same touches

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

/// Identifies, and when that converges, identifies again from the calibrated arm: with the same touches, and
/// with another set. That is `other_touches` (their roles are not looked at), or the problem's held-out ones
/// when there are none.
Validation validate(const IdentificationProblem& problem, const IdentificationOptions& options,
                    std::span<const Touch> other_touches = {});

/// The same of a result that is known already: identify()'s of this problem and these options.
Validation validate(const IdentificationProblem& problem, const IdentificationOptions& options,
                    IdentificationResult result, std::span<const Touch> other_touches = {});

}  // namespace calib
